#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>

namespace [[gnu::visibility("default")]] lobe {

/// Colour-matching functions x, y, z of the CIE 1931 2 degree observer (CIE 15, table T.4): tabulated every 5 nm from
/// 380 to 780 nm, linear in between, 0 beyond.
[[nodiscard]] std::array<double, 3> colour_matching(double nanometres);

/// Spectra of light.
enum class Illuminant {
  equal_energy,  ///< the same at every wavelength (E)
  daylight       ///< CIE D65 (CIE 15, table T.1)
};

/// Matrix that turns a reflectance spectrum under a light into XYZ (CIE 1931): 3 rows, one column of weights per
/// spectral sample. The spectrum is linear between samples and constant beyond them; sums run over 380 to 780 nm in
/// steps of 5 nm. Perfect white has Y = 1.
/// \param wavelengths nm, in any order, each once
/// \throws ArgumentError if there are no wavelengths, or if one is not finite or occurs twice
[[nodiscard]] Eigen::Matrix3Xd spectrum_to_xyz(std::span<const double> wavelengths, Illuminant illuminant);

/// Matrix from XYZ to linear sRGB, with the primaries of IEC 61966-2-1 and the D65 white of spectrum_to_xyz(), so that
/// a reflectance equal at all wavelengths is exactly grey. Its entries agree with the standard to 1e-3.
[[nodiscard]] Eigen::Matrix3d xyz_to_srgb();

/// The transfer curve of IEC 61966-2-1, from linear values in [0, 1] to those of the display.
[[nodiscard]] double encode_srgb(double linear);
/// Inverse of encode_srgb(), from display values to linear values.
[[nodiscard]] double decode_srgb(double encoded);

/// Colours in which the channels of a reflectance are displayed.
struct DisplayColours {
  Eigen::MatrixXd weights;  ///< linear sRGB for each channel of the reflectance, 3 rows; one row: a grey
  std::string text;         ///< for people: "spectrum under D65"
};

/// Display colours for channels. Channels named red, green and blue, or three channels without names, are linear sRGB.
/// Wavelengths that cover enough of the visible range (from 460 to 650 nm, no gap above 60 nm) get their colour under
/// D65. Anything else is shown as the mean of all channels, a grey.
/// \param channels names; a single wavelength is named like "532 nm"
/// \param wavelengths nm, one per channel; empty: taken from the names, if all of them give one
/// \throws ArgumentError if there are no channels
[[nodiscard]] DisplayColours display_colours(std::span<const std::string> channels,
                                             std::span<const double> wavelengths);

}  // namespace lobe
