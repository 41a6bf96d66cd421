#include "lobe/reflectance/composition.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "algebra/function_composition.hpp"
#include "algebra/pointwise.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "model/delta.hpp"
#include "model/delta_shares.hpp"
#include "model/lobes.hpp"
#include "reflectance/prepared.hpp"

namespace lobe {
namespace {

using Composed = std::vector<std::vector<Estimate>>;

/// A formula without its delta parts; anything else as it is.
Reflectance smooth_reflectance(const Reflectance& reflectance) {
  const Material* formula = reflectance.formula();
  return formula != nullptr && reflectance.has_delta() ? Reflectance(smooth_part(*formula)) : reflectance;
}

Composed smooth_composition_at(const Device& device, const Reflectance& f, const Reflectance& g,
                               std::span<const Directions> directions, const PointwiseOptions& options) {
  const bool are_formulas = f.formula() != nullptr && g.formula() != nullptr;
  if (are_formulas && f.is_isotropic() && g.is_isotropic()) {
    return composition_at(device, *f.formula(), *g.formula(), directions, options);
  }
  return composition_at(function_of(device, f), function_of(device, g), directions, options);
}

/// Smallest width of a formula's lobes, radians; 1 of what is no formula.
double narrowest_of(const Reflectance& reflectance) {
  const Material* formula = reflectance.formula();
  if (formula == nullptr) return 1;
  const Material smooth = smooth_part(*formula);
  if (smooth.terms.empty()) return 1;
  return make_lobe_set({&smooth, 1}, {.with_anisotropic = true}).sharpest();
}

/// Which factor of a composition has the delta part: the first turns L, the second V.
enum class DeltaOf { first, second };

constexpr double kBeside = 1e-13;        // radians, so small that values change in proportion
constexpr double kTurnRounding = 5e-16;  // radians, of an azimuth that is turned by half a turn

/// Adds the values of the other factor in the direction that a delta part sends light to, times what that reflects.
void add_deltas_of(const Device& device, DeltaOf which, const Reflectance& delta, const Reflectance& other,
                   std::span<const Directions> directions, Precision precision, Composed& result) {
  const Material* formula = delta.formula();
  if (formula == nullptr || !delta.has_delta() || directions.empty()) return;
  const BrdfFunction values_of = smooth_function(device, other, precision);
  const double width = narrowest_of(other);
  std::vector<double> elevations;
  std::vector<Directions> mirrored;
  for (const Directions& pair : directions) {
    const bool is_first = which == DeltaOf::first;
    elevations.push_back(std::numbers::pi / 2 - (is_first ? pair.theta_in : pair.theta_out));
    mirrored.push_back(pair);
    mirrored.back().delta_phi += is_first ? -std::numbers::pi : std::numbers::pi;
    if (is_first) mirrored.back().phi_in += std::numbers::pi;
  }
  const DeltaParts parts = delta_parts(device, split_delta(*formula).deltas, formula->channels(), elevations);
  const auto add = [&](const Eigen::MatrixXd& shares, std::span<const Directions> pairs) {
    if (shares.size() == 0 || (shares.array() == 0).all()) return;
    const BrdfValues found = values_of.at(pairs);
    std::vector<Directions> beside(pairs.begin(), pairs.end());
    for (Directions& pair : beside) pair.delta_phi += kBeside;
    const Eigen::MatrixXd change = values_of.at(beside).value - found.value;
    for (std::size_t c = 0; c < result.size(); ++c) {
      const auto share_row = shares.rows() == 1 ? 0 : static_cast<Eigen::Index>(c);
      const auto column = found.value.cols() == 1 ? 0 : static_cast<Eigen::Index>(c);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        const double share = shares(share_row, at);
        const double value = share * found.value(at, column);
        result[c][k].value += value;
        result[c][k].error += pointwise_rounding(precision, std::abs(value), width) * std::abs(value) +
                              kTurnRounding / kBeside * std::abs(share * change(at, column));
        if (found.error.size() > 0) result[c][k].error += share * found.error(at, column);
      }
    }
  };
  add(parts.mirror, mirrored);
  add(parts.retro, directions);
}

void add_delta_compositions(const Device& device, const Reflectance& f, const Reflectance& g,
                            std::span<const Directions> directions, Precision precision, Composed& result) {
  add_deltas_of(device, DeltaOf::first, f, g, directions, precision, result);
  add_deltas_of(device, DeltaOf::second, g, f, directions, precision, result);
}

}  // namespace

bool can_be_composed(const Reflectance& reflectance) {
  const Material* formula = reflectance.formula();
  if (formula == nullptr || formula->adjustments.empty()) return can_be_factor(reflectance);
  const bool gets_delta = std::ranges::any_of(
      formula->adjustments, [](const Adjustment& adjustment) { return adjustment.kind == Adjustment::Kind::mirror; });
  return !gets_delta && can_be_factor(reflectance);
}

BrdfTable compose(const Device& device, const Reflectance& f, const Reflectance& g, const HemisphereGrid& grid,
                  const ComposeOptions& options) {
  return compose_factors(device, adjusted(device, f), adjusted(device, g), grid, options);
}

std::vector<std::vector<Estimate>> composition_at(const Device& device, const Reflectance& f, const Reflectance& g,
                                                  std::span<const Directions> directions,
                                                  const PointwiseOptions& options) {
  const Reflectance first = adjusted(device, f);
  const Reflectance second = adjusted(device, g);
  auto result =
      smooth_composition_at(device, smooth_reflectance(first), smooth_reflectance(second), directions, options);
  add_delta_compositions(device, first, second, directions, options.precision, result);
  return result;
}

}  // namespace lobe
