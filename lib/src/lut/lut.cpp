#include "lobe/lut/lut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lut/lut_measure.hpp"
#include "lut/parameter_places.hpp"
#include "model/terms.hpp"

namespace lobe {
namespace {

constexpr std::size_t kMostAxes = 4;
constexpr std::size_t kMostValues = std::size_t{1} << 24;
constexpr double kMostTheta = 89.9999 * kDegree;  // of a node at 90 degrees, where albedos are limits
constexpr unsigned kMostRefinement = 16;
constexpr double kRoughTolerance = 1e-4;  // of the albedos that a table is first held against, relative
constexpr double kErrorShare = 0.1;       // that their errors may have of the largest difference

constexpr std::array<std::string_view, 4> kQuantities{"albedo", "complement", "mean-albedo", "mean-complement"};

bool is_mean(LutQuantity quantity) {
  return quantity == LutQuantity::mean_albedo || quantity == LutQuantity::mean_complement;
}

bool is_complement(LutQuantity quantity) {
  return quantity == LutQuantity::complement || quantity == LutQuantity::mean_complement;
}

/// Whether the table has the edge term of F82 beside the two of Schlick's approximation.
bool has_edge(const LutRequest& request) {
  return request.split == "f82";
}

/// Parameter in which scale and bias are linear.
std::string_view split_parameter(const LutRequest& request) {
  return has_edge(request) ? std::string_view("f0") : std::string_view(request.split);
}

bool has_normal_reflectance(const Term& term) {
  const auto names = parameter_names(term);
  return std::ranges::find(names, "f0") != names.end();
}

bool is_angle(const LutAxis& axis) {
  return axis.name == "cos_theta" || axis.name == "theta";
}

double theta_of(const LutAxis& axis, double value) {
  const double theta = axis.name == "theta" ? value * kDegree : std::acos(std::clamp(value, 0.0, 1.0));
  return std::min(theta, kMostTheta);
}

/// Coordinates of the points of each axis.
using Points = std::vector<std::vector<double>>;

std::size_t count_of(const Points& points) {
  return std::accumulate(points.begin(), points.end(), std::size_t{1},
                         [](std::size_t all, const auto& axis) { return all * axis.size(); });
}

void check(const LutRequest& request) {
  const auto refuse = [](const std::string& message) { throw ArgumentError(message); };
  if (request.axes.empty() || request.axes.size() > kMostAxes) {
    refuse(fmt::format("a lookup table has {} axes; expected 1 to {}", request.axes.size(), kMostAxes));
  }
  std::size_t angles = 0;
  for (std::size_t i = 0; i < request.axes.size(); ++i) {
    const LutAxis& axis = request.axes[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (request.axes[j].name == axis.name) refuse("axis " + axis.name + " is given twice; give it once");
    }
    if (is_angle(axis)) {
      ++angles;
    } else {
      (void)parameter_range(request.reflectance, axis.name);
    }
    if (axis.name == split_parameter(request)) {
      refuse("'" + axis.name + "' is an axis and the parameter of the split; give it once");
    }
  }
  if (angles > 1) refuse("cos_theta and theta are the same angle; give one of them");
  if (is_mean(request.quantity) && angles > 0) {
    refuse("mean albedos have no angle of incidence; leave out that axis, or ask for albedo or complement");
  }
  if (!is_mean(request.quantity) && angles == 0) {
    refuse("directional albedos need an angle of incidence; give axis cos_theta or theta, or ask for mean-albedo");
  }
  if (!request.split.empty()) {
    const ParameterRange range = parameter_range(request.reflectance, split_parameter(request));
    if (range.minimum > 0 || range.maximum < 1) {
      refuse(fmt::format(
          "the albedo of '{}' is not linear in {}, which cannot be 0 or 1 (its range is [{}, {}]); "
          "expected a parameter such as the f0 of Schlick's Fresnel term",
          request.reflectance.name(), split_parameter(request), shortest(range.minimum), shortest(range.maximum)));
    }
    if (has_edge(request) && !request.reflectance.formula()->adjustments.empty()) {
      refuse(
          fmt::format("'{}' is adjusted, so that its albedo is not linear in the edge term of F82; expected a formula "
                      "without adjustments, or split f0",
                      request.reflectance.name()));
    }
    if (is_complement(request.quantity)) {
      refuse("a split has the terms of the albedo itself; ask for albedo or mean-albedo");
    }
  }
  if (!request.reflectance.is_isotropic()) {
    refuse(fmt::format("'{}' is anisotropic: its albedos depend on the azimuth, too; expected an isotropic reflectance",
                       request.reflectance.name()));
  }
}

/// Albedos of one material, those of an angle beside each other by channel; a single one for mean albedos.
std::vector<Estimate> albedos_of(const Device& device, const LutRequest& request, const Reflectance& reflectance,
                                 const std::vector<double>& theta, const AlbedoOptions& options) {
  if (is_mean(request.quantity)) return mean_albedo(device, reflectance, options);
  const auto by_channel = albedo(device, reflectance, theta, options);
  std::vector<Estimate> albedos;
  for (std::size_t i = 0; i < theta.size(); ++i) {
    for (const auto& channel : by_channel) albedos.push_back(channel[i]);
  }
  return albedos;
}

/// Values of the columns for one set of parameters, at all angles.
class Row {
 public:
  /// \param checks_split whether the albedo must be linear in the parameter of the split
  Row(const Device& device, const LutRequest& request, AlbedoOptions options, bool checks_split)
      : device_(device), request_(request), options_(std::move(options)), checks_split_(checks_split) {}

  [[nodiscard]] std::vector<Estimate> at(const Reflectance& reflectance, const std::vector<double>& theta) const {
    if (!request_.split.empty()) return split(reflectance, theta);
    std::vector<Estimate> values = albedos_of(device_, request_, reflectance, theta, options_);
    if (is_complement(request_.quantity)) {
      for (Estimate& value : values) value.value = 1 - value.value;
    }
    return values;
  }

 private:
  [[nodiscard]] std::vector<Estimate> split(const Reflectance& reflectance, const std::vector<double>& theta) const {
    const auto with = [&](double value) { return with_parameter(reflectance, split_parameter(request_), value); };
    const auto at = [&](double value) { return albedos_of(device_, request_, with(value), theta, options_); };
    std::vector<std::vector<Estimate>> ends;  // at 0 and at 1, then without the edge at 1
    if (reflectance.formula()->adjustments.empty()) {
      std::vector<Material> materials{*with(0).formula(), *with(1).formula()};
      if (has_edge(request_)) materials.push_back(without_edge(materials.back()));
      const auto all = albedos_of(device_, request_, side_by_side(materials), theta, options_);
      const std::size_t channels = request_.reflectance.channels();
      ends.resize(materials.size());
      for (std::size_t i = 0; i < all.size(); ++i) ends[i / channels % materials.size()].push_back(all[i]);
    } else {
      ends = {at(0), at(1)};
    }
    if (checks_split_) require_linear(ends[0], at(0.5), ends[1]);
    std::vector<Estimate> values;
    const auto difference = [](const Estimate& a, const Estimate& b) -> Estimate {
      return {a.value - b.value, a.error + b.error};
    };
    for (std::size_t c = 0; c < ends[0].size(); ++c) {
      values.push_back(difference(ends[1][c], ends[0][c]));
      values.push_back(ends[0][c]);
      if (has_edge(request_)) values.push_back(difference(ends[1][c], ends[2][c]));
    }
    return values;
  }

  /// Facets that reflect all light, but none of it at 82 degrees: F82 with f0 = 1 and tint = 0.
  [[nodiscard]] Material without_edge(const Material& white) const {
    Material dark = white;
    for (Term& term : dark.terms) {
      if (!has_normal_reflectance(term)) continue;
      term.factors.push_back(make_factor("f82", {{"f0", 1}, {"tint", 0}}));
      require_consistent(term);
    }
    return dark;
  }

  /// Materials of as many channels each, in channels beside each other: one quadrature for all.
  [[nodiscard]] static Material side_by_side(const std::vector<Material>& materials) {
    const std::size_t channels = materials.front().channels();
    Material all = materials.front();
    all.terms.clear();
    for (std::size_t m = 0; m < materials.size(); ++m) {
      for (const Term& term : materials[m].terms) {
        std::vector<double> weight(materials.size() * channels, 0.0);
        for (std::size_t c = 0; c < channels; ++c) {
          weight[m * channels + c] = term.weight[term.weight.size() == 1 ? 0 : c];
        }
        all.terms.push_back(term);
        all.terms.back().weight = std::move(weight);
      }
    }
    return all;
  }

  void require_linear(const std::vector<Estimate>& at_0, const std::vector<Estimate>& between,
                      const std::vector<Estimate>& at_1) const {
    for (std::size_t i = 0; i < between.size(); ++i) {
      const double line = 0.5 * (at_0[i].value + at_1[i].value);
      const double error = between[i].error + 0.5 * (at_0[i].error + at_1[i].error);
      if (std::abs(between[i].value - line) <= error) continue;
      throw ArgumentError(fmt::format(
          "the albedo of '{}' is not linear in {}: at 0, 0.5 and 1 it is {:.6g}, {:.6g} and {:.6g}; expected "
          "a parameter such as the f0 of Schlick's Fresnel term",
          request_.reflectance.name(), split_parameter(request_), at_0[i].value, between[i].value, at_1[i].value));
    }
  }

  const Device& device_;
  const LutRequest& request_;
  AlbedoOptions options_;
  bool checks_split_;
};

/// Values at the points of a grid, as those of a table.
class GridValues {
 public:
  /// \param known table of the same request, whose entries are not computed again; none: all points are
  GridValues(const Device& device, const LutRequest& request, const Points& points, AlbedoOptions options,
             const Lut* known = nullptr)
      : device_(device), request_(request), points_(points), options_(std::move(options)), known_(known) {
    for (std::size_t a = 0; a < request.axes.size(); ++a) {
      if (is_angle(request.axes[a])) angle_ = a;
    }
    stride_.assign(request.axes.size(), columns_);
    for (std::size_t a = request.axes.size() - 1; a > 0; --a) stride_[a - 1] = stride_[a] * points[a].size();
    if (known != nullptr) find_entries();
  }

  /// \param stage of the progress
  std::vector<Estimate> compute(const ProgressCallback& progress, std::string_view stage) {
    values_.resize(count_of(points_) * columns_);
    const std::size_t angles = angle_ ? points_[*angle_].size() : 1;
    const std::size_t rows = count_of(points_) / angles;
    std::vector<std::size_t> index(request_.axes.size(), 0);
    for (std::size_t r = 0; r < rows; ++r) {
      // Where the albedo is not linear in the parameter of a split it is not so in most places.
      compute_row(index, known_ == nullptr && (r == 0 || r + 1 == rows || r == rows / 2));
      for (std::size_t a = request_.axes.size(); a-- > 0;) {
        if (a == angle_) continue;
        if (++index[a] < points_[a].size()) break;
        index[a] = 0;
      }
      if (progress && !progress(stage, static_cast<double>(r + 1) / static_cast<double>(rows))) {
        throw Cancelled("the computation of the lookup table was stopped");
      }
    }
    return std::move(values_);
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Along each axis the entry of the table that a point is.
  void find_entries() {
    for (std::size_t a = 0; a < points_.size(); ++a) {
      const LutAxis& axis = request_.axes[a];
      auto& along = entry_.emplace_back(points_[a].size(), kNone);
      std::size_t entry = 0;
      for (std::size_t i = 0; i < along.size() && entry < axis.count; ++i) {
        if (points_[a][i] == axis.coordinate(entry)) along[i] = entry++;
      }
    }
  }

  /// First number of the known table's entry at a point; none where it is no entry.
  [[nodiscard]] std::optional<std::size_t> known_at(const std::vector<std::size_t>& index) const {
    if (known_ == nullptr) return std::nullopt;
    std::size_t at = 0;
    for (std::size_t a = 0; a < index.size(); ++a) {
      const std::size_t entry = entry_[a][index[a]];
      if (entry == kNone) return std::nullopt;
      at = at * request_.axes[a].count + entry;
    }
    return at * columns_;
  }

  /// All angles of one set of parameters, which are asked together.
  /// \param index of the set; that of the angle is 0
  void compute_row(std::vector<std::size_t> index, bool checks_split) {
    std::vector<std::size_t> places;
    std::vector<double> theta;
    const std::size_t angles = angle_ ? points_[*angle_].size() : 1;
    for (std::size_t i = 0; i < angles; ++i) {
      if (angle_) index[*angle_] = i;
      std::size_t place = 0;
      for (std::size_t a = 0; a < index.size(); ++a) place += index[a] * stride_[a];
      if (const auto known = known_at(index)) {
        for (std::size_t c = 0; c < columns_; ++c) {
          values_[place + c] = {known_->values[*known + c], known_->errors[*known + c]};
        }
        continue;
      }
      places.push_back(place);
      if (angle_) theta.push_back(theta_of(request_.axes[*angle_], request_.axes[*angle_].value(points_[*angle_][i])));
    }
    if (places.empty()) return;
    Reflectance reflectance = request_.reflectance;
    for (std::size_t a = 0; a < index.size(); ++a) {
      if (a == angle_) continue;
      reflectance = with_parameter(reflectance, request_.axes[a].name, request_.axes[a].value(points_[a][index[a]]));
    }
    const auto of_row = Row(device_, request_, options_, checks_split).at(reflectance, theta);
    for (std::size_t i = 0; i < of_row.size(); ++i) values_[places[i / columns_] + i % columns_] = of_row[i];
  }

  const Device& device_;
  const LutRequest& request_;
  const Points& points_;
  AlbedoOptions options_;
  const Lut* known_;
  std::size_t columns_ = lut_columns(request_).size();
  std::optional<std::size_t> angle_;             ///< axis of the angles
  std::vector<std::size_t> stride_;              ///< of each axis, in values
  std::vector<std::vector<std::size_t>> entry_;  ///< of each axis and point
  std::vector<Estimate> values_;
};

Points entries_of(const LutRequest& request) {
  Points points;
  for (const LutAxis& axis : request.axes) {
    auto& along = points.emplace_back();
    for (std::size_t i = 0; i < axis.count; ++i) along.push_back(axis.coordinate(i));
  }
  return points;
}

/// Coordinates in steps between the entries, and from the outermost ones to the ends.
std::vector<double> refined(const LutAxis& axis, unsigned refinement) {
  std::vector<double> all;
  const auto add = [&](double from, double to) {
    for (unsigned k = 0; k < refinement; ++k) {
      all.push_back(from + (to - from) * static_cast<double>(k) / static_cast<double>(refinement));
    }
  };
  const double first = axis.coordinate(0);
  const double last = axis.coordinate(axis.count - 1);
  if (first > 0) add(0, first);
  for (std::size_t i = 0; i + 1 < axis.count; ++i) add(axis.coordinate(i), axis.coordinate(i + 1));
  if (last < 1) add(last, 1);
  all.push_back(1);
  return all;
}

/// Differences as they come, and the largest.
class Differences {
 public:
  void add(double table, const Estimate& exact, std::size_t column, std::vector<double> at) {
    const double difference = std::abs(table - exact.value);
    sum_ += difference * difference;
    ++count_;
    if (difference + exact.error < worst_.largest || !std::isfinite(difference)) return;
    worst_ = {difference + exact.error, 0, std::move(at), column, table, exact};
  }
  [[nodiscard]] LutDeviation result() const {
    LutDeviation result = worst_;
    result.rms = count_ == 0 ? 0 : std::sqrt(sum_ / static_cast<double>(count_));
    return result;
  }

 private:
  LutDeviation worst_;
  double sum_ = 0;
  std::size_t count_ = 0;
};

}  // namespace

std::string_view to_string(LutQuantity quantity) {
  return kQuantities.at(static_cast<std::size_t>(quantity));
}

LutQuantity parse_lut_quantity(std::string_view name) {
  const auto found = std::ranges::find(kQuantities, name);
  if (found == kQuantities.end()) {
    throw ArgumentError(fmt::format("unknown quantity '{}'{}", excerpt(name), did_you_mean(name, kQuantities)));
  }
  return static_cast<LutQuantity>(found - kQuantities.begin());
}

std::vector<std::string> lut_columns(const LutRequest& request) {
  std::vector<std::string> names{is_complement(request.quantity) ? "complement" : "albedo"};
  if (!request.split.empty()) names = {"scale", "bias"};
  if (has_edge(request)) names.emplace_back("edge");
  std::vector<std::string> columns;
  const std::size_t channels = request.reflectance.channels();
  for (std::size_t c = 0; c < channels; ++c) {
    for (const auto& name : names) columns.push_back(c == 0 ? name : fmt::format("{}_{}", name, c + 1));
  }
  return columns;
}

std::size_t Lut::entries() const {
  return count_of(entries_of(request));
}

Lut make_lut(const Device& device, const LutRequest& request, const LutOptions& options) {
  check(request);
  Lut lut{.request = request, .columns = lut_columns(request), .values = {}, .errors = {}};
  if (lut.entries() * lut.columns.size() > kMostValues) {
    throw ArgumentError(fmt::format("a lookup table of {} values is too large; expected at most {}",
                                    lut.entries() * lut.columns.size(), kMostValues));
  }
  const AlbedoOptions albedos{.tolerance = options.tolerance, .precision = options.precision, .missed = options.missed};
  const Points points = entries_of(request);
  for (const Estimate& value : GridValues(device, request, points, albedos).compute(options.progress, "table")) {
    lut.values.push_back(value.value);
    lut.errors.push_back(value.error);
  }
  return lut;
}

double interpolate(const Lut& lut, std::span<const double> coordinates, std::size_t column) {
  const auto& axes = lut.request.axes;
  std::vector<std::size_t> below(axes.size());
  std::vector<double> share(axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const double first = axes[a].coordinate(0);
    const double step = axes[a].coordinate(1) - first;
    const double last = static_cast<double>(axes[a].count - 1);
    const double at = std::clamp((coordinates[a] - first) / step, 0.0, last);
    below[a] = std::min(static_cast<std::size_t>(at), axes[a].count - 2);
    share[a] = at - static_cast<double>(below[a]);
  }
  double sum = 0;
  for (std::size_t corner = 0; corner < std::size_t{1} << axes.size(); ++corner) {
    double weight = 1;
    std::size_t entry = 0;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const std::size_t above = corner >> a & 1U;
      weight *= above == 1 ? share[a] : 1 - share[a];
      entry = entry * axes[a].count + below[a] + above;
    }
    // A neighbour without weight may be infinite.
    if (weight != 0) sum += weight * lut.values[entry * lut.columns.size() + column];
  }
  return sum;
}

std::vector<LutErrors> measured_errors(const Device& device, const Lut& exact,
                                       const std::vector<LutPrediction>& predictions, unsigned refinement,
                                       const LutOptions& options) {
  if (refinement < 1 || refinement > kMostRefinement) {
    throw ArgumentError(fmt::format("refinement {} is out of range; expected 1 to {} steps between entries", refinement,
                                    kMostRefinement));
  }
  const LutRequest& request = exact.request;
  const std::size_t all_columns = exact.columns.size();
  const auto differences = [&](const LutPrediction& prediction, const Points& points,
                               const std::vector<Estimate>& values, bool is_between_only) {
    Differences found;
    std::vector<double> coordinates(request.axes.size());
    std::vector<double> at(request.axes.size());
    for (std::size_t i = 0; i < count_of(points); ++i) {
      bool is_between = true;
      std::size_t rest = i;
      for (std::size_t a = request.axes.size(); a-- > 0;) {
        const LutAxis& axis = request.axes[a];
        coordinates[a] = points[a][rest % points[a].size()];
        rest /= points[a].size();
        at[a] = axis.value(coordinates[a]);
        is_between =
            is_between && coordinates[a] >= axis.coordinate(0) && coordinates[a] <= axis.coordinate(axis.count - 1);
      }
      if (is_between_only && !is_between) continue;
      for (std::size_t c = prediction.first; c < prediction.first + prediction.columns; ++c) {
        found.add(prediction.value(coordinates, c), values[i * all_columns + c], c, at);
      }
    }
    return found.result();
  };
  std::vector<Estimate> values;
  for (std::size_t i = 0; i < exact.values.size(); ++i) values.push_back({exact.values[i], exact.errors[i]});
  Points points = entries_of(request);
  std::vector<LutErrors> all;
  for (const LutPrediction& prediction : predictions) {
    const LutDeviation entries = differences(prediction, points, values, false);
    all.push_back({entries, entries, entries, count_of(points)});
  }
  if (refinement == 1) return all;

  points.clear();
  for (const LutAxis& axis : request.axes) points.push_back(refined(axis, refinement));
  if (count_of(points) * all_columns > kMostValues) {
    throw ArgumentError(
        fmt::format("{} points are too many to measure the error at; expected a smaller refinement", count_of(points)));
  }
  for (double tolerance = std::max(options.tolerance, kRoughTolerance);; tolerance /= 10) {
    tolerance = std::max(tolerance, options.tolerance);
    const AlbedoOptions albedos{.tolerance = tolerance, .precision = options.precision};
    const auto fine = GridValues(device, request, points, albedos, &exact).compute(options.progress, "error");
    bool is_sharp = true;
    for (std::size_t p = 0; p < predictions.size(); ++p) {
      LutErrors& errors = all[p];
      errors.points = count_of(points);
      errors.between = differences(predictions[p], points, fine, true);
      errors.all = differences(predictions[p], points, fine, false);
      is_sharp = is_sharp && errors.between.exact.error <= kErrorShare * errors.between.largest &&
                 errors.all.exact.error <= kErrorShare * errors.all.largest;
    }
    if (is_sharp || tolerance <= options.tolerance) break;
  }
  // What no point of the finer grid sees is at least as large as at the entries.
  for (LutErrors& errors : all) {
    if (errors.between.largest < errors.entries.largest) errors.between = errors.entries;
    if (errors.all.largest < errors.entries.largest) errors.all = errors.entries;
  }
  return all;
}

LutErrors lut_errors(const Device& device, const Lut& lut, const Lut& exact, unsigned refinement,
                     const LutOptions& options) {
  const std::size_t columns = lut.columns.size();
  const std::size_t all_columns = exact.columns.size();  // somebody else's table may have the first column alone
  if (lut.request.axes != exact.request.axes || columns > all_columns || lut.values.size() != lut.entries() * columns ||
      exact.errors.size() != exact.entries() * all_columns) {
    throw ArgumentError("the tables have different definitions; expected the same axes and columns");
  }
  const auto value = [&](std::span<const double> coordinates, std::size_t column) {
    return interpolate(lut, coordinates, column);
  };
  return measured_errors(device, exact, {{.value = value, .first = 0, .columns = columns}}, refinement, options)
      .front();
}

}  // namespace lobe
