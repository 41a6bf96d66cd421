#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// How azimuthal modes are normalised, and which azimuth they belong to.
enum class ModeConvention {
  /// f = f_0 + 2 sum f_m cos(m phi), sr^-1, where phi is the azimuth between the directions to light and viewer: 0 on
  /// the retro side.
  brdf,
  /// pi f = sum rho_m cos(m phi), without a unit, where phi is the azimuth between the directions in which the light
  /// travels: 0 on the mirror side. DISORT and its kin take the surface so (Stamnes, Tsay, Wiscombe and Jayaweera
  /// 1988; Stamnes et al., DISORT report 1.1, 2000).
  disort
};
/// Names of all conventions: "brdf", "disort".
[[nodiscard]] std::vector<std::string_view> mode_convention_names();
/// Reads the name of a convention.
/// \throws ArgumentError for an unknown name
[[nodiscard]] ModeConvention parse_mode_convention(std::string_view name);

/// Options for azimuthal modes.
struct AzimuthalModesOptions {
  /// Largest error of the modes of a pair of cosines, relative to the root mean square of f over the azimuth there; 0:
  /// 1e-8 for formulas, 1e-4 for others and in single precision.
  double tolerance = 0;
  ModeConvention convention = ModeConvention::brdf;   ///< convention of the modes
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  /// Called for each pair of cosines whose error stays above the requested one; if empty, only the error itself tells.
  MissedToleranceCallback missed = {};
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Fourier coefficients over the azimuth between light and viewer at pairs of cosines of their angles from the normal.
struct AzimuthalModes {
  std::string name;                   ///< name of the reflectance
  std::vector<std::string> channels;  ///< names of the channels
  std::vector<double> cosines_in;     ///< cosines of the light, in [1e-6, 1]
  std::vector<double> cosines_out;    ///< cosines of the viewer, in [1e-6, 1]
  std::size_t count = 0;              ///< number of modes, from 0 on
  ModeConvention convention{};        ///< convention of the modes
  double tolerance = 0;               ///< tolerance that was asked for
  std::vector<double> values;         ///< [channel][mode][out][in], sr^-1 or without a unit, by convention
  std::vector<double> errors;  ///< bounds on the errors of values: quadrature, rounding, and interpolation where known
  /// Rest that the sum of these modes leaves out of each channel: the root of its mean square over azimuths and pairs
  /// of cosines, relative to that of f. Below 1e-7 it is rounding.
  std::vector<double> left_out;
  /// Largest coefficient of each channel, sr^-1, of sin(m phi): how much it differs between both sides of the plane of
  /// incidence, as far as low modes see it. The modes are those of the mean of both sides. Tables hold that mean.
  std::vector<double> one_sided;

  /// Index of a value.
  [[nodiscard]] std::size_t at(std::size_t channel, std::size_t mode, std::size_t out, std::size_t in) const {
    return ((channel * count + mode) * cosines_out.size() + out) * cosines_in.size() + in;
  }
};

/// Largest number of modes.
inline constexpr std::size_t kMostModes = 512;

/// Computes azimuthal modes by the rule of equal steps, whose nodes are doubled for each pair of cosines until rules
/// agree, three times at least and up to 65536. f_m = 1/(2 pi) times the integral of f cos(m phi) over the azimuth phi
/// between light and viewer.
/// \param cosines_in cosines of the angles of the light from the normal
/// \param cosines_out cosines of the angles of the viewer from the normal
/// \param count number of modes, from 0 on
/// \throws ArgumentError for cosines outside [1e-6, 1], no modes or more than 512, more than 2^25 numbers, reflectances
///   that depend on the azimuth of the light, and delta parts; NumericError for values that are not finite; Cancelled;
///   as as_function()
[[nodiscard]] AzimuthalModes azimuthal_modes(const Device& device, const Reflectance& reflectance,
                                             std::span<const double> cosines_in, std::span<const double> cosines_out,
                                             std::size_t count, const AzimuthalModesOptions& options = {});

/// Nodes and weights of a Gauss-Legendre rule over the cosine, in (0, 1), rising: one half of a "double Gauss" rule.
struct CosineRule {
  std::vector<double> cosines;  ///< nodes
  std::vector<double> weights;  ///< weights, sum 1
};
/// Computes the rule.
/// \param count number of nodes, 1 to 1000
/// \throws ArgumentError for another number
[[nodiscard]] CosineRule cosine_rule(std::size_t count);

}  // namespace lobe
