#pragma once

/// \file
/// Files of lobe itself.

#include "lobe/hdf5/table_file.hpp"  // tables as HDF5 files
