#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "device/shade_sphere.hpp"
#include "hemisphere/gauss.hpp"

namespace lobe {

/// The least cosine of a visible point, as in kernels/lobes/shade_sphere.cl.
inline constexpr double kLeastCosine = 1e-9;

/// The picture of a sphere of radius 1 that touches its edges, in parts on which the outline has no kink.
struct SphereParts {
  double pixel = 0;  ///< length of its edges
  std::vector<SpherePart> parts;
  std::vector<Eigen::Index> pixel_of;  ///< number of a part's pixel, from the upper left on in rows
  Eigen::VectorXd coverage;            ///< of each pixel, exactly
};
[[nodiscard]] SphereParts sphere_parts(std::size_t size);

/// A point of a sphere, and axes of its surface there: along the parallel, along the meridian, the normal.
class SpherePoint {
 public:
  /// \param reach sqrt(1 - y^2)
  /// \param x within [-reach, reach]
  SpherePoint(double x, double y, double reach);

  [[nodiscard]] double x() const { return normal_[0]; }
  [[nodiscard]] double y() const { return normal_[1]; }
  [[nodiscard]] double depth() const { return normal_[2]; }
  /// A direction by its components along these axes.
  [[nodiscard]] std::array<double, 3> local(const std::array<double, 3>& direction) const;
  /// Direction towards the viewer.
  [[nodiscard]] std::array<double, 3> view() const { return local({0, 0, 1}); }

 private:
  std::array<double, 3> normal_;
  double reach_;
};

/// Calls visit(point, share) at the nodes of a part; the shares add up to the part's area.
void for_each_node(const SpherePart& part, const GaussRule& rule,
                   const std::function<void(const SpherePoint& point, double share)>& visit);

/// Integrals over parts, rows x parts.
struct PartIntegrals {
  Eigen::MatrixXd value;
  Eigen::MatrixXd error;
};
using PartIntegrator = std::function<Eigen::MatrixXd(std::span<const std::size_t> parts, const GaussRule& rule)>;

struct PartTolerance {
  double absolute = 0;  ///< of an integral
  double relative = 0;
};

/// Integrates every part by Gauss rules of an order along both coordinates that is doubled until the error is tolerable
/// or an order reached; the error is twice the last change, or half of the change before.
/// \param orders that parts begin with
/// \param highest order; a part that begins with more than half of it is integrated by twice its own
[[nodiscard]] PartIntegrals integrate_parts(std::span<const int> orders, int highest, Eigen::Index rows,
                                            const PartTolerance& tolerance, const PartIntegrator& integrate);

}  // namespace lobe
