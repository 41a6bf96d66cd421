#include "render/scene_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "render/mesh_form.hpp"

namespace lobe {
namespace {

using Eigen::Vector3d;

Vector3d in_space(const SpaceVector& v) {
  return {v[0], v[1], v[2]};
}

/// Takes over a hit whose distance is nearer.
bool take(SurfaceHit& hit, double least, double distance, const Vector3d& normal) {
  if (!(distance > least && distance < hit.distance)) return false;
  hit.distance = distance;
  hit.normal = normal;
  hit.shading = normal;
  return true;
}

/// Both roots of t^2 - 2 half t + product = 0, the smaller one first, without cancellation; none: NaN.
std::array<double, 2> roots(double half, double product) {
  const double square = half * half - product;
  if (!(square >= 0)) return {std::nan(""), std::nan("")};
  const double larger = half + std::copysign(std::sqrt(square), half);
  const double other = larger == 0 ? 0 : product / larger;
  return {std::min(larger, other), std::max(larger, other)};
}

class SphereForm {
 public:
  explicit SphereForm(const SphereShape& sphere) : centre_(in_space(sphere.centre)), radius_(sphere.radius) {}

  bool operator()(const Ray& ray, double least, SurfaceHit& hit) const {
    const Vector3d to_centre = centre_ - ray.origin;
    const double half = to_centre.dot(ray.direction);
    // The distance of the centre from the line, not the difference of squares that cancels for far spheres.
    const double aside = (to_centre - half * ray.direction).norm();
    if (aside > radius_) return false;
    const double chord = std::sqrt((radius_ - aside) * (radius_ + aside));
    const double larger = half + std::copysign(chord, half);
    const double length = to_centre.norm();
    const double other = larger == 0 ? 0 : (length - radius_) * (length + radius_) / larger;
    for (const double distance : {std::min(larger, other), std::max(larger, other)}) {
      if (take(hit, least, distance, (ray.at(distance) - centre_).normalized())) return true;
    }
    return false;
  }

 private:
  Vector3d centre_;
  double radius_;
};

class BoxForm {
 public:
  explicit BoxForm(const BoxShape& box) : centre_(in_space(box.centre)), half_(in_space(box.size) / 2) {
    turn_ = Eigen::AngleAxisd(box.turn, Vector3d::UnitZ()).toRotationMatrix();
  }

  bool operator()(const Ray& ray, double least, SurfaceHit& hit) const {
    const Vector3d origin = turn_.transpose() * (ray.origin - centre_);
    const Vector3d direction = turn_.transpose() * ray.direction;
    std::array<double, 2> span{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    std::array<Eigen::Index, 2> axes{0, 0};
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (direction[k] == 0) {
        if (std::abs(origin[k]) > half_[k]) return false;
        continue;
      }
      const double side = std::copysign(half_[k], direction[k]);
      const double enters = (-side - origin[k]) / direction[k];
      const double leaves = (side - origin[k]) / direction[k];
      if (enters > span[0]) {
        span[0] = enters;
        axes[0] = k;
      }
      if (leaves < span[1]) {
        span[1] = leaves;
        axes[1] = k;
      }
    }
    if (span[0] > span[1]) return false;
    for (std::size_t end = 0; end < 2; ++end) {
      if (take(hit, least, span[end], turn_.col(axes[end]))) return true;
    }
    return false;
  }

 private:
  Vector3d centre_;
  Vector3d half_;
  Eigen::Matrix3d turn_;
};

class CylinderForm {
 public:
  explicit CylinderForm(const CylinderShape& cylinder)
      : base_(in_space(cylinder.base)),
        axis_(in_space(cylinder.axis).normalized()),
        height_(in_space(cylinder.axis).norm()),
        radius_(cylinder.radius) {}

  bool operator()(const Ray& ray, double least, SurfaceHit& hit) const {
    const Vector3d from = ray.origin - base_;
    const double up = from.dot(axis_);
    const double rise = ray.direction.dot(axis_);
    const Vector3d across = from - up * axis_;
    const Vector3d drift = ray.direction - rise * axis_;
    bool is_met = false;
    if (const double square = drift.squaredNorm(); square > 0) {
      const double half = -across.dot(drift) / square;
      const double length = across.norm();
      for (const double distance : roots(half, (length - radius_) * (length + radius_) / square)) {
        const double height = up + distance * rise;
        if (!(height >= 0 && height <= height_)) continue;
        is_met = take(hit, least, distance, (across + distance * drift).normalized()) || is_met;
      }
    }
    if (rise != 0) {
      for (const double height : {0.0, height_}) {
        const double distance = (height - up) / rise;
        if ((across + distance * drift).norm() <= radius_) is_met = take(hit, least, distance, axis_) || is_met;
      }
    }
    return is_met;
  }

 private:
  Vector3d base_;
  Vector3d axis_;
  double height_;
  double radius_;
};

class PlaneForm {
 public:
  explicit PlaneForm(const PlaneShape& plane)
      : centre_(in_space(plane.centre)), frame_(frame_of(in_space(plane.normal).normalized())), size_(plane.size) {}

  bool operator()(const Ray& ray, double least, SurfaceHit& hit) const {
    const double fall = ray.direction.dot(frame_.z);
    if (fall == 0) return false;
    const double distance = (centre_ - ray.origin).dot(frame_.z) / fall;
    if (size_) {
      const Vector3d at = ray.at(distance) - centre_;
      if (!(std::abs(at.dot(frame_.x)) <= (*size_)[0] / 2 && std::abs(at.dot(frame_.y)) <= (*size_)[1] / 2)) {
        return false;
      }
    }
    return take(hit, least, distance, frame_.z);
  }

 private:
  Vector3d centre_;
  SurfaceFrame frame_;
  std::optional<std::array<double, 2>> size_;
};

Form form_of(const SceneShape& shape) {
  struct Maker {
    Form operator()(const SphereShape& s) const { return SphereForm(s); }
    Form operator()(const BoxShape& s) const { return BoxForm(s); }
    Form operator()(const CylinderShape& s) const { return CylinderForm(s); }
    Form operator()(const PlaneShape& s) const { return PlaneForm(s); }
    Form operator()(const MeshShape& s) const { return mesh_form(s); }
  };
  return std::visit(Maker{}, shape.geometry);
}

/// Distance from the origin of a ray within which it meets nothing: its origin lies on a surface, to rounding. It is
/// relative, so that lengths may have any unit.
double least_distance(const Ray& ray) {
  constexpr double kLeast = 1e-9;
  return kLeast * std::max(ray.reach, ray.origin.cwiseAbs().maxCoeff());
}

// What scenes may be.

void require(bool is_valid, const std::string& complaint) {
  if (!is_valid) throw ArgumentError(complaint);
}

template <std::size_t N>
bool all_finite(const std::array<double, N>& numbers) {
  return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

bool is_direction(const SpaceVector& v) {
  const double length = in_space(v).norm();
  return std::isfinite(length) && length > 0;
}

bool is_length(double x) {
  return std::isfinite(x) && x > 0;
}

bool is_light(const LinearColour& colour) {
  return std::ranges::all_of(colour, [](double x) { return std::isfinite(x) && x >= 0; });
}

/// Checks of each form; `what` names the shape.
struct FormCheck {
  std::string what;

  void operator()(const SphereShape& s) const {
    require(all_finite(s.centre) && is_length(s.radius), what + " has no centre or radius; expected a radius above 0");
  }
  void operator()(const BoxShape& s) const {
    require(all_finite(s.centre) && std::ranges::all_of(s.size, is_length) && std::isfinite(s.turn),
            what + " has no centre or size; expected three lengths above 0");
  }
  void operator()(const CylinderShape& s) const {
    require(all_finite(s.base) && is_direction(s.axis) && is_length(s.radius),
            what + " has no base, axis or radius; expected an axis and a radius of some length");
  }
  void operator()(const PlaneShape& s) const {
    require(all_finite(s.centre) && is_direction(s.normal) && (!s.size || std::ranges::all_of(*s.size, is_length)),
            what + " has no point, normal or size; expected a normal of some length, and lengths above 0");
  }
  void operator()(const MeshShape& s) const {
    require(!s.triangles.empty(), what + " has no triangles; expected at least one");
    require(std::ranges::all_of(s.vertices, all_finite<3>) && std::ranges::all_of(s.normals, is_direction),
            what + " has vertices that are not finite, or normals without length");
    const auto within = [](const auto& list, std::size_t count) {
      return std::ranges::all_of(
          list, [&](const auto& corners) { return std::ranges::all_of(corners, [&](auto k) { return k < count; }); });
    };
    require(within(s.triangles, s.vertices.size()) && within(s.triangle_normals, s.normals.size()),
            what + " has triangles of vertices or normals that it lacks");
    require(s.triangle_normals.empty() || s.triangle_normals.size() == s.triangles.size(),
            what + " has normals for some triangles only; expected them for all or for none");
  }
};

void require_valid_camera(const SceneCamera& camera) {
  constexpr std::size_t kLargestEdge = 8192;
  const Vector3d view = in_space(camera.target) - in_space(camera.position);
  require(all_finite(camera.position) && std::isfinite(view.norm()) && view.norm() > 0,
          "the camera stands where it looks at; expected two different points");
  require(is_direction(camera.up) && in_space(camera.up).normalized().cross(view.normalized()).norm() > 1e-6,
          "the camera's up is no direction across its view");
  require(camera.field_of_view > 0 && camera.field_of_view < 180 * kDegree,
          fmt::format("the camera's field of view is {} degrees; expected one between 0 and 180",
                      shortest(to_degrees(camera.field_of_view))));
  for (const std::size_t edge : camera.size) {
    require(edge >= 1 && edge <= kLargestEdge,
            fmt::format("the camera's picture has an edge of {} pixels; expected 1 to {}", edge, kLargestEdge));
  }
}

}  // namespace

SurfaceFrame frame_of(const Vector3d& normal) {
  const Vector3d level = Vector3d::UnitZ().cross(normal);
  const double length = level.norm();
  constexpr double kVertical = 1e-9;
  const Vector3d x =
      length > kVertical ? Vector3d(level / length) : Vector3d((Vector3d::UnitX() - normal[0] * normal).normalized());
  return {x, normal.cross(x), normal};
}

SceneGeometry::SceneGeometry(std::span<const SceneShape> shapes) {
  for (const SceneShape& shape : shapes) forms_.push_back(form_of(shape));
}

std::optional<SurfaceHit> SceneGeometry::nearest(const Ray& ray) const {
  SurfaceHit hit;
  hit.distance = std::numeric_limits<double>::infinity();
  const double least = least_distance(ray);
  bool is_met = false;
  for (std::size_t k = 0; k < forms_.size(); ++k) {
    if (!forms_[k](ray, least, hit)) continue;
    hit.shape = k;
    is_met = true;
  }
  if (!is_met) return std::nullopt;
  return hit;
}

bool SceneGeometry::is_blocked(const Ray& ray, double distance) const {
  const double least = least_distance(ray);
  SurfaceHit hit;
  hit.distance = distance - least;
  return std::ranges::any_of(forms_, [&](const auto& form) { return form(ray, least, hit); });
}

void require_valid(const Scene& scene) {
  require_valid_camera(scene.camera);
  for (std::size_t k = 0; k < scene.shapes.size(); ++k) {
    const std::string what = fmt::format("shape {} of the scene", k + 1);
    std::visit(FormCheck{what}, scene.shapes[k].geometry);
    require(scene.shapes[k].material < scene.materials.size(), what + " has a material that the scene lacks");
  }
  for (const SceneLight& light : scene.lights) {
    require(all_finite(light.position) && is_light(light.intensity),
            "a light of the scene has no position or intensity; expected finite numbers, intensities of at least 0");
  }
  require(is_light(scene.sky.radiance), "the sky of the scene has no radiance; expected finite numbers of at least 0");
  require(scene.bounces <= kMostBounces,
          fmt::format("a scene of {} bounces; expected at most {}", scene.bounces, kMostBounces));
}

}  // namespace lobe
