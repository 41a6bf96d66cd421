#include "render/mesh_form.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

namespace lobe {
namespace {

using Eigen::Vector3d;

struct Bounds {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = Vector3d::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vector3d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  /// Whether a ray is within the box somewhere before `most`.
  [[nodiscard]] bool is_met(const Vector3d& origin, const Vector3d& inverse, double most) const {
    double from = 0;
    double to = most;
    for (Eigen::Index k = 0; k < 3; ++k) {
      double near = (low[k] - origin[k]) * inverse[k];
      double far = (high[k] - origin[k]) * inverse[k];
      if (near > far) std::swap(near, far);
      // No number where the ray runs within a side: it then counts as met.
      if (near > from) from = near;
      if (far < to) to = far;
    }
    constexpr double kRounding = 1e-12;
    return from <= to * (1 + kRounding);
  }
};

/// A triangle by a corner and its edges from there.
struct Triangle {
  Vector3d corner, first, second;
  std::size_t index;
};

class MeshTree {
 public:
  explicit MeshTree(const MeshShape& mesh) : mesh_(mesh) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto at = [&](std::size_t k) {
        const SpaceVector& v = mesh_.vertices[mesh_.triangles[t][k]];
        return Vector3d(v[0], v[1], v[2]);
      };
      triangles_.push_back({at(0), at(1) - at(0), at(2) - at(0), t});
    }
    nodes_.reserve(2 * triangles_.size());
    build(0, triangles_.size());
  }

  bool operator()(const Ray& ray, double least, SurfaceHit& hit) const {
    const Vector3d inverse = ray.direction.cwiseInverse();
    const Triangle* found = nullptr;
    double u = 0;
    double v = 0;
    std::array<std::size_t, kDeepest> waiting{};
    std::size_t count = 1;
    while (count > 0) {
      const std::size_t at = waiting[--count];
      const Node& node = nodes_[at];
      if (!node.bounds.is_met(ray.origin, inverse, hit.distance)) continue;
      if (node.count == 0) {
        waiting[count++] = at + 1;
        waiting[count++] = node.begin;
        continue;
      }
      for (std::size_t k = node.begin; k < node.begin + node.count; ++k) {
        if (meet_triangle(triangles_[k], ray, least, hit.distance, u, v)) found = &triangles_[k];
      }
    }
    if (found == nullptr) return false;
    hit.normal = found->first.cross(found->second).normalized();
    hit.shading = hit.normal;
    if (!mesh_.triangle_normals.empty()) {
      const auto& corners = mesh_.triangle_normals[found->index];
      const auto at = [&](std::size_t k) {
        const SpaceVector& n = mesh_.normals[corners[k]];
        return Vector3d(n[0], n[1], n[2]).normalized();
      };
      const Vector3d mean = (1 - u - v) * at(0) + u * at(1) + v * at(2);
      if (mean.norm() > 0.1) hit.shading = mean.normalized();
      if (hit.shading.dot(hit.normal) < 0) hit.normal = -hit.normal;
    }
    return true;
  }

 private:
  static constexpr std::size_t kDeepest = 128;
  static constexpr std::size_t kInLeaf = 4;

  /// A box: a leaf with triangles, or two boxes, one behind it and one at `begin`.
  struct Node {
    Bounds bounds;
    std::size_t begin = 0;
    std::size_t count = 0;
  };

  /// Möller and Trumbore 1997. Sets the distance and the coordinates where the triangle is nearer.
  static bool meet_triangle(const Triangle& triangle, const Ray& ray, double least, double& distance, double& u,
                            double& v) {
    const Vector3d across = ray.direction.cross(triangle.second);
    const double determinant = triangle.first.dot(across);
    if (determinant == 0) return false;
    const Vector3d from = ray.origin - triangle.corner;
    const double along_first = from.dot(across) / determinant;
    if (!(along_first >= 0 && along_first <= 1)) return false;
    const Vector3d turned = from.cross(triangle.first);
    const double along_second = ray.direction.dot(turned) / determinant;
    if (!(along_second >= 0 && along_first + along_second <= 1)) return false;
    const double found = triangle.second.dot(turned) / determinant;
    if (!(found > least && found < distance)) return false;
    distance = found;
    u = along_first;
    v = along_second;
    return true;
  }

  void build(std::size_t begin, std::size_t end) {
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    Bounds bounds;
    Bounds centres;
    for (std::size_t k = begin; k < end; ++k) {
      const Triangle& t = triangles_[k];
      for (const Vector3d& point : {t.corner, Vector3d(t.corner + t.first), Vector3d(t.corner + t.second)}) {
        bounds.add(point);
      }
      centres.add(centre_of(t));
    }
    nodes_[at].bounds = bounds;
    if (end - begin <= kInLeaf) {
      nodes_[at].begin = begin;
      nodes_[at].count = end - begin;
      return;
    }
    Eigen::Index axis = 0;
    (centres.high - centres.low).maxCoeff(&axis);
    const std::size_t middle = std::midpoint(begin, end);
    const auto place = [&](std::size_t k) { return triangles_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(place(begin), place(middle), place(end),
                     [axis](const Triangle& a, const Triangle& b) { return centre_of(a)[axis] < centre_of(b)[axis]; });
    build(begin, middle);
    nodes_[at].begin = nodes_.size();
    build(middle, end);
  }

  static Vector3d centre_of(const Triangle& t) { return t.corner + (t.first + t.second) / 3; }

  MeshShape mesh_;
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace

Form mesh_form(const MeshShape& mesh) {
  return [tree = std::make_shared<const MeshTree>(mesh)](const Ray& ray, double least, SurfaceHit& hit) {
    return (*tree)(ray, least, hit);
  };
}

}  // namespace lobe
