#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/sampling_strategy.hpp"
#include "lobe/render/scene.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A picture of a scene, pixel by pixel in rows from the upper left.
struct SceneImage {
  std::array<std::size_t, 2> size{0, 0};  ///< pixels, width and height
  Eigen::Matrix3Xd radiance;              ///< means over samples and pixels, linear red, green and blue x pixels
  Eigen::Matrix3Xd variance;              ///< variance of a single sample, from the samples themselves
  std::size_t samples = 0;                ///< samples per pixel
  double seconds = 0;                     ///< time that they took
  double rounding = 0;                    ///< relative rounding of radiances, which no variance shows

  /// Variance of the mean in each pixel: variance / samples.
  [[nodiscard]] Eigen::Matrix3Xd variance_of_mean() const { return variance / static_cast<double>(samples); }
  /// Mean radiance of the picture, red, green and blue, with its standard error, which contains rounding.
  [[nodiscard]] std::array<Estimate, 3> mean_radiance() const;
  /// Root of the mean variance of the mean over the mean radiance; infinite for a black picture.
  [[nodiscard]] double relative_noise() const;
};

/// Options for rendering a scene.
struct SceneOptions {
  std::size_t samples = 64;  ///< largest number of samples per pixel, at least 2
  double noise = 0;          ///< relative_noise() at which it stops earlier
  double seconds = 0;        ///< time after which it stops earlier; 0: any time. Pictures then depend on the machine
  std::uint64_t seed = 1;    ///< seed of the random numbers: the same seed gives the same picture
  std::uint64_t first = 0;   ///< number of the first sample, for more samples of the same seed
  SamplingStrategy proposal = SamplingStrategy::tailored;  ///< distribution that directions are drawn from
  PatchDraw patches = PatchDraw::exact;                    ///< how directions of basic patches are drawn
  Precision precision = Precision::double_precision;       ///< arithmetic of the models
  ProgressCallback progress = {};                          ///< told of the progress; may cancel
  /// Called with the picture so far, after the first samples and ever more.
  std::function<void(const SceneImage&)> refined = {};
};

/// Renders a scene by path tracing: at every surface that a path from the camera meets it adds the light of the point
/// lights that are visible from there, and goes on in a direction that is drawn as sample() draws it; where it meets
/// nothing, it sees the sky. Tables and functions are drawn by cells of 32 elevations of the viewer if they are
/// isotropic, by cosines otherwise. Paths end after the scene's bounces; the light that would follow is missing.
/// \throws ArgumentError for a scene or options that make no sense, reflectances of other than one or three channels,
///   and tables with delta parts; NumericError for values that are not finite; as evaluate() and sample(); DeviceError;
///   Cancelled
[[nodiscard]] SceneImage render_scene(const Device& device, const Scene& scene, const SceneOptions& options = {});

/// A picture of a scene that more samples refine whenever there is time for them. After n samples per pixel it is what
/// render_scene() gives for n samples with the same options, however they were asked for.
class SceneRendering {
 public:
  /// \param scene the scene, of which this keeps a copy
  /// \param options how it is drawn; samples, noise, seconds and refined count for nothing, progress only while
  ///   functions are tabulated here
  /// \throws as render_scene()
  SceneRendering(const Device& device, Scene scene, const SceneOptions& options = {});
  ~SceneRendering();
  /// Takes over the picture of another one, which is left to be destroyed.
  SceneRendering(SceneRendering&&) noexcept;
  /// Takes over the picture of another one, which is left to be destroyed.
  SceneRendering& operator=(SceneRendering&&) noexcept;

  /// Adds samples to every pixel.
  /// \throws NumericError for radiances that are not finite; DeviceError
  void refine(std::size_t samples = 1);
  /// How many samples are best added together, a fraction of a second of work; the picture does not depend on it.
  [[nodiscard]] std::size_t samples_at_once() const;
  /// Samples per pixel so far.
  [[nodiscard]] std::size_t samples() const;
  /// The picture so far, black without a sample; variances are 0 up to the second one. Its time is that of refine().
  [[nodiscard]] SceneImage image() const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// A material drawn by cosines and by importance, in the same scene (Neumann 2001, figure 4.9). Variances are those of
/// single samples, as means over pixels and channels where the material is seen.
struct SamplingContest {
  std::string material;                 ///< its name
  std::array<Estimate, 2> variance;     ///< by cosines, by importance, 0 below rounding; errors are standard errors
  std::array<double, 2> seconds{0, 0};  ///< time for a sample of every pixel
  std::array<Estimate, 2> radiance;     ///< mean radiance where the material is seen; errors are standard errors
  Estimate equal_samples;  ///< variance by cosines over that by importance, with its standard error; NaN: 0 / 0
  Estimate equal_time;     ///< the same for as many samples as take equally long; times taken as exact
  std::size_t pixels = 0;  ///< pixels that see nothing else
};

/// Draws the shapes of a material in turn with each of some reflectances, by cosines and by importance, and compares
/// variances. All other materials are drawn by importance. Samples are taken in eight batches of either strategy in
/// turn, so that other work on the machine slows both down; errors are those of the means of the batches.
/// \param material index of the material that is replaced
/// \param with reflectances and their names in its place
/// \param options of both; proposal and refined count for nothing, samples is the number of either, a multiple of 8
/// \throws ArgumentError if no pixel sees the material alone; as render_scene()
[[nodiscard]] std::vector<SamplingContest> compare_sampling(const Device& device, const Scene& scene,
                                                            std::size_t material, std::span<const SceneMaterial> with,
                                                            const SceneOptions& options = {});

}  // namespace lobe
