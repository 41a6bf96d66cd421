#include "metric/channel_metric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

/// Root of a value known to an error, and the error of the root; NaN where the value is negative, beyond its error and
/// the rounding of products of a size.
std::pair<double, double> root(double squared, double error, double size) {
  constexpr double kRounding = 1e-12;
  if (squared < -(error + kRounding * size)) return {std::nan(""), std::nan("")};
  const double value = std::sqrt(std::max(0.0, squared));
  if (std::isnan(error) && squared < 0) return {std::nan(""), std::nan("")};
  if (error == 0 || std::isnan(error)) return {value, error};
  const double above = std::sqrt(std::max(0.0, squared + error)) - value;
  const double below = value - std::sqrt(std::max(0.0, squared - error));
  return {value, std::max(above, below)};
}

/// Adds what is lost where samples of reflectances underflow: of sizes whose squares are hardly numbers any more.
/// \param is_black which are 0 everywhere; none: those without a norm
void add_underflow(const std::vector<bool>& is_black, ChannelProducts& products) {
  constexpr double kSmall = 1e-290;
  constexpr double kLost = std::numeric_limits<double>::min();
  const Eigen::Index n = products.gram.rows();
  std::vector<bool> is_tiny;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double square = products.gram(i, i);
    const bool is_zero = is_black.empty() ? square == 0 : is_black[static_cast<std::size_t>(i)];
    is_tiny.push_back(!is_zero && std::abs(square) < kSmall);
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!is_tiny[static_cast<std::size_t>(i)] && !is_tiny[static_cast<std::size_t>(j)]) continue;
      products.gram_error(i, j) += kLost;
      if (i != j) products.squared_distance_error(i, j) += kLost;
    }
  }
}

}  // namespace

Metric make_metric(ChannelProducts products, const std::vector<bool>& is_black) {
  add_underflow(is_black, products);
  const Eigen::Index n = products.gram.rows();
  const double size = n > 0 ? products.gram.cwiseAbs().maxCoeff() : 0;
  Metric metric{std::move(products.gram), std::move(products.gram_error), Eigen::VectorXd(n),
                Eigen::VectorXd(n),       Eigen::MatrixXd::Zero(n, n),    Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    std::tie(metric.norm(i), metric.norm_error(i)) = root(metric.gram(i, i), metric.gram_error(i, i), size);
    for (Eigen::Index j = 0; j < i; ++j) {
      const auto [value, error] = root(products.squared_distance(i, j), products.squared_distance_error(i, j), size);
      metric.distance(i, j) = metric.distance(j, i) = value;
      metric.distance_error(i, j) = metric.distance_error(j, i) = error;
    }
  }
  return metric;
}

std::vector<double> channel_weights(const std::vector<double>& given, std::size_t channels) {
  if (given.empty()) return std::vector<double>(channels, 1.0 / static_cast<double>(channels));
  if (given.size() != channels) {
    throw ArgumentError(std::to_string(given.size()) + " channel weights for " + std::to_string(channels) +
                        " channels; expected one per channel");
  }
  for (const double weight : given) {
    if (!(weight >= 0) || !std::isfinite(weight))
      throw ArgumentError("a channel weight is negative or no finite number");
  }
  return given;
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

}  // namespace lobe
