#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lobe/render/scene.hpp"

namespace lobe {

/// A half-line; its direction has length 1.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double reach = 0;  ///< largest coordinate on the way to the origin, whose rounding the origin has

  [[nodiscard]] Eigen::Vector3d at(double distance) const { return origin + distance * direction; }
};

/// Where a ray meets a surface.
struct SurfaceHit {
  double distance = 0;
  std::size_t shape = 0;
  Eigen::Vector3d normal;   ///< of the surface, of length 1, on either side
  Eigen::Vector3d shading;  ///< that shading is to use: of a mesh the interpolated one
};

/// A form that rays may meet: replaces `hit` where a ray meets it at a distance above `least` and below that of `hit`,
/// and says whether it did.
using Form = std::function<bool(const Ray& ray, double least, SurfaceHit& hit)>;

/// Forms of a scene.
class SceneGeometry {
 public:
  /// \param shapes valid
  explicit SceneGeometry(std::span<const SceneShape> shapes);

  /// The nearest surface that a ray meets, not the one that it begins on.
  [[nodiscard]] std::optional<SurfaceHit> nearest(const Ray& ray) const;
  /// Whether a surface is nearer than a distance.
  [[nodiscard]] bool is_blocked(const Ray& ray, double distance) const;

 private:
  std::vector<Form> forms_;
};

/// Axes of a surface in space; z is the normal.
struct SurfaceFrame {
  Eigen::Vector3d x, y, z;

  [[nodiscard]] Eigen::Vector3d local(const Eigen::Vector3d& v) const { return {x.dot(v), y.dot(v), z.dot(v)}; }
  [[nodiscard]] Eigen::Vector3d global(const Eigen::Vector3d& v) const { return v[0] * x + v[1] * y + v[2] * z; }
};

/// The frame of a normal of length 1: x along (0, 0, 1) x normal, of a vertical normal along the x axis of the scene.
[[nodiscard]] SurfaceFrame frame_of(const Eigen::Vector3d& normal);

/// \throws ArgumentError for a scene that makes no sense
void require_valid(const Scene& scene);

}  // namespace lobe
