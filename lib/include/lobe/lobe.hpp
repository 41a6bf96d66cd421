#pragma once

/// The whole public interface of lobe: BRDF operator algebra on OpenCL.

#include "lobe/device.hpp"      // choosing an OpenCL device
#include "lobe/directions.hpp"  // pairs of directions
#include "lobe/embedding.hpp"   // maps of materials
#include "lobe/energy.hpp"      // albedos
#include "lobe/error.hpp"       // what is thrown
#include "lobe/estimate.hpp"    // value and error
#include "lobe/evaluate.hpp"    // reflectance values
#include "lobe/material.hpp"    // combinations of models
#include "lobe/metric.hpp"      // products, norms, distances
#include "lobe/model.hpp"       // the catalogue
#include "lobe/progress.hpp"    // progress and cancelling
#include "lobe/study.hpp"       // study files, runs and results
#include "lobe/version.hpp"     // version of the library
#include "lobe/work.hpp"        // work done
