#include "lobe/render/render_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/numbers.hpp"
#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "core/text.hpp"
#include "device/rounding.hpp"
#include "lobe/core/error.hpp"
#include "render/scene_geometry.hpp"
#include "render/scene_surface.hpp"

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

/// The rays of a camera.
class CameraRays {
 public:
  explicit CameraRays(const SceneCamera& camera) : size_(camera.size), origin_(vector_from(camera.position)) {
    forward_ = (vector_from(camera.target) - origin_).normalized();
    const double height = std::tan(camera.field_of_view / 2);
    const double aspect = static_cast<double>(size_[0]) / static_cast<double>(size_[1]);
    const Vector3d right = forward_.cross(vector_from(camera.up)).normalized();
    right_ = height * aspect * right;
    up_ = height * right.cross(forward_);
  }

  [[nodiscard]] std::size_t pixels() const { return size_[0] * size_[1]; }
  /// The ray through a point of a pixel, from its upper left corner; x and y in [0, 1].
  [[nodiscard]] Ray through(std::size_t pixel, double x, double y) const {
    const double across = 2 * (static_cast<double>(pixel % size_[0]) + x) / static_cast<double>(size_[0]) - 1;
    const std::size_t row = pixel / size_[0];
    const double down = 2 * (static_cast<double>(row) + y) / static_cast<double>(size_[1]) - 1;
    return {origin_, (forward_ + across * right_ - down * up_).normalized()};
  }

 private:
  std::array<std::size_t, 2> size_;
  Vector3d origin_;
  Vector3d forward_;
  Vector3d right_;
  Vector3d up_;
};

Vector3d radiance_of(const SceneSky& sky, const Vector3d& direction) {
  Vector3d zenith = vector_from(sky.radiance);
  if (sky.kind == SkyKind::uniform) return zenith;
  return direction[2] > 0 ? Vector3d(zenith * (1 + 2 * direction[2]) / 3) : Vector3d(Vector3d::Zero());
}

/// A path on its way, from the camera.
struct Path {
  Ray ray;
  Vector3d weight = Vector3d::Ones();  ///< of what it is still to see
  Vector3d radiance = Vector3d::Zero();
  std::uint64_t number = 0;
  bool is_on = true;
  SurfaceHit hit = {};
};

/// A surface point that a path has come to.
struct Vertex {
  std::size_t path = 0;
  Vector3d point = {};
  double reach = 0;      ///< as in Ray
  Vector3d normal = {};  ///< of the surface itself, on the side of the viewer
  SurfaceFrame frame = {};
  UnitVector view{};
};

Vertex vertex_of(std::size_t index, const Path& path) {
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

/// The image of a direction on the other side of a surface.
Vector3d mirrored(const Vector3d& direction, const Vector3d& normal) {
  return direction - 2 * normal.dot(direction) * normal;
}

void for_chunks(std::size_t count, const std::function<void(std::size_t)>& work) {
  constexpr std::size_t kChunk = 256;
  parallel_for((count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) work(i);
  });
}

/// Follows paths, all at once.
class PathTracer {
 public:
  /// \param varied the material that is drawn as the options say, others by importance; none: all as they say
  PathTracer(const Device& device, const Scene& scene, const SceneOptions& options,
             std::optional<std::size_t> varied = std::nullopt)
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

  /// Relative rounding of radiances, which all samples may share.
  [[nodiscard]] double rounding() const { return rounding_; }

  /// Radiances of samples first, first + 1, ... of every pixel, one sample after the other.
  [[nodiscard]] Eigen::Matrix3Xd radiances(std::uint64_t first, std::size_t samples) {
    const std::size_t pixels = rays_.pixels();
    std::vector<Path> paths(samples * pixels);
    for_chunks(paths.size(), [&](std::size_t i) {
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

 private:
  /// Sends rays on. Paths that meet nothing see the sky and end.
  /// \return whether a path is left
  bool meet(std::vector<Path>& paths) const {
    for_chunks(paths.size(), [&](std::size_t i) {
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

  void reflect(std::vector<Path>& paths, std::size_t depth) {
    std::vector<std::vector<std::size_t>> of_material(surfaces_.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (paths[i].is_on) of_material[scene_.shapes[paths[i].hit.shape].material].push_back(i);
    }
    for (std::size_t k = 0; k < of_material.size(); ++k) {
      if (of_material[k].empty()) continue;
      std::vector<Vertex> vertices(of_material[k].size());
      for_chunks(vertices.size(),
                 [&](std::size_t i) { vertices[i] = vertex_of(of_material[k][i], paths[of_material[k][i]]); });
      add_lights(paths, vertices, *surfaces_[k]);
      go_on(paths, vertices, *surfaces_[k], depth);
    }
  }

  /// Light of the point lights that vertices see.
  void add_lights(std::vector<Path>& paths, std::span<const Vertex> vertices, const SceneSurface& surface) const {
    for (const SceneLight& light : scene_.lights) {
      const Vector3d position = vector_from(light.position);
      const Vector3d intensity = vector_from(light.intensity);
      // Each vertex has two directions: to the light, and to its image below the surface, which go_on() sends up.
      std::vector<double> factors(2 * vertices.size());  // cosine over the square of the distance; 0: not seen
      std::vector<UnitVector> directions(2 * vertices.size());
      for_chunks(vertices.size(), [&](std::size_t i) {
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

  /// Draws where paths go on.
  void go_on(std::vector<Path>& paths, std::span<const Vertex> vertices, const SceneSurface& surface,
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
    for_chunks(vertices.size(), [&](std::size_t i) {
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

  const Scene& scene_;
  const SceneOptions& options_;
  double rounding_ = 0;
  CameraRays rays_;
  SceneGeometry geometry_;
  std::vector<std::optional<SceneSurface>> surfaces_;
  EachDrawer drawer_;
};

/// Adds samples to means and to sums of squared differences from them (Welford 1962).
class Accumulation {
 public:
  /// \param rounding relative rounding of radiances
  Accumulation(std::size_t pixels, double rounding)
      : mean_(Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(pixels))), squares_(mean_), rounding_(rounding) {}

  void add(const Eigen::Matrix3Xd& radiances) {
    const Eigen::Index pixels = mean_.cols();
    for (Eigen::Index first = 0; first < radiances.cols(); first += pixels) {
      ++samples_;
      const auto sample = radiances.middleCols(first, pixels);
      const Eigen::Matrix3Xd difference = sample - mean_;
      mean_ += difference / static_cast<double>(samples_);
      squares_ += difference.cwiseProduct(sample - mean_);
    }
  }

  [[nodiscard]] SceneImage image(const SceneCamera& camera, double seconds) const {
    const double freedom = static_cast<double>(samples_) - 1;
    return {camera.size, mean_, squares_ / std::max(freedom, 1.0), samples_, seconds, rounding_};
  }
  [[nodiscard]] std::size_t samples() const { return samples_; }

 private:
  Eigen::Matrix3Xd mean_;
  Eigen::Matrix3Xd squares_;
  double rounding_;
  std::size_t samples_ = 0;
};

void require_valid(const SceneOptions& options) {
  constexpr std::size_t kMostSamples = 100'000'000;
  if (options.samples < 2 || options.samples > kMostSamples) {
    throw ArgumentError(fmt::format("{} samples per pixel; expected 2 to {}", options.samples, kMostSamples));
  }
  if (!(options.noise >= 0) || !(options.seconds >= 0)) {
    throw ArgumentError("a noise or a time of less than nothing; expected both at least 0");
  }
}

void require_finite(const Eigen::Matrix3Xd& radiances) {
  if (radiances.allFinite()) return;
  throw NumericError("the radiance of a path is no finite number; check the parameters of the materials");
}

}  // namespace

std::array<Estimate, 3> SceneImage::mean_radiance() const {
  const Eigen::Matrix3Xd errors = variance_of_mean();
  std::array<Estimate, 3> means{};
  const auto pixels = static_cast<double>(radiance.cols());
  for (std::size_t c = 0; c < means.size(); ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    const double mean = radiance.row(row).mean();
    means.at(c) = {mean, std::hypot(std::sqrt(errors.row(row).sum()) / pixels, rounding * mean)};
  }
  return means;
}

double SceneImage::relative_noise() const {
  const double mean = radiance.size() == 0 ? 0 : radiance.mean();
  if (!(mean > 0)) return std::numeric_limits<double>::infinity();
  return std::sqrt(variance_of_mean().mean()) / mean;
}

SceneImage render_scene(const Device& device, const Scene& scene, const SceneOptions& options) {
  require_valid(scene);
  require_valid(options);
  PathTracer tracer(device, scene, options);
  const std::size_t pixels = scene.camera.size[0] * scene.camera.size[1];
  const std::size_t at_once = std::max<std::size_t>(1, kPathsAtOnce / pixels);
  Accumulation sum(pixels, tracer.rounding());
  Stopwatch watch;
  double seconds = 0;
  constexpr std::size_t kFirst = 8;  // samples, after which the noise is looked at
  while (sum.samples() < options.samples) {
    const std::size_t done = sum.samples();
    if (options.progress &&
        !options.progress("rendering", static_cast<double>(done) / static_cast<double>(options.samples))) {
      throw Cancelled("cancelled");
    }
    const std::size_t count = std::min(at_once, options.samples - done);
    const Eigen::Matrix3Xd radiances = tracer.radiances(options.first + done, count);
    require_finite(radiances);
    sum.add(radiances);
    seconds += watch.lap();
    const bool is_enough = sum.samples() >= 2 && options.seconds > 0 && seconds >= options.seconds;
    const bool may_be_calm = sum.samples() >= kFirst && options.noise > 0;
    if (!options.refined && !may_be_calm && !is_enough) continue;
    SceneImage image = sum.image(scene.camera, seconds);
    if (options.refined) options.refined(image);
    if (is_enough || (may_be_calm && image.relative_noise() <= options.noise)) return image;
  }
  return sum.image(scene.camera, seconds);
}

namespace {

/// Which pixels see the shapes of a material and nothing else, by their middles and those of their neighbours.
std::vector<Eigen::Index> pixels_of(const Scene& scene, std::size_t material) {
  const CameraRays rays(scene.camera);
  const SceneGeometry geometry(scene.shapes);
  std::vector<char> sees(rays.pixels());
  for_chunks(sees.size(), [&](std::size_t pixel) {
    const auto hit = geometry.nearest(rays.through(pixel, 0.5, 0.5));
    sees[pixel] = hit && scene.shapes[hit->shape].material == material ? 1 : 0;
  });
  const auto [width, height] = scene.camera.size;
  std::vector<Eigen::Index> pixels;
  for (std::size_t y = 1; y + 1 < height; ++y) {
    for (std::size_t x = 1; x + 1 < width; ++x) {
      bool sees_all = true;
      for (std::size_t row = y - 1; row <= y + 1; ++row) {
        for (std::size_t column = x - 1; column <= x + 1; ++column) {
          sees_all = sees_all && sees[row * width + column] != 0;
        }
      }
      if (sees_all) pixels.push_back(static_cast<Eigen::Index>(y * width + x));
    }
  }
  return pixels;
}

/// A mean with its standard error.
Estimate mean_of(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  double mean = 0;
  for (const double value : values) mean += value / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (count - 1) / count)};
}

/// A ratio of independent means, with the standard error to first order; 0 / 0: no numbers.
Estimate ratio_of(const Estimate& a, const Estimate& b) {
  if (b.value == 0) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {a.value == 0 ? kNone : std::numeric_limits<double>::infinity(), kNone};
  }
  const double ratio = a.value / b.value;
  return {ratio, std::hypot(a.error, ratio * b.error) / b.value};
}

/// A variance that is more than the relative rounding of radiances, else 0.
Estimate beyond_rounding(const Estimate& variance, const Estimate& radiance, double rounding) {
  const double least = rounding * radiance.value;
  return variance.value > least * least ? variance : Estimate{};
}

/// What batches of one strategy found.
struct Batches {
  std::vector<double> variances;
  std::vector<double> means;
  double seconds = 0;
};

}  // namespace

std::vector<SamplingContest> compare_sampling(const Device& device, const Scene& scene, std::size_t material,
                                              std::span<const SceneMaterial> with, const SceneOptions& options) {
  constexpr std::size_t kBatches = 8;
  require_valid(scene);
  require_valid(options);
  if (material >= scene.materials.size()) throw ArgumentError("the scene has no such material to replace");
  if (options.samples % kBatches != 0 || options.samples < 2 * kBatches) {
    throw ArgumentError(fmt::format("{} samples for a comparison; expected a multiple of {} from {} on",
                                    options.samples, kBatches, 2 * kBatches));
  }
  const auto pixels = pixels_of(scene, material);
  if (pixels.empty()) {
    throw ArgumentError("no pixel sees nothing but material '" + scene.materials[material].name +
                        "'; expected it larger in the picture");
  }
  constexpr std::array kStrategies{SamplingStrategy::cosine, SamplingStrategy::tailored};
  std::vector<SamplingContest> contests;
  for (std::size_t k = 0; k < with.size(); ++k) {
    Scene changed = scene;
    changed.materials[material] = with[k];
    std::array<SceneOptions, 2> choices{options, options};
    std::vector<PathTracer> tracers;
    tracers.reserve(choices.size());
    for (std::size_t s = 0; s < choices.size(); ++s) {
      choices.at(s).proposal = kStrategies.at(s);
      tracers.emplace_back(device, changed, choices.at(s), material);
      (void)tracers.back().radiances(options.first, 1);  // builds kernels, which no sample should wait for
    }
    std::array<Batches, 2> found;
    const std::size_t samples = options.samples / kBatches;
    const std::size_t at_once = std::max<std::size_t>(1, kPathsAtOnce / (scene.camera.size[0] * scene.camera.size[1]));
    for (std::size_t batch = 0; batch < kBatches; ++batch) {
      if (options.progress && !options.progress("comparing", static_cast<double>(k * kBatches + batch) /
                                                                 static_cast<double>(with.size() * kBatches))) {
        throw Cancelled("cancelled");
      }
      for (std::size_t s = 0; s < tracers.size(); ++s) {
        Accumulation sum(scene.camera.size[0] * scene.camera.size[1], tracers[s].rounding());
        Stopwatch watch;
        while (sum.samples() < samples) {
          const std::size_t count = std::min(at_once, samples - sum.samples());
          const Eigen::Matrix3Xd radiances =
              tracers[s].radiances(options.first + batch * samples + sum.samples(), count);
          require_finite(radiances);
          sum.add(radiances);
        }
        found.at(s).seconds += watch.lap();
        const SceneImage image = sum.image(scene.camera, 0);
        double variance = 0;
        double mean = 0;
        for (const Eigen::Index pixel : pixels) {
          variance += image.variance.col(pixel).mean() / static_cast<double>(pixels.size());
          mean += image.radiance.col(pixel).mean() / static_cast<double>(pixels.size());
        }
        found.at(s).variances.push_back(variance);
        found.at(s).means.push_back(mean);
      }
    }
    SamplingContest contest;
    contest.material = with[k].name;
    contest.pixels = pixels.size();
    for (std::size_t s = 0; s < found.size(); ++s) {
      contest.radiance.at(s) = mean_of(found.at(s).means);
      contest.variance.at(s) =
          beyond_rounding(mean_of(found.at(s).variances), contest.radiance.at(s), tracers.at(s).rounding());
      contest.seconds.at(s) = found.at(s).seconds / static_cast<double>(options.samples);
    }
    contest.equal_samples = ratio_of(contest.variance[0], contest.variance[1]);
    const double time = contest.seconds[0] / contest.seconds[1];
    contest.equal_time = {contest.equal_samples.value * time, contest.equal_samples.error * time};
    contests.push_back(std::move(contest));
  }
  return contests;
}

}  // namespace lobe
