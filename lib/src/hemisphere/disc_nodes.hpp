#pragma once

#include <Eigen/Core>
#include <vector>

namespace lobe {

/// How many azimuthal orders m = 0, 1, .. the polynomials of the unit disc up to a degree (DiscPolynomials) have at a
/// distance from its centre: higher ones have not begun there and are zero to rounding. The first two always count.
[[nodiscard]] int orders_at(int degree, double radius);

/// Distances from the centre at which polynomials of the unit disc are known completely: the radial parts of an order m
/// up to a degree D are polynomials of r^2 (times r, for odd m) of degree D/2 at most, which D/2 + 1 values determine.
class DiscNodes {
 public:
  /// \param degree the largest, >= 0
  explicit DiscNodes(int degree);

  /// Falling, in (0, 1).
  [[nodiscard]] const Eigen::ArrayXd& radii() const { return radii_; }
  /// Nodes at which an order is not zero: the first ones.
  [[nodiscard]] int count(int order) const {
    return firsts_[static_cast<std::size_t>(order) + 1] - firsts_[static_cast<std::size_t>(order)];
  }
  /// Place of an order's first node where those of all orders lie one after the other.
  [[nodiscard]] int first(int order) const { return firsts_[static_cast<std::size_t>(order)]; }
  /// Number of nodes of all orders.
  [[nodiscard]] int size() const { return firsts_.back(); }

  /// Matrix that takes values of radial parts at the nodes to those at other distances, distances x nodes.
  /// \param odd for odd orders, else for even ones
  [[nodiscard]] Eigen::MatrixXd interpolation(const Eigen::ArrayXd& distances, bool odd) const;

 private:
  Eigen::ArrayXd radii_;
  Eigen::ArrayXd squares_;
  Eigen::ArrayXd weights_;  ///< barycentric, in r^2
  std::vector<int> firsts_;
};

}  // namespace lobe
