#pragma once

/// \file
/// Files of other programs and of instruments.

#include "lobe/formats/chosen_file.hpp"      // files with options behind their names
#include "lobe/formats/direction_pairs.hpp"  // values at lists of pairs of directions
#include "lobe/formats/measured.hpp"         // reflectances from and for files of other programs
#include "lobe/formats/measured_export.hpp"  // what files of other programs keep of a reflectance
#include "lobe/formats/measurement.hpp"      // what standard deviations of samples make of numbers
#include "lobe/formats/modes_file.hpp"       // azimuthal modes as files
