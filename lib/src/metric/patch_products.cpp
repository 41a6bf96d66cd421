// Products under patch lights: slabs of L are refined, the worst first, until their errors meet the tolerance.
#include <algorithm>
#include <cmath>
#include <vector>

#include "hemisphere/patch_response.hpp"
#include "metric/patch_modes.hpp"
#include "metric/products.hpp"

namespace lobe {
namespace {

/// A part of the integral over L at its last levels.
struct Slab {
  std::vector<Eigen::MatrixXd> products;  ///< coarse to fine
  std::size_t level = 0;
  double difference = 0;  ///< of the last two, relative
  double safety = 1;      ///< error of the last level by that difference
};

/// How the error of a level follows from its difference to the one before: levels that fall by a factor q leave q + q^2
/// + .. = q / (1 - q). Cut off degrees fall like the first power of the degree at the slowest, the degree of levels
/// grows by 3/2.
double safety_of(double difference, double earlier) {
  constexpr double kSlowest = 2.0 / 3;
  const double q = earlier > 0 ? std::min(difference / earlier, kSlowest) : kSlowest;
  return std::max(1.0, q / (1 - q));
}

/// Differences of near-identical materials, as for point light.
void refine_close_pairs(PatchModes& modes, const std::vector<Slab>& slabs, const LobeSet& lobes,
                        const Lighting& lighting, const MetricOptions& options, ProductSums& sums) {
  // Above this share the cancellation costs less than six digits of the distance.
  const auto pairs = find_close_pairs(sums, 1e-6);
  if (pairs.empty()) return;
  const auto rows = differences(lobes, pairs);
  Eigen::VectorXd value = Eigen::VectorXd::Zero(rows.rows());
  Eigen::VectorXd error = value;
  for (std::size_t k = 0; k < slabs.size(); ++k) {
    const Eigen::VectorXd fine = modes.squares(k, slabs[k].level, rows);
    error += slabs[k].safety * (fine - modes.squares(k, slabs[k].level - 1, rows)).cwiseAbs();
    value += fine;
    report_progress(options, lighting, 1);
  }
  replace_distances(sums, pairs, rows, value, error, product_rounding(Precision::double_precision) / 4);
}

}  // namespace

std::vector<LightDisc> light_discs(std::span<const PatchShare> shares) {
  std::vector<LightDisc> discs;
  for (const auto& [radius, weight] : shares) {
    discs.push_back({radius, weight * patch_constant(radius) * patch_constant(radius)});
  }
  return discs;
}

double light_response(std::span<const PatchShare> shares, double distance) {
  double response = 0;
  for (const auto& [radius, weight] : shares) response += weight * patch_response(distance, radius);
  return response;
}

void integrate_patch_products(const Device& device, const LobeSet& lobes, const Lighting& lighting,
                              const MetricOptions& options, ProductSums& sums, Work& work) {
  report_progress(options, lighting, 0);
  PatchModes modes(device, lobes, lighting, work);
  constexpr double kEarlierShare = 0.1;  // as ProductSums counts the difference before the last
  std::vector<Slab> slabs(modes.slabs());
  const auto n = static_cast<Eigen::Index>(lobes.lobes());
  Eigen::MatrixXd reference = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < slabs.size(); ++k) {
    slabs[k].products.push_back(modes.products(k, 0));
    reference += slabs[k].products.back();
    report_progress(options, lighting, 0);
  }
  require_finite(reference, lobes, lighting);

  const auto refine = [&](std::size_t k) {
    Slab& slab = slabs[k];
    slab.products.push_back(modes.products(k, ++slab.level));
    require_finite(slab.products.back(), lobes, lighting);
    const double earlier = slab.difference;
    slab.difference = relative_difference(slab.products.back(), slab.products[slab.products.size() - 2], reference);
    slab.safety = safety_of(slab.difference, earlier);
    slab.difference = std::max(slab.difference, kEarlierShare * earlier);
    if (slab.products.size() > kLevelsKept) slab.products.erase(slab.products.begin());
  };
  for (std::size_t k = 0; k < slabs.size(); ++k) refine(k);
  // Few slabs make most of the error: the worst one is refined until their sum is below the tolerance.
  const double goal = std::max(options.tolerance, options.patch_tolerance) / (1 + kCommonShare);
  double total_difference = 0;
  for (;;) {
    total_difference = 0;
    Slab* worst = nullptr;
    for (Slab& slab : slabs) {
      const double error = slab.safety * slab.difference;
      total_difference += error;
      const bool may_grow = slab.level + 1 < PatchModes::levels();
      if (may_grow && (worst == nullptr || error > worst->safety * worst->difference)) worst = &slab;
    }
    report_progress(options, lighting, std::min(1.0, goal / total_difference));
    if (total_difference <= goal || worst == nullptr) break;
    refine(static_cast<std::size_t>(worst - slabs.data()));
  }
  for (const Slab& slab : slabs) sums.add_lobe_products(slab.products, slab.safety);
  const double rounding = product_rounding(Precision::double_precision);
  for (auto& total : sums.totals()) {
    total.gram_error += (rounding + kCommonShare * total_difference) * total.gram.cwiseAbs();
    const Eigen::VectorXd squares = rounding * total.gram.diagonal();
    total.squared_distance_error.colwise() += squares;
    total.squared_distance_error.rowwise() += squares.transpose();
  }
  refine_close_pairs(modes, slabs, lobes, lighting, options, sums);
}

}  // namespace lobe
