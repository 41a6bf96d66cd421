#pragma once

/// \file
/// Files of lobe itself.

#include "lobe/hdf5/file_summary.hpp"  // what files of modes and lookup tables say of themselves
#include "lobe/hdf5/table_file.hpp"    // tables as HDF5 files
