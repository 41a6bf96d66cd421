#pragma once

/// \namespace lobe
/// The whole public interface of lobe: BRDF operator algebra on OpenCL.

#include "lobe/algebra.hpp"                 // compositions, mixtures, adjoints
#include "lobe/approximation.hpp"           // best approximations
#include "lobe/approximation_pictures.hpp"  // pictures of them
#include "lobe/brdf_function.hpp"           // reflectances as functions of directions
#include "lobe/cell_error.hpp"              // what averages over cells may hide
#include "lobe/chart.hpp"                   // curves of several materials
#include "lobe/checkpoint.hpp"              // studies that go on where they were ended
#include "lobe/chosen_file.hpp"             // files with options behind their names
#include "lobe/clustering.hpp"              // trees, representatives and neighbours of materials
#include "lobe/colour.hpp"                  // colours of spectra, for displays
#include "lobe/comparison.hpp"              // distances of the literature
#include "lobe/device.hpp"                  // choosing an OpenCL device
#include "lobe/direction_pairs.hpp"         // values at lists of pairs of directions
#include "lobe/directions.hpp"              // directions and pairs of them
#include "lobe/embedding.hpp"               // maps of materials
#include "lobe/energy.hpp"                  // albedos
#include "lobe/error.hpp"                   // what is thrown
#include "lobe/estimate.hpp"                // value and error
#include "lobe/evaluate.hpp"                // reflectance values
#include "lobe/fit.hpp"                     // best members of families
#include "lobe/fit_pictures.hpp"            // pictures of them
#include "lobe/foreign_export.hpp"          // what files of other programs keep of a reflectance
#include "lobe/form.hpp"                    // ways of writing things
#include "lobe/function_composition.hpp"    // compositions of files and formulas on grids
#include "lobe/grid.hpp"                    // discretised hemispheres
#include "lobe/inverse.hpp"                 // regularised inverses
#include "lobe/judgement.hpp"               // distances as people judge them
#include "lobe/least_value.hpp"             // smallest values of tables
#include "lobe/lighting.hpp"                // what scalar products weigh
#include "lobe/load_reflectance.hpp"        // files of any kind
#include "lobe/material.hpp"                // combinations of models
#include "lobe/material_curves.hpp"         // albedos and slices of materials
#include "lobe/material_file.hpp"           // materials as files
#include "lobe/measured.hpp"                // reflectances from and for files of other programs
#include "lobe/measurement.hpp"             // what standard deviations of samples make of numbers
#include "lobe/metric.hpp"                  // products, norms, distances
#include "lobe/model.hpp"                   // the catalogue
#include "lobe/plausibility.hpp"            // whether a reflectance is one of nature
#include "lobe/plausibility_page.hpp"       // the catalogue in this respect, as a page
#include "lobe/pointwise.hpp"               // compositions at single directions
#include "lobe/prepare.hpp"                 // formulas tested, adjustments done
#include "lobe/preview.hpp"                 // spheres of materials under light
#include "lobe/preview_sheet.hpp"           // contact sheets of them
#include "lobe/profile.hpp"                 // patch-based models by points
#include "lobe/progress.hpp"                // progress and cancelling
#include "lobe/proposal.hpp"                // what directions are drawn from
#include "lobe/published.hpp"               // printed numbers to compute again
#include "lobe/rank_correlation.hpp"        // how alike metrics rank
#include "lobe/reflectance.hpp"             // formulas, functions or tables
#include "lobe/repair.hpp"                  // pumping-up, normalisation, balance of energy
#include "lobe/report_page.hpp"             // results of studies, as a page
#include "lobe/sampling.hpp"                // drawing directions by importance
#include "lobe/sampling_page.hpp"           // what that is worth, as a page
#include "lobe/self_test.hpp"               // whether a device computes rightly
#include "lobe/specification.hpp"           // materials as text
#include "lobe/spectrum.hpp"                // eigenvalues and what composing loses
#include "lobe/square_root.hpp"             // roots of self-compositions
#include "lobe/study.hpp"                   // study files, runs and results
#include "lobe/study_plan.hpp"              // what running a study takes
#include "lobe/study_results.hpp"           // what files of results say
#include "lobe/study_schema.hpp"            // study files for editors
#include "lobe/table.hpp"                   // reflectances as operators
#include "lobe/table_file.hpp"              // tables as HDF5 files
#include "lobe/table_lighting.hpp"          // products of tables under any lighting
#include "lobe/table_metric.hpp"            // products and distances of tables
#include "lobe/table_pictures.hpp"          // pictures of tables
#include "lobe/tolerance.hpp"               // errors above what was asked for
#include "lobe/verify.hpp"                  // whether files are as written
#include "lobe/version.hpp"                 // version of the library
#include "lobe/work.hpp"                    // work done
