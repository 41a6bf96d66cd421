#pragma once

/// \namespace lobe
/// The whole public interface of lobe: BRDF operator algebra on OpenCL.

#include "lobe/algebra.hpp"      // compositions, inverses, spectra
#include "lobe/cluster.hpp"      // trees, representatives and maps of materials
#include "lobe/compare.hpp"      // distances of the literature
#include "lobe/core.hpp"         // numbers, errors and texts that all share
#include "lobe/device.hpp"       // OpenCL devices
#include "lobe/energy.hpp"       // albedos, plausibility, repairs
#include "lobe/fit.hpp"          // approximations and fits
#include "lobe/formats.hpp"      // files of other programs
#include "lobe/hdf5.hpp"         // files of lobe itself
#include "lobe/hemisphere.hpp"   // discretised hemispheres
#include "lobe/lut.hpp"          // albedo tables for renderers
#include "lobe/metric.hpp"       // scalar products, norms, distances
#include "lobe/model.hpp"        // the catalogue, and materials
#include "lobe/plot.hpp"         // pictures
#include "lobe/reflectance.hpp"  // values, functions, tables and compositions of any reflectance
#include "lobe/render.hpp"       // pictures of materials under light
#include "lobe/sampling.hpp"     // importance sampling
#include "lobe/study.hpp"        // studies and reports
#include "lobe/table.hpp"        // reflectances, tables
