#include "formats/pair_coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hemisphere/unit_vector.hpp"

namespace lobe {
namespace {

double square(double x) {
  return x * x;
}

double stretched(double sine, double knee) {
  return std::asinh(sine / knee) / std::asinh(1 / knee);
}

/// Angles of half-vector and difference vector, to full relative accuracy near 0.
struct Sines {
  double half;
  double difference;
  double along;  ///< |component of the difference vector in the plane of normal and half-vector|
};

Sines sines_of(double theta_1, double theta_2, double delta_phi) {
  const double s1 = std::sin(theta_1);
  const double s2 = std::sin(theta_2);
  const double difference_of_cosines =
      2 * std::sin((theta_1 + theta_2) / 2) * std::sin((theta_2 - theta_1) / 2);  // cos 1 - cos 2
  const double tangential = square(s1 - s2) + 4 * s1 * s2 * square(std::cos(delta_phi / 2));
  const double difference =
      square(s1 - s2) + square(difference_of_cosines) + 4 * s1 * s2 * square(std::sin(delta_phi / 2));
  const double sine_d = std::min(1.0, std::sqrt(difference) / 2);
  const double sum = std::sqrt(tangential + square(std::cos(theta_1) + std::cos(theta_2)));
  const double sine_h = sum > 0 ? std::min(1.0, std::sqrt(tangential) / sum) : 0;
  // The half-vector is normal to the difference vector, whose component along the normal is thus sin(theta_h) times it.
  const double along = sine_h > 0 ? std::abs(difference_of_cosines) / (2 * sine_h) : 0;
  return {sine_h, sine_d, std::min(along, sine_d)};
}

}  // namespace

Eigen::MatrixXd PairCoordinates::of(std::span<const Directions> pairs) const {
  Eigen::MatrixXd points(dimensions(), static_cast<Eigen::Index>(pairs.size()));
  Eigen::Index i = 0;
  for (const Directions& pair : pairs) {
    // One order of L and V, so that both give the same bits.
    const auto [theta_1, theta_2] = std::minmax(pair.theta_in, pair.theta_out);
    const Sines sines = sines_of(theta_1, theta_2, pair.delta_phi);
    const double half = stretched(sines.half, half_knee);
    const double difference = stretched(sines.difference, difference_knee);
    if (is_isotropic) {
      const double cosine = sines.difference > 0 ? sines.along / sines.difference : 0;
      const double weight = half + difference > 0 ? 2 * half * difference / (half + difference) : 0;
      points.col(i) << half_scale * half, difference, azimuth_scale * weight * (2 * cosine * cosine - 1);
    } else {
      const Eigen::Vector3d l = unit_vector(pair.theta_in, pair.phi_in);
      const Eigen::Vector3d v = unit_vector(pair.theta_out, pair.phi_in + pair.delta_phi);
      const Eigen::Vector3d h = (l + v).normalized();
      const Eigen::Vector3d d = l - v;
      // h is turned to the normal the shortest way; what is left of d lies in the base plane.
      const double along = (d.x() * h.x() + d.y() * h.y()) / (1 + h.z()) + d.z();
      const double x = d.x() - h.x() * along;
      const double y = d.y() - h.y() * along;
      const double length = x * x + y * y;
      const double sine = std::hypot(h.x(), h.y());
      const double radius = sine > 0 ? half_scale * half / sine : 0;
      const double turn = length > 0 ? difference / length : 0;
      points.col(i) << radius * h.x(), radius * h.y(), turn * (x * x - y * y), turn * 2 * x * y;
    }
    ++i;
  }
  return points;
}

}  // namespace lobe
