#pragma once

/// \file
/// The catalogue of reflectance models, and materials made of them.

#include "lobe/model/label.hpp"              // names and families
#include "lobe/model/material.hpp"           // combinations of models
#include "lobe/model/model.hpp"              // the catalogue
#include "lobe/model/profile.hpp"            // patch-based models by points
#include "lobe/model/sampling_strategy.hpp"  // what directions are drawn from
#include "lobe/model/specification.hpp"      // materials as text
