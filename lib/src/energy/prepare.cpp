#include "energy/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "energy/channel_albedo.hpp"
#include "energy/mirror_extension.hpp"
#include "energy/multiple_scattering.hpp"
#include "energy/pumping.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/estimate.hpp"
#include "model/evaluate.hpp"
#include "model/formula_tree.hpp"
#include "model/formula_value.hpp"
#include "model/values.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// "theta_in = 12, theta_out = 80, delta_phi = 170 degrees".
std::string describe(const Directions& pair) {
  const auto degrees = [](double radians) { return shortest(std::round(radians * 1800 / pi) / 10 + 0.0); };
  return "theta_in = " + degrees(pair.theta_in) + ", theta_out = " + degrees(pair.theta_out) +
         ", delta_phi = " + degrees(pair.delta_phi) + " degrees";
}

/// Pairs from all over, some near the normal and some grazing, every second one the exchange of the one before.
std::vector<Directions> probes() {
  constexpr int kPairs = 256;
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> theta(0.01, pi / 2 - 1e-3);
  std::uniform_real_distribution<double> phi(-pi, pi);
  std::vector<Directions> list;
  for (int i = 0; i < kPairs; ++i) {
    const Directions pair{theta(engine), theta(engine), phi(engine), phi(engine)};
    list.push_back(pair);
    list.push_back({pair.theta_out, pair.theta_in, -pair.delta_phi, pair.phi_in + pair.delta_phi});
  }
  return list;
}

/// Holds values from the device against those that the host computes of the formula, where these are known.
/// \throws DeviceError where they differ by more than rounding may do
void require_host_values(const Device& device, const Term& term, const std::string& name,
                         const std::vector<Directions>& directions, const Eigen::MatrixXd& values) {
  constexpr double kTellable = 1e-3;  // values that rounding may change by more than this tell nothing
  constexpr double kFloor = 1e-6;     // values are compared as shares of this much of the largest, at least
  constexpr double kAllowed = 1e-11;
  const FormulaTree tree = read_formula_tree(*term.formula);
  const double floor = kFloor * values.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Estimate expected = formula_value(tree, term.values, directions[i]);
    const double size = std::max(std::abs(expected.value), floor);
    if (!(expected.error <= kTellable * size)) continue;
    const double seen = values(static_cast<Eigen::Index>(i), 0);
    if (std::abs(seen - expected.value) <= expected.error + kAllowed * size) continue;
    throw DeviceError("OpenCL device " + device.info().name + " (" + device.info().driver +
                          ") computes wrongly: the formula of '" + name + "' is " + shortest(seen) + " at " +
                          describe(directions[i]) + "; expected " + shortest(expected.value) +
                          ". Empty the kernel cache (POCL_CACHE_DIR) or choose another device",
                      {}, {.fault = Fault::wrong_results});
  }
}

void test_formula(const Device& device, const Term& term, const std::string& name) {
  constexpr double kRounding = 1e-9;
  static const std::vector<Directions> directions = probes();
  const Formula& formula = *term.formula;
  const std::string where = formula.file.empty() ? std::string()
                                                 : formula.file + ":" + std::to_string(formula.line) + ":" +
                                                       std::to_string(formula.column) + ": ";
  Term alone = term;
  alone.weight = {1.0};
  alone.factors.clear();
  const Eigen::MatrixXd values = unchecked_values(device, {name, {}, {alone}}, directions);
  for (Eigen::Index i = 0; i < values.rows(); i += 2) {
    const double there = values(i, 0);
    const double back = values(i + 1, 0);
    const Directions& pair = directions[static_cast<std::size_t>(i)];
    if (!std::isfinite(there) || !std::isfinite(back)) {
      throw ArgumentError(where + "formula of '" + name + "' is no finite number at " + describe(pair) +
                          "; expected one for all directions above the horizon");
    }
    if (formula.reciprocal && std::abs(there - back) > kRounding * (std::abs(there) + std::abs(back))) {
      throw ArgumentError(where + "formula of '" + name + "' is " + shortest(there) + " at " + describe(pair) +
                          " and " + shortest(back) +
                          " with L and V exchanged; expected the same, or 'reciprocal = false'");
    }
  }
  if (!term.pumping) require_host_values(device, term, name, directions, values);
}

Material normalised(const Device& device, Material material) {
  constexpr double kHorizon = 89.9999 * kDegree;
  constexpr double kPrecise = 1e-8;
  constexpr double kEnough = 1e-6;
  require_isotropic(material, "the adjustment 'normalise'; of others, tables can be normalised");
  double largest = 0;
  double error = 0;
  for (const AlbedoPeak& peak : largest_albedo(device, material, kHorizon, {.tolerance = kPrecise})) {
    if (peak.albedo.value < largest) continue;
    largest = peak.albedo.value;
    error = peak.albedo.error;
  }
  if (!(largest > 0)) throw NumericError("material '" + material.name + "' cannot be normalised: its albedo is 0");
  if (error > kEnough * largest) {
    throw NumericError("material '" + material.name + "' cannot be normalised: its largest albedo is known to " +
                       shortest(error / largest) + " only; expected " + shortest(kEnough));
  }
  for (Term& term : material.terms) {
    for (double& weight : term.weight) weight /= largest;
  }
  return material;
}

}  // namespace

bool needs_preparation(const Material& material) {
  const auto has_formula = [](const Term& term) { return term.formula.has_value(); };
  return !material.adjustments.empty() || std::ranges::any_of(material.terms, has_formula);
}

Material prepare(const Device& device, Material material) {
  for (const Term& term : material.terms) {
    if (term.formula) test_formula(device, term, material.name);
  }
  const auto adjustments = std::exchange(material.adjustments, {});
  for (const Adjustment& adjustment : adjustments) {
    switch (adjustment.kind) {
      case Adjustment::Kind::normalise:
        material = normalised(device, std::move(material));
        break;
      case Adjustment::Kind::pump:
        material = pumped(device, material, adjustment);
        break;
      case Adjustment::Kind::mirror:
        material = extended_by_mirror(device, material, adjustment);
        break;
      case Adjustment::Kind::kulla_conty:
        material = with_multiple_scattering(device, material);
        break;
      case Adjustment::Kind::turquin:
        material = scaled_for_viewers(device, material);
        break;
    }
  }
  return material;
}

}  // namespace lobe
