#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>

namespace lobe {

/// The colour-matching functions x, y, z of the CIE 1931 2 degree observer (CIE 15, table T.4): every 5 nm from 380 to
/// 780 nm, linear in between, 0 beyond.
[[nodiscard]] std::array<double, 3> colour_matching(double nanometres);

/// Spectra of light.
enum class Illuminant {
  equal_energy,  ///< the same at every wavelength (E)
  daylight       ///< CIE D65 (CIE 15, table T.1)
};

/// XYZ (CIE 1931) of what a reflectance sends back of a light: 3 rows, a column of weights per sample of its spectrum.
/// Between samples it is linear, beyond them constant; sums over 380 to 780 nm in steps of 5 nm. Perfect white has Y
/// = 1.
/// \param wavelengths nm, in any order, each once
/// \throws ArgumentError for no wavelengths, and for those that are no finite numbers or occur twice
[[nodiscard]] Eigen::Matrix3Xd spectrum_to_xyz(std::span<const double> wavelengths, Illuminant illuminant);

/// XYZ to linear sRGB, from the primaries of IEC 61966-2-1 and the white of D65 as spectrum_to_xyz() has it, so that
/// what reflects all wavelengths alike is exactly grey. Its entries are those of the standard to 1e-3.
[[nodiscard]] Eigen::Matrix3d xyz_to_srgb();

/// The transfer curve of IEC 61966-2-1, from linear values in [0, 1] to those of the display.
[[nodiscard]] double encode_srgb(double linear);
/// Its inverse.
[[nodiscard]] double decode_srgb(double encoded);

/// How channels of a reflectance are shown.
struct DisplayColours {
  Eigen::MatrixXd weights;  ///< linear sRGB by channel of the reflectance, 3 rows; one row: a grey
  std::string text;         ///< for people: "spectrum under D65"
};

/// Red, green and blue by their names, or three channels without names: linear sRGB. Wavelengths, where they say enough
/// of the visible range (from 460 to 650 nm, no gap above 60 nm): their colour under D65. Else the mean of all
/// channels, as a grey.
/// \param channels names; those of single wavelengths are "532 nm"
/// \param wavelengths nm, one per channel; empty: those that the names give, if all do
[[nodiscard]] DisplayColours display_colours(std::span<const std::string> channels,
                                             std::span<const double> wavelengths);

}  // namespace lobe
