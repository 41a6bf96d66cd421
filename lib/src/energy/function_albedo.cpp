#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "hemisphere/albedo_rule.hpp"
#include "hemisphere/node_directions.hpp"
#include "lobe/energy.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kBlock = 4096;  // nodes
constexpr int kCoarse = 0;            // levels of quadrature, far enough apart not to agree by accident
constexpr int kFine = 2;
constexpr double kSafety = 3;  // of the difference of both: measured functions have kinks and jumps

/// Sums over the hemisphere of V, by channel.
struct Sums {
  Eigen::RowVectorXd value;
  Eigen::RowVectorXd error;
};

/// Both signs of delta_phi, of bilateral functions one for both.
void add_block(const BrdfFunction& function, const NodeBlock& block, Sums& sums) {
  const std::size_t signs = function.is_bilateral ? 1 : 2;
  std::vector<Directions> pairs;
  Eigen::RowVectorXd weights(static_cast<Eigen::Index>(signs * block.size()));
  for (std::size_t node = 0; node < block.size(); ++node) {
    for (std::size_t sign = 0; sign < signs; ++sign) {
      weights(static_cast<Eigen::Index>(pairs.size())) = factor_at(block, node) / static_cast<double>(signs);
      pairs.push_back(directions_at(block, node));
      if (sign == 1) pairs.back().delta_phi *= -1;
    }
  }
  const BrdfValues values = function.at(pairs);
  if (!values.value.allFinite()) throw NumericError("'" + function.name + "' has values that are no finite numbers");
  sums.value += weights * values.value;
  if (values.error.size() > 0) sums.error += weights * values.error;
}

Sums integrate(const BrdfFunction& function, const AlbedoRule& rule, double theta, int level) {
  const auto channels = static_cast<Eigen::Index>(function.channels.size());
  Sums sums{Eigen::RowVectorXd::Zero(channels), Eigen::RowVectorXd::Zero(channels)};
  NodeBlock block(kBlock);
  const auto take = [&] {
    add_block(function, block, sums);
    block.clear();
  };
  rule.place(pi / 2 - theta, level, block, take);
  if (block.size() > 0) take();
  return sums;
}

}  // namespace

std::vector<std::vector<Estimate>> albedo(const BrdfFunction& function, std::span<const double> theta_in,
                                          double lobe_width) {
  require_no_delta(function, "expected values alone");
  for (const double theta : theta_in) {
    if (theta >= 0 && theta < pi / 2) continue;
    throw ArgumentError("angle of incidence of " + shortest(theta * 180 / pi) +
                        " degrees; expected a value in [0, 90) degrees");
  }
  const AlbedoRule rule(LobeExtent{.width = lobe_width, .patch_radii = {}, .retro_patch_radii = {}});
  std::vector<std::vector<Estimate>> result(function.channels.size(), std::vector<Estimate>(theta_in.size()));
  const auto integrate_at = [&](std::size_t k) {
    const Sums coarse = integrate(function, rule, theta_in[k], kCoarse);
    const Sums fine = integrate(function, rule, theta_in[k], kFine);
    for (std::size_t c = 0; c < result.size(); ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      result[c][k] = {fine.value(at), kSafety * std::abs(fine.value(at) - coarse.value(at)) + fine.error(at)};
    }
  };
  if (function.is_concurrent) {
    parallel_for(theta_in.size(), integrate_at);
  } else {
    for (std::size_t k = 0; k < theta_in.size(); ++k) integrate_at(k);
  }
  return result;
}

}  // namespace lobe
