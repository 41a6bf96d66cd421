#pragma once

/// \file
/// Files of lobe and of other programs, and pictures.

#include "lobe/io/approximation_pictures.hpp"  // pictures of them
#include "lobe/io/chosen_file.hpp"             // files with options behind their names
#include "lobe/io/direction_pairs.hpp"         // values at lists of pairs of directions
#include "lobe/io/fit_pictures.hpp"            // pictures of them
#include "lobe/io/foreign_export.hpp"          // what files of other programs keep of a reflectance
#include "lobe/io/material_file.hpp"           // materials as files
#include "lobe/io/measured.hpp"                // reflectances from and for files of other programs
#include "lobe/io/measurement.hpp"             // what standard deviations of samples make of numbers
#include "lobe/io/plausibility_page.hpp"       // the catalogue in this respect, as a page
#include "lobe/io/preview_sheet.hpp"           // contact sheets of them
#include "lobe/io/sampling_page.hpp"           // what that is worth, as a page
#include "lobe/io/table_file.hpp"              // tables as HDF5 files
#include "lobe/io/table_pictures.hpp"          // pictures of tables
