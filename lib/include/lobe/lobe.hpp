#pragma once

/// \namespace lobe
/// The whole public interface of lobe: BRDF operator algebra on OpenCL.

#include "lobe/algebra.hpp"      // compositions, inverses, spectra
#include "lobe/core.hpp"         // numbers, errors and texts that all share
#include "lobe/device.hpp"       // OpenCL devices
#include "lobe/energy.hpp"       // albedos, repairs, sampling, previews
#include "lobe/hemisphere.hpp"   // discretised hemispheres
#include "lobe/io.hpp"           // files and pictures
#include "lobe/metric.hpp"       // products, distances, approximations, fits
#include "lobe/model.hpp"        // the catalogue, and materials
#include "lobe/reflectance.hpp"  // values, functions, tables and compositions of any reflectance
#include "lobe/study.hpp"        // studies and reports
#include "lobe/table.hpp"        // reflectances, tables
