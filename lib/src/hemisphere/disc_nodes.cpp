#include "hemisphere/disc_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "hemisphere/gauss.hpp"

namespace lobe {

/// Polynomials of order m begin at r = m / degree, and fall below it at least as fast as Bessel functions J_m(degree r)
/// do, |J_m(x)| <= exp(sqrt(m^2 - x^2) - m arcosh(m / x)) (DLMF 10.14.5).
int orders_at(int degree, double radius) {
  constexpr double kExponent = 34;  // e^-34 is rounding, also times the norm of a polynomial
  const double x = degree * radius;
  int order = static_cast<int>(std::ceil(x));
  for (; order <= degree; ++order) {
    const double root = std::sqrt((order - x) * (order + x));
    if (x <= 0 ? order > 0 : order * std::log((order + root) / x) - root > kExponent) break;
  }
  return std::min(std::max(order, 2), degree + 1);
}

DiscNodes::DiscNodes(int degree) : firsts_{0} {
  const GaussRule gauss = gauss_rule(degree / 2 + 1);
  const auto count = static_cast<Eigen::Index>(gauss.nodes.size());
  squares_.resize(count);
  weights_.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto place = static_cast<std::size_t>(count - 1 - k);
    const double x = gauss.nodes[place];
    squares_(k) = x;
    // Wang, Huybrechs, Vandewalle 2014, of Gauss-Legendre nodes.
    weights_(k) = (k % 2 == 0 ? 1 : -1) * std::sqrt(x * (1 - x) * gauss.weights[place]);
  }
  radii_ = squares_.sqrt();
  std::vector<int> counts(static_cast<std::size_t>(degree) + 1, 0);
  for (const double radius : radii_) {
    const int orders = orders_at(degree, radius);
    for (int order = 0; order < orders; ++order) ++counts[static_cast<std::size_t>(order)];
  }
  for (const int nodes : counts) firsts_.push_back(firsts_.back() + nodes);
}

Eigen::MatrixXd DiscNodes::interpolation(const Eigen::ArrayXd& distances, bool odd) const {
  Eigen::MatrixXd values(distances.size(), radii_.size());
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    const Eigen::ArrayXd off = distances(i) * distances(i) - squares_;
    Eigen::Index nearest = 0;
    if (off.abs().minCoeff(&nearest) == 0) {
      values.row(i) = Eigen::VectorXd::Unit(radii_.size(), nearest).transpose();
      continue;
    }
    const Eigen::ArrayXd shares = weights_ / off;
    values.row(i) = (shares / shares.sum()).matrix().transpose();
    if (odd) values.row(i).array() *= (distances(i) / radii_).transpose();
  }
  return values;
}

}  // namespace lobe
