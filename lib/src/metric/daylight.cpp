// Products under daylight and of mean albedos: albedos on the device, their products on the host.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/stopwatch.hpp"
#include "device/rounding.hpp"
#include "energy/albedo_integrator.hpp"
#include "metric/products.hpp"

namespace lobe {
namespace {

/// Light comes from everywhere, and what is not reciprocal is seen by the viewer.
Given given_of(const LobeSet& lobes) {
  return lobes.both_orders ? Given::viewer : Given::light;
}

/// Accumulates products from factors F of slabs at levels, lobes x columns.
/// \param store slabs that are known or left to others, or none
/// \param products those of factors, such as F F^T
/// \param add takes the factors of a slab at its levels
template <typename Factors, typename Products, typename Add>
void integrate_factors(std::size_t slabs, const LobeSet& lobes, const Lighting& lighting, const MetricOptions& options,
                       ProductSums& sums, WorkDone& work, const SlabStore* store, const Factors& factors,
                       const Products& products, const Add& add) {
  const SlabWork share(store, slabs);

  const auto n = static_cast<Eigen::Index>(lobes.lobes());
  Eigen::MatrixXd reference = Eigen::MatrixXd::Zero(n, n);
  std::vector<Eigen::MatrixXd> coarse(slabs);
  std::vector<WorkDone> first(slabs);
  for (std::size_t slab = 0; slab < slabs && share.has_unknown(); ++slab) {
    const WorkDone before = work;
    coarse[slab] = factors(slab, 0);
    first[slab] = share.first_pass(slab, before, work);
    reference += products(coarse[slab]);
  }
  require_finite(reference, lobes, lighting);

  const double rounding = product_rounding(options.precision);
  const double goal = std::max(options.tolerance - 2 * rounding, rounding) / (level_safety(lobes) + kCommonShare) /
                      static_cast<double>(slabs);
  const auto refined_slab = [&](std::size_t slab) {
    const WorkDone before = work;
    RefinedSlab refined;
    auto& levels = refined.levels;
    levels.push_back(std::move(coarse[slab]));
    Stopwatch watch;
    double change = 0;
    for (int level = 1; level < most_levels(lobes); ++level) {
      levels.push_back(factors(slab, level));
      watch.lap();
      require_finite(levels.back(), lobes, lighting);
      if (levels.size() > kLevelsKept) levels.erase(levels.begin());
      refined.level = level;
      const double earlier = change;
      change = relative_difference(products(levels.back()), products(levels[levels.size() - 2]), reference);
      refined.difference = std::max(change, kEarlierShare * earlier);
      work.seconds_host += watch.lap();
      if (refined.difference <= goal) break;
    }
    const WorkDone spent = difference_of(work, before);
    refined.nodes = first[slab].nodes + spent.nodes;
    refined.evaluations = first[slab].evaluations + spent.evaluations;
    return refined;
  };
  double total_difference = 0;
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    if (!share.takes(slab)) continue;
    const RefinedSlab refined = take_slab(share, slab, lobes.lobes(), work, refined_slab);
    report_progress(options, lighting, static_cast<double>(slab + 1) / static_cast<double>(slabs));
    if (!share.is_complete()) continue;
    total_difference += refined.difference;
    Stopwatch watch;
    add(refined.levels);
    work.seconds_host += watch.lap();
  }
  if (!share.is_complete()) return;
  for (auto& total : sums.totals()) {
    add_common_share(total_difference, total);
    total.gram_error += rounding * total.gram.cwiseAbs();
    // Albedos are known to their rounding, so |d^2| moves by 2 d (e_i + e_j); identical materials stay at zero.
    const Eigen::ArrayXd norms = rounding / 4 * total.gram.diagonal().array().max(0).sqrt();
    for (Eigen::Index j = 0; j < norms.size(); ++j) {
      for (Eigen::Index i = 0; i < norms.size(); ++i) {
        const double squared = total.squared_distance(i, j);
        const double samples = norms(i) + norms(j);
        if (squared > 0) total.squared_distance_error(i, j) += samples * (2 * std::sqrt(squared) + samples);
      }
    }
  }
}

}  // namespace

std::size_t daylight_slabs(const LobeSet& lobes, const MetricOptions& options) {
  return AlbedoRule(given_extent(lobes, given_of(lobes)), options.tolerance).slabs();
}

void integrate_daylight_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                                 ProductSums& sums, WorkDone& work) {
  report_progress(options, Lighting::daylight(), 0);
  AlbedoIntegrator integrator(device, lobes, options.precision, given_of(lobes), options.tolerance,
                              SharedRule::by_limits);

  /// Albedos times the root of the incident weights.
  const auto factors = [&](std::size_t slab, int level) {
    const auto incident = integrator.rule().incident_nodes(slab, level);
    Eigen::MatrixXd result = integrator.integrate(incident, level, work);
    for (std::size_t k = 0; k < incident.size(); ++k) {
      result.col(static_cast<Eigen::Index>(k)) *= std::sqrt(incident[k].weight);
    }
    return result;
  };
  const auto products = [](const Eigen::MatrixXd& f) -> Eigen::MatrixXd { return f * f.transpose(); };
  integrate_factors(integrator.rule().slabs(), lobes, Lighting::daylight(), options, sums, work, sums.slabs(), factors,
                    products, [&](const auto& levels) { sums.add_lobe_factors(levels, level_safety(lobes)); });
}

void integrate_mean_albedo_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                                    ProductSums& sums, WorkDone& work) {
  report_progress(options, Lighting::mean_albedo(), 0);
  AlbedoIntegrator integrator(device, lobes, options.precision, given_of(lobes), options.tolerance,
                              SharedRule::by_limits);

  /// A column per slab, whose sum is pi times the mean albedos: all are refined at once, for products of sums.
  const auto factors = [&](std::size_t, int level) -> Eigen::MatrixXd {
    const std::size_t slabs = integrator.rule().slabs();
    Eigen::MatrixXd columns(static_cast<Eigen::Index>(lobes.lobes()), static_cast<Eigen::Index>(slabs));
    for (std::size_t slab = 0; slab < slabs; ++slab) {
      const auto incident = integrator.rule().incident_nodes(slab, level);
      Eigen::VectorXd weights(static_cast<Eigen::Index>(incident.size()));
      for (std::size_t k = 0; k < incident.size(); ++k) weights(static_cast<Eigen::Index>(k)) = incident[k].weight;
      columns.col(static_cast<Eigen::Index>(slab)) = integrator.integrate(incident, level, work) * weights;
    }
    return columns;
  };
  const auto products = [](const Eigen::MatrixXd& f) -> Eigen::MatrixXd {
    const Eigen::VectorXd whole = f.rowwise().sum();
    return whole * whole.transpose();
  };
  integrate_factors(1, lobes, Lighting::mean_albedo(), options, sums, work, nullptr, factors, products,
                    [&](const auto& levels) { sums.add_lobe_integrals(levels, level_safety(lobes)); });
}

}  // namespace lobe
