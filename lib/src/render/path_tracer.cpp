#include "render/path_tracer.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/parallel.hpp"
#include "device/rounding.hpp"

namespace lobe {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kPathsAtOnce = 32768;
constexpr double kReflectionRounding = 4;  // epsilons of the precision
constexpr double kDirectionRounding = 1;   // epsilons over the width of the narrowest lobe
constexpr double kLeastViewCosine = 1e-6;  // a viewer who grazes a surface more than that is raised to it

Vector3d vector_from(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// A number in [0, 1) by its index alone. Source: Steele, Lea and Flood 2014, Fast splittable pseudorandom number
/// generators, the finaliser of SplitMix64, twice.
double unit_number(std::uint64_t seed, std::uint64_t index) {
  const auto mixed = [](std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  };
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;
  const std::uint64_t bits = mixed(mixed(seed + kGolden) ^ (index * kGolden + kGolden));
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

Vector3d radiance_of(const SceneSky& sky, const Vector3d& direction) {
  Vector3d zenith = vector_from(sky.radiance);
  if (sky.kind == SkyKind::uniform) return zenith;
  return direction[2] > 0 ? Vector3d(zenith * (1 + 2 * direction[2]) / 3) : Vector3d(Vector3d::Zero());
}

/// The image of a direction on the other side of a surface.
Vector3d mirrored(const Vector3d& direction, const Vector3d& normal) {
  return direction - 2 * normal.dot(direction) * normal;
}

}  // namespace

void for_many(std::size_t count, const std::function<void(std::size_t)>& work) {
  constexpr std::size_t kPiece = 256;
  parallel_for_pieces(count, kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

CameraRays::CameraRays(const SceneCamera& camera) : size_(camera.size), origin_(vector_from(camera.position)) {
  forward_ = (vector_from(camera.target) - origin_).normalized();
  const double height = std::tan(camera.field_of_view / 2);
  const double aspect = static_cast<double>(size_[0]) / static_cast<double>(size_[1]);
  const Eigen::Vector3d right = forward_.cross(vector_from(camera.up)).normalized();
  right_ = height * aspect * right;
  up_ = height * right.cross(forward_);
}

Ray CameraRays::through(std::size_t pixel, double x, double y) const {
  const double across = 2 * (static_cast<double>(pixel % size_[0]) + x) / static_cast<double>(size_[0]) - 1;
  const std::size_t row = pixel / size_[0];
  const double down = 2 * (static_cast<double>(row) + y) / static_cast<double>(size_[1]) - 1;
  return {origin_, (forward_ + across * right_ - down * up_).normalized()};
}

/// A path on its way, from the camera.
struct PathTracer::Path {
  Ray ray;
  Vector3d weight = Vector3d::Ones();  ///< of what it is still to see
  Vector3d radiance = Vector3d::Zero();
  std::uint64_t number = 0;
  bool is_on = true;
  SurfaceHit hit = {};
};

/// A surface point that a path has come to.
struct PathTracer::Vertex {
  std::size_t path = 0;
  Vector3d point = {};
  double reach = 0;      ///< as in Ray
  Vector3d normal = {};  ///< of the surface itself, on the side of the viewer
  SurfaceFrame frame = {};
  UnitVector view{};
};

PathTracer::Vertex PathTracer::vertex_of(std::size_t index, const Path& path) {
  Vertex vertex{.path = index, .point = path.ray.at(path.hit.distance)};
  vertex.reach = std::max(path.ray.origin.cwiseAbs().maxCoeff(), path.hit.distance);
  const Vector3d view = -path.ray.direction;
  const double side = path.hit.normal.dot(view) < 0 ? -1 : 1;
  vertex.normal = side * path.hit.normal;
  // A normal that the viewer does not see, as interpolation may give it, is of no use.
  const bool sees_shading = side * path.hit.shading.dot(view) > kLeastViewCosine;
  vertex.frame = frame_of(sees_shading ? Vector3d(side * path.hit.shading) : vertex.normal);
  Vector3d local = vertex.frame.local(view);
  local[2] = std::max(local[2], kLeastViewCosine);
  local.normalize();
  vertex.view = {local[0], local[1], local[2]};
  return vertex;
}

PathTracer::PathTracer(const Device& device, const Scene& scene, const SceneOptions& options,
                       std::optional<std::size_t> varied)
    : scene_(scene), options_(options), rays_(scene.camera), geometry_(scene.shapes), drawer_(device) {
  std::vector<bool> is_used(scene.materials.size());
  for (const SceneShape& shape : scene.shapes) is_used[shape.material] = true;
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    surfaces_.emplace_back();
    if (!is_used[k]) continue;
    SceneOptions choice = options;
    if (varied && *varied != k) choice.proposal = SamplingStrategy::tailored;
    surfaces_.back().emplace(device, scene.materials[k], choice);
    rounding_ = std::max(rounding_, kReflectionRounding * epsilon_of(options.precision) +
                                        kDirectionRounding * kEpsilon / surfaces_.back()->narrowest());
  }
}

std::size_t PathTracer::samples_at_once() const {
  return std::max<std::size_t>(1, kPathsAtOnce / rays_.pixels());
}

Eigen::Matrix3Xd PathTracer::radiances(std::uint64_t first, std::size_t samples) {
  const std::size_t pixels = rays_.pixels();
  std::vector<Path> paths(samples * pixels);
  for_many(paths.size(), [&](std::size_t i) {
    Path& path = paths[i];
    path.number = (first + i / pixels) * pixels + i % pixels;
    const double x = unit_number(options_.seed, 2 * path.number);
    const double y = unit_number(options_.seed, 2 * path.number + 1);
    path.ray = rays_.through(i % pixels, x, y);
  });
  for (std::size_t depth = 0; depth <= scene_.bounces; ++depth) {
    if (!meet(paths)) break;
    reflect(paths, depth);
  }
  // What is left sees the sky, or another surface, of which nothing comes.
  const bool is_dark = vector_from(scene_.sky.radiance).isZero(0);
  if (!is_dark) (void)meet(paths);
  Eigen::Matrix3Xd radiances(3, static_cast<Eigen::Index>(paths.size()));
  for (std::size_t i = 0; i < paths.size(); ++i) radiances.col(static_cast<Eigen::Index>(i)) = paths[i].radiance;
  return radiances;
}

bool PathTracer::meet(std::vector<Path>& paths) const {
  for_many(paths.size(), [&](std::size_t i) {
    Path& path = paths[i];
    if (!path.is_on) return;
    const auto hit = geometry_.nearest(path.ray);
    path.is_on = hit.has_value();
    if (hit) {
      path.hit = *hit;
    } else {
      path.radiance += path.weight.cwiseProduct(radiance_of(scene_.sky, path.ray.direction));
    }
  });
  return std::ranges::any_of(paths, &Path::is_on);
}

void PathTracer::reflect(std::vector<Path>& paths, std::size_t depth) {
  std::vector<std::vector<std::size_t>> of_material(surfaces_.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].is_on) of_material[scene_.shapes[paths[i].hit.shape].material].push_back(i);
  }
  for (std::size_t k = 0; k < of_material.size(); ++k) {
    if (of_material[k].empty()) continue;
    std::vector<Vertex> vertices(of_material[k].size());
    for_many(vertices.size(),
             [&](std::size_t i) { vertices[i] = vertex_of(of_material[k][i], paths[of_material[k][i]]); });
    add_lights(paths, vertices, *surfaces_[k]);
    go_on(paths, vertices, *surfaces_[k], depth);
  }
}

void PathTracer::add_lights(std::vector<Path>& paths, std::span<const Vertex> vertices,
                            const SceneSurface& surface) const {
  for (const SceneLight& light : scene_.lights) {
    const Vector3d position = vector_from(light.position);
    const Vector3d intensity = vector_from(light.intensity);
    // Each vertex has two directions: to the light, and to its image below the surface, which go_on() sends up.
    std::vector<double> factors(2 * vertices.size());  // cosine over the square of the distance; 0: not seen
    std::vector<UnitVector> directions(2 * vertices.size());
    for_many(vertices.size(), [&](std::size_t i) {
      const Vertex& vertex = vertices[i];
      const Vector3d way = position - vertex.point;
      const double distance = way.norm();
      if (!(distance > 0)) return;
      const Vector3d towards = way / distance;
      const std::array locals{vertex.frame.local(towards), vertex.frame.local(mirrored(towards, vertex.normal))};
      if (!(std::max(locals[0][2], locals[1][2]) > 0) || !(vertex.normal.dot(towards) > 0)) return;
      if (geometry_.is_blocked({vertex.point, towards, vertex.reach}, distance)) return;
      for (std::size_t k = 0; k < locals.size(); ++k) {
        const Vector3d& local = locals.at(k);
        if (!(local[2] > 0)) continue;
        directions[2 * i + k] = {local[0], local[1], local[2]};
        factors[2 * i + k] = local[2] / (distance * distance);
      }
    });
    std::vector<std::size_t> seen;
    std::vector<Directions> pairs;
    for (std::size_t i = 0; i < factors.size(); ++i) {
      if (!(factors[i] > 0)) continue;
      seen.push_back(i);
      pairs.push_back(pair_of(directions[i], vertices[i / 2].view));
    }
    const Eigen::Matrix3Xd values = surface.values(pairs);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      Path& path = paths[vertices[seen[k] / 2].path];
      const Vector3d reflected = values.col(static_cast<Eigen::Index>(k)).cwiseProduct(intensity) * factors[seen[k]];
      path.radiance += path.weight.cwiseProduct(reflected);
    }
  }
}

void PathTracer::go_on(std::vector<Path>& paths, std::span<const Vertex> vertices, const SceneSurface& surface,
                       std::size_t depth) {
  const bool is_last = depth == scene_.bounces;
  if (is_last && vector_from(scene_.sky.radiance).isZero(0)) {
    for (const Vertex& vertex : vertices) paths[vertex.path].is_on = false;
    return;
  }
  std::vector<PathView> views;
  for (const Vertex& vertex : vertices) {
    views.push_back({vertex.view, paths[vertex.path].number * (kMostBounces + 2) + depth});
  }
  const auto steps = surface.draw(drawer_, views, options_.seed);
  for_many(vertices.size(), [&](std::size_t i) {
    const Vertex& vertex = vertices[i];
    Path& path = paths[vertex.path];
    Vector3d direction = vertex.frame.global(vector_from(steps[i].direction));
    // Below the surface itself, though above that of shading, there is nothing to see: light goes back up.
    if (vertex.normal.dot(direction) < 0) direction = mirrored(direction, vertex.normal);
    path.weight = path.weight.cwiseProduct(vector_from(steps[i].weight));
    path.is_on = steps[i].direction[2] > 0 && vertex.normal.dot(direction) > 0 && !path.weight.isZero(0);
    path.ray = {vertex.point, direction.normalized(), vertex.reach};
  });
}

}  // namespace lobe
