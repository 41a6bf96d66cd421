#include "hemisphere/disc_polynomials.hpp"

#include <cmath>
#include <numbers>

namespace lobe {

DiscPolynomials::DiscPolynomials(int degree) : degree_(degree), firsts_{0} {
  for (int order = 0; order <= degree; ++order) firsts_.push_back(firsts_.back() + count(order));
}

double disc_polynomial_factor(int order, int k) {
  return std::sqrt(2 * (order + 2 * k + 1) / (std::numbers::pi * (order == 0 ? 2 : 1)));
}

Eigen::MatrixXd DiscPolynomials::radial(int order, const Eigen::ArrayXd& radii, const Eigen::ArrayXd& powers) const {
  Eigen::ArrayXXd values(radii.size(), count(order));
  const Eigen::ArrayXd x = 2 * radii.square() - 1;
  const double m = order;
  // Jacobi polynomials by their three-term recurrence (DLMF 18.9.1), alpha = 0, beta = m.
  values.col(0) = powers;
  if (values.cols() > 1) values.col(1) = powers * (1 + (m + 2) / 2 * (x - 1));
  for (int k = 2; k < values.cols(); ++k) {
    const double a = 2 * k * (k + m) * (2 * k + m - 2);
    const double slope = (2 * k + m - 1) * (2 * k + m) * (2 * k + m - 2) / a;
    const double shift = -(2 * k + m - 1) * m * m / a;
    const double earlier = 2 * (k - 1) * (k + m - 1) * (2 * k + m) / a;
    values.col(k) = (slope * x + shift) * values.col(k - 1) - earlier * values.col(k - 2);
  }
  for (int k = 0; k < values.cols(); ++k) values.col(k) *= disc_polynomial_factor(order, k);
  return values.matrix();
}

}  // namespace lobe
