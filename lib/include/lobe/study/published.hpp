#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// What a published figure says of the first channel of a material.
enum class PublishedQuantity {
  reflectance,           ///< sum of coefficient_k f(L_k, V_k) over pairs of directions, sr^-1
  albedo,                ///< a(theta)
  mean_albedo,           ///< (1.24)
  largest_albedo,        ///< from the normal to kPublishedThetaMax
  largest_albedo_angle,  ///< where that is, degrees
  constant               ///< f(N, N) over the largest albedo, sr^-1: the constant before a formula that is 1 at (N, N)
                         ///< with which it just keeps the energy balance
};
/// "reflectance", "albedo", "mean-albedo", "largest-albedo", "largest-albedo-angle", "constant".
[[nodiscard]] std::string_view to_string(PublishedQuantity quantity);
/// Reads such a name.
/// \throws ArgumentError for another name, with the nearest known one.
[[nodiscard]] PublishedQuantity parse_published_quantity(std::string_view name);

/// Up to where largest albedos of published figures are looked for, radians: 89.9999 degrees.
inline constexpr double kPublishedThetaMax = 89.9999 * std::numbers::pi / 180;

/// A printed number and how to compute it: (quantity of the material / f(N, N) of `unit`) + offset.
struct PublishedFigure {
  std::string table;                                            ///< title of what it is printed in
  std::string label;                                            ///< which of the figures there
  PublishedQuantity quantity = PublishedQuantity::reflectance;  ///< what is printed
  Material material;                                            ///< whose quantity it is
  std::vector<Directions> at;        ///< reflectance: pairs of directions; albedo: theta_in of the first
  std::vector<double> coefficients;  ///< reflectance: one per pair
  std::optional<Material> unit;      ///< none: values are not divided
  double offset = 0;                 ///< added in the end
  std::optional<double> tolerance;   ///< of albedos, relative, where it is not the one of all figures
  std::string printed;               ///< decimal, as printed: "0.350", "7.8e-3", "10430."
  std::string corrected;             ///< what should be printed; empty where `printed` is right
};

/// A published figure computed again.
struct PublishedCheck {
  Estimate value;        ///< computed
  double deviation = 0;  ///< of the value from the printed figure, in units of its last digit
  bool agrees = false;   ///< the value rounds to the printed figure
  /// The value rounds to the printed figure where that is right, to the corrected one and only to that where it is not.
  bool is_as_expected = false;
};

/// A unit of the last digit of a decimal number, for example 0.001 for "0.350" and 1e-4 for "7.8e-3".
/// \throws ArgumentError for what is no decimal number.
[[nodiscard]] double unit_of_last_digit(std::string_view printed);

/// Computes published figures and compares. A value rounds to a figure when it is at most half a unit of its last digit
/// away, give or take the value's error; an error above a quarter of a unit leaves that open, and nothing is as
/// expected.
/// \param tolerance of albedos, relative
/// \throws as evaluate(), albedo() and largest_albedo(); ArgumentError for a figure without what its quantity asks for.
[[nodiscard]] std::vector<PublishedCheck> check_published(const Device& device,
                                                          std::span<const PublishedFigure> figures,
                                                          double tolerance = 1e-6,
                                                          const ProgressCallback& progress = {});

}  // namespace lobe
