#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Map m from the values of an axis to its coordinate, in which entries are equally spaced:
/// u = (m(value) - m(from)) / (m(to) - m(from)).
enum class AxisMap {
  linear,  ///< the value itself
  sqrt,    ///< its square root: roughness for an axis of alpha = roughness^2
  square,  ///< its square
  log      ///< its logarithm
};
/// Name of a map: "linear", "sqrt", "square" or "log".
[[nodiscard]] std::string_view to_string(AxisMap map);

/// Places of the entries along an axis.
enum class AxisEntries {
  centres,  ///< u = (i + 0.5) / count, as the texels of a texture
  nodes     ///< u = i / (count - 1), both ends among them
};
/// "centres" or "nodes".
[[nodiscard]] std::string_view to_string(AxisEntries entries);

/// An axis of a lookup table.
struct LutAxis {
  std::string name;                            ///< "cos_theta", "theta" (degrees), or a parameter of the formula
  std::size_t count = 32;                      ///< number of entries, from 2 on
  double from = 0;                             ///< value at coordinate 0
  double to = 1;                               ///< value at coordinate 1
  AxisMap map = AxisMap::linear;               ///< map to the coordinate
  AxisEntries entries = AxisEntries::centres;  ///< places of the entries
  /// Least value that the quantity can have; what lies below is raised to it. An axis of roughness may so begin at 0
  /// where the model takes 1e-5 at least.
  double least = -std::numeric_limits<double>::infinity();

  /// Coordinate of an entry, from 0 to 1.
  [[nodiscard]] double coordinate(std::size_t entry) const;
  /// Value at a coordinate.
  [[nodiscard]] double value(double coordinate) const;
  /// The map of the value at a coordinate, before it is raised; entries are equally spaced in it.
  [[nodiscard]] double mapped_value(double coordinate) const;
  /// Whether all members are equal.
  [[nodiscard]] bool operator==(const LutAxis&) const = default;
};

/// Reads an axis "NAME:count=32,from=0,to=1,map=sqrt,entries=nodes". By default it has 32 entries, map linear, centres;
/// the range is 0 to 1 for cos_theta, 0 to 90 degrees for theta, and the model's range for parameters that lie in [0,
/// 1]; where their least value is below a thousandth of the largest, an axis may begin at 0, and does so by default
/// unless the map is log.
/// \throws ArgumentError for names and keys that are not known, for numbers out of range, for maps that the range does
///   not permit, and for other parameters without a range
[[nodiscard]] LutAxis parse_lut_axis(std::string_view text, const Reflectance& reflectance);
/// Text of an axis, as parse_lut_axis() reads it.
[[nodiscard]] std::string to_string(const LutAxis& axis);

/// Quantity that a lookup table holds.
enum class LutQuantity {
  albedo,          ///< directional albedo E(theta) (Neumann 2001, eq. 1.13)
  complement,      ///< 1 - E(theta), what energy compensation adds
  mean_albedo,     ///< mean albedo (eq. 1.20), without an axis of angles
  mean_complement  ///< 1 - mean albedo
};
/// "albedo", "complement", "mean-albedo" or "mean-complement".
[[nodiscard]] std::string_view to_string(LutQuantity quantity);
/// Reads the name of a quantity.
/// \throws ArgumentError for an unknown name
[[nodiscard]] LutQuantity parse_lut_quantity(std::string_view name);

/// Definition of a lookup table.
struct LutRequest {
  /// An isotropic reflectance. Axes of parameters replace their values in a formula; other kinds have angles alone.
  Reflectance reflectance;
  std::vector<LutAxis> axes = {};              ///< from 1 to 4, the last index the quickest
  LutQuantity quantity = LutQuantity::albedo;  ///< quantity of the table
  /// A parameter p in which the albedo is linear, E = bias + p * scale, such as the f0 of Schlick's Fresnel term: the
  /// table then holds scale and bias ("DFG terms") for each channel. "f82" adds the edge term of the factor f82 to
  /// those of f0: E = bias + f0 * scale - (1 - tint) (f0 + (1 - f0) (6/7)^5) * edge, where that factor is above 0
  /// for all angles. Empty: none.
  std::string split = {};
};

/// Names of the numbers of an entry: "albedo" or "complement", or "scale" and "bias", and "edge" of a split "f82";
/// further channels are "albedo_2".
[[nodiscard]] std::vector<std::string> lut_columns(const LutRequest& request);

/// Options for lookup tables.
struct LutOptions {
  double tolerance = 1e-6;                            ///< largest relative error of albedos
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  MissedToleranceCallback missed = {};                ///< called for each albedo that misses the tolerance
  ProgressCallback progress = {};                     ///< called after each set of parameters
};

/// A lookup table.
struct Lut {
  LutRequest request;                ///< its definition
  std::vector<std::string> columns;  ///< names of the numbers of an entry, as lut_columns() has them
  std::vector<double> values;        ///< the columns of an entry beside each other, the last axis the quickest
  std::vector<double> errors;        ///< error of each value; empty where they are somebody else's

  /// Number of entries.
  [[nodiscard]] std::size_t entries() const;
};

/// Computes a lookup table. A node at 90 degrees holds the value at 89.9999 degrees.
/// \throws ArgumentError for axes and quantities that do not fit each other or the material, for an albedo that is not
///   linear in the parameter of a split, and for values that the model does not take; as albedo(); Cancelled
[[nodiscard]] Lut make_lut(const Device& device, const LutRequest& request, const LutOptions& options = {});

/// The largest difference of a table from what it stands for.
struct LutDeviation {
  double largest = 0;      ///< |table - true value| + error of the true value
  double rms = 0;          ///< root mean square, without errors
  std::vector<double> at;  ///< values of the axes at the largest difference
  std::size_t column = 0;  ///< column of the largest difference
  double table = 0;        ///< the table's value there
  Estimate exact;          ///< the true value there
};

/// How far a table is off, as measured on a finer grid.
struct LutErrors {
  LutDeviation entries;    ///< at the entries: error of the numbers, and what a format's few digits add
  LutDeviation between;    ///< with (multi)linear interpolation between the entries, these included
  LutDeviation all;        ///< as `between`, with the ends of the axes, to which the outermost entries are continued
  std::size_t points = 0;  ///< points of the finer grid
};

/// Measures the error of a table, with multilinear interpolation on a grid of `refinement` steps between entries. The
/// albedos of that grid are as accurate as the largest difference needs, to a tenth of it, or to the tolerance.
/// \param lut its values as a file holds them, or somebody else's
/// \param exact the table that make_lut() makes of the same definition
/// \param refinement steps between two entries, from 1 (entries alone) to 16
/// \throws ArgumentError for tables of different definitions, and for a refinement out of range; as make_lut()
[[nodiscard]] LutErrors lut_errors(const Device& device, const Lut& lut, const Lut& exact, unsigned refinement = 2,
                                   const LutOptions& options = {});

/// Text of a quantity: "directional albedo of ggx:alpha=1,f0=1 = bias + f0 * scale".
[[nodiscard]] std::string lut_quantity_text(const LutRequest& request);
/// Text of an axis for people: "alpha from 0 to 1, 32 cell centres, equally spaced in sqrt(alpha)".
[[nodiscard]] std::string lut_axis_text(const LutAxis& axis);
/// Text of the place of the largest difference: "alpha 0.25, theta 30 degrees (scale)".
[[nodiscard]] std::string lut_place_text(const Lut& lut, const LutDeviation& deviation);

/// Value of a table by multilinear interpolation; beyond the outermost entries theirs.
/// \param coordinates one per axis, from 0 to 1
[[nodiscard]] double interpolate(const Lut& lut, std::span<const double> coordinates, std::size_t column);

}  // namespace lobe
