#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/stopwatch.hpp"
#include "lobe/error.hpp"
#include "lobe/metric.hpp"
#include "metric/products.hpp"
#include "model/lobes.hpp"

namespace lobe {
namespace {

/// Root of a value known to an error, and the error of the root.
std::pair<double, double> root(double squared, double error) {
  const double value = std::sqrt(std::max(0.0, squared));
  if (error == 0) return {value, 0};
  const double above = std::sqrt(std::max(0.0, squared + error)) - value;
  const double below = value - std::sqrt(std::max(0.0, squared - error));
  return {value, std::max(above, below)};
}

Metric make_metric(ChannelProducts products) {
  const Eigen::Index n = products.gram.rows();
  Metric metric{std::move(products.gram), std::move(products.gram_error), Eigen::VectorXd(n),
                Eigen::VectorXd(n),       Eigen::MatrixXd::Zero(n, n),    Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    std::tie(metric.norm(i), metric.norm_error(i)) = root(metric.gram(i, i), metric.gram_error(i, i));
    for (Eigen::Index j = 0; j < i; ++j) {
      const auto [value, error] = root(products.squared_distance(i, j), products.squared_distance_error(i, j));
      metric.distance(i, j) = metric.distance(j, i) = value;
      metric.distance_error(i, j) = metric.distance_error(j, i) = error;
    }
  }
  return metric;
}

std::vector<double> channel_weights(const MetricOptions& options, std::size_t channels) {
  if (options.channel_weights.empty()) return std::vector<double>(channels, 1.0 / static_cast<double>(channels));
  if (options.channel_weights.size() != channels) {
    throw ArgumentError(std::to_string(options.channel_weights.size()) + " channel weights for " +
                        std::to_string(channels) + " channels; expected one per channel");
  }
  for (const double weight : options.channel_weights) {
    if (!(weight >= 0) || !std::isfinite(weight))
      throw ArgumentError("a channel weight is negative or no finite number");
  }
  return options.channel_weights;
}

/// \throws NumericError naming two materials whose product is no finite number
void require_finite(const ChannelProducts& products, std::span<const Material> materials, Lighting lighting) {
  if (products.gram.allFinite() && products.squared_distance.allFinite()) return;
  for (Eigen::Index j = 0; j < products.gram.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      if (std::isfinite(products.gram(i, j)) && std::isfinite(products.squared_distance(i, j))) continue;
      throw NumericError("the product of '" + materials[static_cast<std::size_t>(i)].name + "' and '" +
                         materials[static_cast<std::size_t>(j)].name + "' under lighting '" +
                         std::string(to_string(lighting)) + "' is no finite number");
    }
  }
}

std::vector<Unresolved> find_unresolved(const Metric& metric, double tolerance) {
  std::vector<Unresolved> list;
  for (Eigen::Index j = 0; j < metric.gram.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      const double error = metric.gram_error(i, j);
      if (error <= tolerance * std::abs(metric.gram(i, j))) continue;
      list.push_back({static_cast<std::size_t>(i), static_cast<std::size_t>(j), error / std::abs(metric.gram(i, j))});
    }
  }
  std::sort(list.begin(), list.end(),
            [](const Unresolved& a, const Unresolved& b) { return a.relative_error > b.relative_error; });
  return list;
}

}  // namespace

MetricResult measure(const Device& device, std::span<const Material> materials, Lighting lighting,
                     const MetricOptions& options) {
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw ArgumentError("tolerance out of range; expected a value in (0, 1)");
  const LobeSet lobes = make_lobe_set(materials);
  ProductSums sums(lobes, channel_weights(options, lobes.channels()));
  MetricResult result;
  result.lighting = lighting;
  if (lighting == Lighting::point) {
    integrate_point_products(device, lobes, options, sums, result.work);
  } else {
    integrate_daylight_products(device, lobes, options, sums, result.work);
  }

  Stopwatch watch;
  auto& totals = sums.totals();
  for (const auto& products : totals) require_finite(products, materials, lighting);
  result.combined = make_metric(std::move(totals.back()));
  if (lobes.channels() > 1) {
    for (std::size_t c = 0; c < lobes.channels(); ++c) result.channels.push_back(make_metric(std::move(totals[c])));
  }
  result.unresolved =
      find_unresolved(result.combined, std::max(options.tolerance, 2 * product_rounding(options.precision)));
  result.work.seconds_host += watch.lap();
  return result;
}

Estimate scalar_product(const Device& device, const Material& f, const Material& g, Lighting lighting,
                        const MetricOptions& options) {
  const auto result = measure(device, std::vector<Material>{f, g}, lighting, options);
  return {result.combined.gram(0, 1), result.combined.gram_error(0, 1)};
}

Estimate distance(const Device& device, const Material& f, const Material& g, Lighting lighting,
                  const MetricOptions& options) {
  const auto result = measure(device, std::vector<Material>{f, g}, lighting, options);
  return {result.combined.distance(0, 1), result.combined.distance_error(0, 1)};
}

}  // namespace lobe
