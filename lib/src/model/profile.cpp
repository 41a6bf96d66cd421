#include "lobe/model/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/catalogue.hpp"

namespace lobe {
namespace {

constexpr double kWholeBasePlane = 2;
constexpr double kClosest = 0.999;  // quotient of neighbouring distances
constexpr double kFarthest = 1e-3;
constexpr double kNearest = 1e-5;  // to 0

void require_values(std::span<const CurvePoint> points, std::string_view name, double first) {
  if (points.size() < 2) {
    throw ArgumentError(fmt::format("'{}' has {} points; expected at least two", name, points.size()));
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [at, value] = points[k];
    if (!(at >= first && at <= kWholeBasePlane)) {
      throw ArgumentError(fmt::format("point {} of '{}' is at {}; expected a base-plane distance from {} to 2", k + 1,
                                      name, shortest(at), shortest(first)));
    }
    if (!(value >= 0) || !std::isfinite(value)) {
      throw ArgumentError(fmt::format("point {} of '{}' has the value {}; expected a finite one, not below 0", k + 1,
                                      name, shortest(value)));
    }
  }
}

[[noreturn]] void refuse_step(std::span<const CurvePoint> points, std::size_t k, std::string_view name,
                              std::string_view expected) {
  throw ArgumentError(fmt::format("points {} and {} of '{}' are at {} and {}; expected {}", k + 1, k + 2, name,
                                  shortest(points[k].at), shortest(points[k + 1].at), expected));
}

Term weighted(std::string_view model, const std::vector<NamedValue>& parameters, double weight) {
  Term term = make_material(model, parameters).terms.front();
  term.weight = {weight};
  return term;
}

/// A patch model that is `height` in its middle.
Term of_height(std::string_view model, const std::vector<NamedValue>& parameters, double height) {
  Term term = weighted(model, parameters, 1);
  term.weight = {height / find_entry(model).coefficients(term.values).front()};
  return term;
}

}  // namespace

std::vector<Term> make_profile(std::span<const CurvePoint> points) {
  constexpr std::string_view kName = "profile";
  require_values(points, kName, 0);
  if (points.front().at != 0) {
    throw ArgumentError(fmt::format("point 1 of 'profile' is at {}; expected 0", shortest(points.front().at)));
  }
  std::vector<Term> terms;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const double low = points[k].at;
    const double high = points[k + 1].at;
    if (high < low || high < kNearest || (high > low && low > kClosest * high)) {
      refuse_step(points, k, kName, "rising distances from 1e-5 on, a thousandth apart or the same for a jump");
    }
    const double fall = points[k].value - points[k + 1].value;
    if (fall == 0) continue;
    terms.push_back(low == high ? of_height("basic_patch", {{"R", high}}, fall)
                                : of_height("patch_frustum", {{"R", high}, {"inner", low / high}}, fall));
  }
  const auto [end, rest] = points.back();
  if (rest > 0) terms.push_back(of_height("basic_patch", {{"R", end}}, rest));
  if (terms.empty()) throw ArgumentError("'profile' is 0; expected a value above it");
  return terms;
}

std::vector<Term> make_mixture(std::span<const CurvePoint> points) {
  constexpr std::string_view kName = "mixture";
  require_values(points, kName, find_model("patch_band").parameters.front().minimum);
  std::vector<Term> terms;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const auto [low, p_low] = points[k];
    const auto [high, p_high] = points[k + 1];
    if (low > kClosest * high || low < kFarthest * high) {
      refuse_step(points, k, kName, "rising radii, a thousandth apart and at most a thousandfold");
    }
    const double sum = p_low + p_high;
    if (sum == 0) continue;
    terms.push_back(
        weighted("patch_band", {{"R", high}, {"inner", low / high}, {"rise", p_high / sum}}, (high - low) * sum / 2));
  }
  if (terms.empty()) throw ArgumentError("'mixture' is 0; expected a value above it");
  return terms;
}

}  // namespace lobe
