#pragma once

#include <Eigen/Core>
#include <vector>

namespace lobe {

/// The polynomials of the unit disc that are orthonormal in its area and even in the azimuth (Zernike 1934):
///   phi_mk(r, psi) = R_mk(r) cos(m psi),  R_mk = sqrt(2 (m + 2k + 1) / (pi (1 + [m = 0]))) r^m P_k^(0,m)(2 r^2 - 1),
/// up to a total degree m + 2k.
class DiscPolynomials {
 public:
  /// \param degree the largest, >= 0
  explicit DiscPolynomials(int degree);

  [[nodiscard]] int degree() const { return degree_; }
  /// Azimuthal orders m are 0 .. orders() - 1.
  [[nodiscard]] int orders() const { return degree_ + 1; }
  /// Polynomials of one order: k = 0 .. count(order) - 1.
  [[nodiscard]] int count(int order) const { return (degree_ - order) / 2 + 1; }
  /// Place of R_m0 where all orders lie one after the other.
  [[nodiscard]] int first(int order) const { return firsts_[static_cast<std::size_t>(order)]; }
  /// Number of polynomials of all orders.
  [[nodiscard]] int size() const { return firsts_.back(); }

  /// R_mk(r), radii x count(order).
  /// \param powers r^order
  [[nodiscard]] Eigen::MatrixXd radial(int order, const Eigen::ArrayXd& radii, const Eigen::ArrayXd& powers) const;

 private:
  int degree_;
  std::vector<int> firsts_;
};

/// The factor of R_mk.
[[nodiscard]] double disc_polynomial_factor(int order, int k);

}  // namespace lobe
