#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lobe/reflectance/azimuthal_modes.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A file format for azimuthal modes.
enum class ModesFormat {
  hdf5,  ///< HDF5, readable as netCDF: modes and their errors along channel, mode, cosine_out, cosine_in
  npy    ///< NumPy array [channel][mode][out][in], without the first axis for a single channel
};
/// Format by the ending of a file name: .h5, .nc or .npy.
/// \throws ArgumentError for another ending
[[nodiscard]] ModesFormat modes_format_of(const std::filesystem::path& path);

/// Content of a file; the same modes give the same bytes.
/// \param command_line stands in HDF5 files as origin
/// \throws IoError
[[nodiscard]] std::string modes_file(const AzimuthalModes& modes, ModesFormat format,
                                     std::string_view command_line = {});

}  // namespace lobe
