#pragma once

/// \file
/// Distances of the literature and rankings by them.

#include "lobe/compare/judgement.hpp"          // distances as people judge them
#include "lobe/compare/literature_metric.hpp"  // distances of the literature
#include "lobe/compare/rank_correlation.hpp"   // how alike metrics rank
