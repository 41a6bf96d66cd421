#include "hemisphere/embedded_rule.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

/// Weights at nodes in (0, 1) from the moments of x dx: their shifted Legendre polynomials must sum to 1/2, 1/6, 0, ...
Eigen::VectorXd interpolatory_weights(const std::vector<double>& nodes) {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd legendre(count, count);
  Eigen::VectorXd moments = Eigen::VectorXd::Zero(count);
  moments(0) = 0.5;
  if (count > 1) moments(1) = 1.0 / 6;
  for (Eigen::Index j = 0; j < count; ++j) {
    const double x = 2 * nodes[static_cast<std::size_t>(j)] - 1;
    double previous = 0;
    double current = 1;
    for (Eigen::Index k = 0; k < count; ++k) {
      legendre(k, j) = current;
      const auto n = static_cast<double>(k);
      const double next = ((2 * n + 1) * x * current - n * previous) / (n + 1);
      previous = current;
      current = next;
    }
  }
  return legendre.partialPivLu().solve(moments);
}

/// Weights of rings first, first + stride, ... of a gauss grid.
std::vector<double> strided_weights(const HemisphereGrid& grid, std::size_t first, std::size_t stride) {
  const auto rings = grid.rings();
  std::vector<double> weights(rings.size());
  std::vector<double> cosines;
  for (std::size_t r = first; r < rings.size(); r += stride) cosines.push_back(std::cos(rings[r].theta));
  const Eigen::VectorXd kept = interpolatory_weights(cosines);
  for (std::size_t k = 0; k < cosines.size(); ++k) weights[first + stride * k] = kept(static_cast<Eigen::Index>(k));
  return weights;
}

}  // namespace

std::vector<double> thinned_ring_weights(const HemisphereGrid& grid, std::size_t first, std::size_t stride) {
  if (grid.kind() == GridKind::gauss) return strided_weights(grid, first, stride);
  const auto rings = grid.rings();
  std::vector<double> weights(rings.size());
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const std::size_t kept = std::min(r / stride * stride + first, rings.size() - 1);
    weights[kept] += rings[r].weight * static_cast<double>(rings[r].count) / (2 * std::numbers::pi);
  }
  return weights;
}

std::vector<double> embedded_ring_weights(const HemisphereGrid& grid) {
  const auto rings = grid.rings();
  std::vector<double> weights(rings.size());
  const auto own = [&](std::size_t r) {
    return rings[r].weight * static_cast<double>(rings[r].count) / (2 * std::numbers::pi);
  };
  if (grid.kind() != GridKind::gauss) {
    for (std::size_t r = 0; r < rings.size(); ++r) weights[std::min(r | 1U, rings.size() - 1)] += own(r);
    return weights;
  }
  if (rings.size() < 2) return {own(0)};
  return embedded_ring_weights(grid, 2);
}

std::vector<double> embedded_ring_weights(const HemisphereGrid& grid, std::size_t stride) {
  return strided_weights(grid, stride - 1, stride);
}

std::vector<double> other_ring_weights(const HemisphereGrid& grid) {
  const auto rings = grid.rings();
  if (grid.kind() == GridKind::gauss) {
    return rings.size() < 4 ? embedded_ring_weights(grid) : strided_weights(grid, 0, 2);
  }
  std::vector<double> weights(rings.size());
  for (std::size_t r = 0; r < rings.size(); ++r) {
    weights[r & ~std::size_t{1}] += rings[r].weight * static_cast<double>(rings[r].count) / (2 * std::numbers::pi);
  }
  return weights;
}

}  // namespace lobe
