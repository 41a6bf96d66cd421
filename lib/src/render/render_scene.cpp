#include "lobe/render/render_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "lobe/core/error.hpp"
#include "render/path_tracer.hpp"
#include "render/scene_geometry.hpp"
#include "render/scene_sum.hpp"

namespace lobe {
namespace {

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

SceneCamera with_width(SceneCamera camera, std::size_t width) {
  auto& [across, down] = camera.size;
  down = std::max<std::size_t>(1, (down * width + across / 2) / across);
  across = width;
  return camera;
}

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

struct SceneRendering::Content {
  Scene scene;
  SceneOptions options;
  PathTracer tracer;
  SceneSum sum;
  double seconds = 0;

  Content(const Device& device, Scene&& drawn, const SceneOptions& how)
      : scene(std::move(drawn)),
        options(how),
        tracer(device, scene, options),
        sum(scene.camera.size[0] * scene.camera.size[1], tracer.rounding()) {
    options.progress = {};  // of whoever began this
  }
};

SceneRendering::SceneRendering(const Device& device, Scene scene, const SceneOptions& options) {
  require_valid(scene);
  content_ = std::make_unique<Content>(device, std::move(scene), options);
}
SceneRendering::~SceneRendering() = default;
SceneRendering::SceneRendering(SceneRendering&&) noexcept = default;
SceneRendering& SceneRendering::operator=(SceneRendering&&) noexcept = default;

void SceneRendering::refine(std::size_t samples) {
  const std::size_t at_once = samples_at_once();
  Stopwatch watch;
  for (std::size_t left = samples; left > 0;) {
    const std::size_t count = std::min(at_once, left);
    const Eigen::Matrix3Xd radiances =
        content_->tracer.radiances(content_->options.first + content_->sum.samples(), count);
    require_finite(radiances);
    content_->sum.add(radiances);
    content_->seconds += watch.lap();
    left -= count;
  }
}

std::size_t SceneRendering::samples_at_once() const {
  return content_->tracer.samples_at_once();
}

std::size_t SceneRendering::samples() const {
  return content_->sum.samples();
}

SceneImage SceneRendering::image() const {
  return content_->sum.image(content_->scene.camera, content_->seconds);
}

SceneImage render_scene(const Device& device, const Scene& scene, const SceneOptions& options) {
  require_valid(options);
  SceneRendering rendering(device, scene, options);
  const std::size_t at_once = rendering.samples_at_once();
  Stopwatch watch;
  double seconds = 0;
  constexpr std::size_t kFirst = 8;  // samples, after which the noise is looked at
  while (rendering.samples() < options.samples) {
    const std::size_t done = rendering.samples();
    if (options.progress &&
        !options.progress("rendering", static_cast<double>(done) / static_cast<double>(options.samples))) {
      throw Cancelled("cancelled");
    }
    rendering.refine(std::min(at_once, options.samples - done));
    seconds += watch.lap();
    const bool is_enough = rendering.samples() >= 2 && options.seconds > 0 && seconds >= options.seconds;
    const bool may_be_calm = rendering.samples() >= kFirst && options.noise > 0;
    if (!options.refined && !is_enough && !may_be_calm) continue;
    SceneImage image = rendering.image();
    image.seconds = seconds;
    if (options.refined) options.refined(image);
    if (is_enough || (may_be_calm && image.relative_noise() <= options.noise)) return image;
  }
  SceneImage image = rendering.image();
  image.seconds = seconds;
  return image;
}

namespace {

/// Which pixels see the shapes of a material and nothing else, by their middles and those of their neighbours.
std::vector<Eigen::Index> pixels_of(const Scene& scene, std::size_t material) {
  const CameraRays rays(scene.camera);
  const SceneGeometry geometry(scene.shapes);
  std::vector<char> sees(rays.pixels());
  for_many(sees.size(), [&](std::size_t pixel) {
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
    const std::size_t at_once = tracers.front().samples_at_once();
    for (std::size_t batch = 0; batch < kBatches; ++batch) {
      if (options.progress && !options.progress("comparing", static_cast<double>(k * kBatches + batch) /
                                                                 static_cast<double>(with.size() * kBatches))) {
        throw Cancelled("cancelled");
      }
      for (std::size_t s = 0; s < tracers.size(); ++s) {
        SceneSum sum(scene.camera.size[0] * scene.camera.size[1], tracers[s].rounding());
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
