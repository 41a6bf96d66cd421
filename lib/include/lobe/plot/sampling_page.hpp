#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/sampling/sampling.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Variances of sampling a model at one angle of incidence.
struct AngleSampling {
  double theta = 0;          ///< radians
  SampledAlbedo importance;  ///< samples drawn as by sample()
  SampledAlbedo cosine;      ///< samples drawn in proportion to the cosine N.V
};

/// Variances of sampling a material of a model at several angles.
struct ModelSampling {
  std::string label;                  ///< the material, and how its patches are drawn if that differs
  std::string proposal;               ///< see sampling_strategy_text()
  std::vector<AngleSampling> angles;  ///< one per angle of incidence
};

/// Options for estimating variances.
struct SamplingPageOptions {
  std::size_t count = std::size_t{1} << 18;  ///< samples for each variance
  std::uint64_t seed = 1;                    ///< seed of the random numbers
};

/// Makes a typical material of a model: of medium width, anisotropic lobes a few times longer than wide.
/// \throws ArgumentError for an unknown model
[[nodiscard]] Material typical_material(std::string_view model);

/// Samples all models that have values, each by its typical_material(), at 0, 45, 80 and 89 degrees; the basic patch in
/// each of the three ways of Neumann 2001, 4.2.4.
/// \throws DeviceError; Cancelled
[[nodiscard]] std::vector<ModelSampling> sample_catalogue(const Device& device, const SamplingPageOptions& options = {},
                                                          const ProgressCallback& progress = {});

/// Writes the results as a page for people (Markdown): docs/sampling.md. Each material has a row: strategies, and by
/// angle the variance of a weight over the squared albedo, by importance / by the cosine.
[[nodiscard]] std::string sampling_page(std::span<const ModelSampling> models);

}  // namespace lobe
