#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/file_bytes.hpp"
#include "formats/scattered_brdf.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// One value of a measurement: at a pair of directions and a wavelength.
struct SpectralRow {
  double wavelength = 0;  ///< nm; 0: none is stated
  Directions pair = {};
  double value = 0;      ///< sr^-1
  double deviation = 0;  ///< its standard deviation, sr^-1; 0 where none is stated
};

/// The samples of a file that has a row for each wavelength, whose channels are these wavelengths. Pairs of directions
/// that lack some of them are left out, with a remark. Sets channels and wavelengths.
/// \throws IoError for rows with and without wavelengths, and for too many of them
[[nodiscard]] ScatteredSamples gathered(const FileBytes& file, std::vector<SpectralRow> rows, bool is_isotropic,
                                        bool has_deviations, BrdfFunction& brdf);

/// The order of channels by wavelength: their numbers.
[[nodiscard]] std::vector<std::size_t> by_wavelength(const BrdfFunction& brdf);

/// Values at pairs of directions for a format that takes no others, and their standard deviations if there are
/// replicates.
struct WrittenValues {
  Eigen::MatrixXd value;      ///< sr^-1, pairs x own channels
  Eigen::MatrixXd deviation;  ///< sr^-1, as the values; 0 x 0 without replicates
};

/// \param format whose files they are: "BiRD"
/// \throws ArgumentError for channels that are neither one nor wavelengths, and for values below 0; NumericError for
///   values that are not finite
[[nodiscard]] WrittenValues spectral_values(const BrdfFunction& brdf, std::span<const Directions> pairs,
                                            std::string_view format);

}  // namespace lobe
