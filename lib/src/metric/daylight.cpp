// Products under daylight and of mean albedos: albedos on the device, their products on the host.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/stopwatch.hpp"
#include "energy/albedo_integrator.hpp"
#include "hemisphere/refinement.hpp"
#include "metric/products.hpp"

namespace lobe {
namespace {

/// Accumulates products from factors F, lobes x columns, with products F F^T over a slab at a level.
template <typename Factors>
void integrate_factors(std::size_t slabs, const LobeSet& lobes, const Lighting& lighting, const MetricOptions& options,
                       ProductSums& sums, WorkDone& work, const Factors& factors) {
  const auto products = [](const Eigen::MatrixXd& f) -> Eigen::MatrixXd { return f * f.transpose(); };

  const auto n = static_cast<Eigen::Index>(lobes.lobes());
  Eigen::MatrixXd reference = Eigen::MatrixXd::Zero(n, n);
  std::vector<Eigen::MatrixXd> first(slabs);
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    first[slab] = factors(slab, 0);
    reference += products(first[slab]);
  }
  require_finite(reference, lobes, lighting);

  const double rounding = product_rounding(options.precision);
  const double goal =
      std::max(options.tolerance - 2 * rounding, rounding) / (1 + kCommonShare) / static_cast<double>(slabs);
  double total_difference = 0;
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    std::vector<Eigen::MatrixXd> refined{std::move(first[slab])};
    Stopwatch watch;
    double change = 0;
    double difference = 0;
    for (int level = 1; level < kLevels; ++level) {
      refined.push_back(factors(slab, level));
      watch.lap();
      require_finite(refined.back(), lobes, lighting);
      if (refined.size() > kLevelsKept) refined.erase(refined.begin());
      const double earlier = change;
      change = relative_difference(products(refined.back()), products(refined[refined.size() - 2]), reference);
      difference = std::max(change, kEarlierShare * earlier);
      work.seconds_host += watch.lap();
      if (difference <= goal) break;
    }
    total_difference += difference;
    watch.lap();
    sums.add_lobe_factors(refined);
    work.seconds_host += watch.lap();
    report_progress(options, lighting, static_cast<double>(slab + 1) / static_cast<double>(slabs));
  }
  for (auto& total : sums.totals()) {
    total.gram_error += (rounding + kCommonShare * total_difference) * total.gram.cwiseAbs();
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

void integrate_daylight_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                                 ProductSums& sums, WorkDone& work) {
  report_progress(options, Lighting::daylight(), 0);
  AlbedoIntegrator integrator(device, lobes, options.precision, Given::light, options.tolerance);

  /// Albedos times the root of the incident weights.
  const auto factors = [&](std::size_t slab, int level) {
    const auto incident = integrator.rule().incident_nodes(slab, level);
    Eigen::MatrixXd result = integrator.integrate(incident, level, work);
    for (std::size_t k = 0; k < incident.size(); ++k) {
      result.col(static_cast<Eigen::Index>(k)) *= std::sqrt(incident[k].weight);
    }
    return result;
  };
  integrate_factors(integrator.rule().slabs(), lobes, Lighting::daylight(), options, sums, work, factors);
}

void integrate_mean_albedo_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                                    ProductSums& sums, WorkDone& work) {
  report_progress(options, Lighting::mean_albedo(), 0);
  AlbedoIntegrator integrator(device, lobes, options.precision, Given::light, options.tolerance);

  /// A single column: pi times the mean albedos. It takes all slabs at once, for products of sums.
  const auto factors = [&](std::size_t, int level) -> Eigen::MatrixXd {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(lobes.lobes()), 1);
    for (std::size_t slab = 0; slab < integrator.rule().slabs(); ++slab) {
      const auto incident = integrator.rule().incident_nodes(slab, level);
      Eigen::VectorXd weights(static_cast<Eigen::Index>(incident.size()));
      for (std::size_t k = 0; k < incident.size(); ++k) weights(static_cast<Eigen::Index>(k)) = incident[k].weight;
      sum += integrator.integrate(incident, level, work) * weights;
    }
    return sum;
  };
  integrate_factors(1, lobes, Lighting::mean_albedo(), options, sums, work, factors);
}

}  // namespace lobe
