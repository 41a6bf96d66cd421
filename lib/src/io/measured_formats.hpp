#pragma once

#include <filesystem>
#include <memory>

#include "lobe/measured.hpp"

namespace lobe {

/// Neural encodings of Sztrajman et al. 2021: Keras weights in HDF5.
[[nodiscard]] bool is_neural_encoding(const std::filesystem::path& path);
/// \throws IoError
[[nodiscard]] std::unique_ptr<MeasuredBrdf> load_neural_encoding(const std::filesystem::path& path);

/// Zernike coefficients of NIST (Germer 2017): lines of eight numbers.
[[nodiscard]] bool is_zernike_expansion(const std::filesystem::path& path);
/// \throws IoError; ArgumentError where the wavelengths are missing or not wanted
[[nodiscard]] std::unique_ptr<MeasuredBrdf> load_zernike_expansion(const std::filesystem::path& path,
                                                                   const MeasuredOptions& options);

}  // namespace lobe
