#pragma once

/// The whole public interface of lobe: BRDF operator algebra on OpenCL.

#include "lobe/algebra.hpp"         // compositions, mixtures, adjoints
#include "lobe/device.hpp"          // choosing an OpenCL device
#include "lobe/directions.hpp"      // directions and pairs of them
#include "lobe/embedding.hpp"       // maps of materials
#include "lobe/energy.hpp"          // albedos
#include "lobe/error.hpp"           // what is thrown
#include "lobe/estimate.hpp"        // value and error
#include "lobe/evaluate.hpp"        // reflectance values
#include "lobe/grid.hpp"            // discretised hemispheres
#include "lobe/material.hpp"        // combinations of models
#include "lobe/metric.hpp"          // products, norms, distances
#include "lobe/model.hpp"           // the catalogue
#include "lobe/pointwise.hpp"       // compositions at single directions
#include "lobe/progress.hpp"        // progress and cancelling
#include "lobe/study.hpp"           // study files, runs and results
#include "lobe/table.hpp"           // reflectances as operators
#include "lobe/table_file.hpp"      // tables as HDF5 files
#include "lobe/table_metric.hpp"    // products and distances of tables
#include "lobe/table_pictures.hpp"  // pictures of tables
#include "lobe/version.hpp"         // version of the library
#include "lobe/work.hpp"            // work done
