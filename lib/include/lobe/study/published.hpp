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

namespace [[gnu::visibility("default")]] lobe {

/// Quantities of a material's first channel that published figures state.
enum class PublishedQuantity {
  reflectance,           ///< sum of coefficient_k f(L_k, V_k) over pairs of directions, sr^-1
  albedo,                ///< a(theta)
  mean_albedo,           ///< (1.24)
  largest_albedo,        ///< largest albedo from the normal to kPublishedThetaMax
  largest_albedo_angle,  ///< angle of the largest albedo, degrees
  constant               ///< f(N, N) over the largest albedo, sr^-1: the constant before a formula that is 1 at (N, N)
                         ///< with which it just keeps the energy balance
};
/// Name of a quantity: "reflectance", "albedo", "mean-albedo", "largest-albedo", "largest-albedo-angle" or "constant".
[[nodiscard]] std::string_view to_string(PublishedQuantity quantity);
/// Reads the name of a quantity.
/// \throws ArgumentError for another name, with the nearest known one
[[nodiscard]] PublishedQuantity parse_published_quantity(std::string_view name);

/// Largest angle, in radians, up to which largest albedos of published figures are searched: 89.9999 degrees.
inline constexpr double kPublishedThetaMax = 89.9999 * std::numbers::pi / 180;

/// A printed number and how to compute it: (quantity of the material / f(N, N) of `unit`) + offset.
struct PublishedFigure {
  std::string table;                                            ///< title of its table
  std::string label;                                            ///< which figure in that table
  PublishedQuantity quantity = PublishedQuantity::reflectance;  ///< quantity that is printed
  Material material;                                            ///< material of the quantity
  std::vector<Directions> at;        ///< reflectance: pairs of directions; albedo: theta_in of the first
  std::vector<double> coefficients;  ///< reflectance: one per pair
  std::optional<Material> unit;      ///< none: values are not divided
  double offset = 0;                 ///< added at the end
  std::optional<double> tolerance;   ///< for albedos, relative, if it differs from that of all figures
  std::string printed;               ///< decimal number as printed: "0.350", "7.8e-3", "10430."
  std::string corrected;             ///< correct figure; empty if `printed` is right
};

/// Result of recomputing a published figure.
struct PublishedCheck {
  Estimate value;        ///< computed value
  double deviation = 0;  ///< deviation of the value from the printed figure, in units of its last digit
  bool agrees = false;   ///< whether the value rounds to the printed figure
  /// Whether the value rounds to the printed figure if that is right, and otherwise to the corrected one and only to
  /// that.
  bool is_as_expected = false;
};

/// Unit of the last digit of a decimal number, for example 0.001 for "0.350" and 1e-4 for "7.8e-3".
/// \throws ArgumentError if it is not a decimal number
[[nodiscard]] double unit_of_last_digit(std::string_view printed);

/// Recomputes published figures and compares. A value rounds to a figure if it is at most half a unit of its last digit
/// away, plus the value's error. An error above a quarter of a unit leaves that open, and nothing is as expected.
/// \param tolerance relative tolerance of albedos
/// \throws as evaluate(), albedo() and largest_albedo(); ArgumentError for a figure that lacks data its quantity needs
[[nodiscard]] std::vector<PublishedCheck> check_published(const Device& device,
                                                          std::span<const PublishedFigure> figures,
                                                          double tolerance = 1e-6,
                                                          const ProgressCallback& progress = {});

}  // namespace lobe
