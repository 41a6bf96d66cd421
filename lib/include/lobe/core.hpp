#pragma once

/// \file
/// Numbers, errors, files and texts that all rooms share.

#include "lobe/core/colour.hpp"        // colours of spectra, for displays
#include "lobe/core/directions.hpp"    // directions and pairs of them
#include "lobe/core/error.hpp"         // what is thrown
#include "lobe/core/estimate.hpp"      // value and error
#include "lobe/core/file_set.hpp"      // files that appear together
#include "lobe/core/files.hpp"         // files that are complete or absent
#include "lobe/core/memory_bound.hpp"  // tables in files
#include "lobe/core/output_lock.hpp"   // one process per output
#include "lobe/core/progress.hpp"      // progress and cancelling
#include "lobe/core/tolerance.hpp"     // errors above what was asked for
#include "lobe/core/version.hpp"       // version of the library
#include "lobe/core/work_done.hpp"     // work done
#include "lobe/core/written_form.hpp"  // ways of writing things
