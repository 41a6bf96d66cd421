#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/energy/sampling.hpp"

namespace lobe {

/// What sampling of a model costs in variance, at one angle of incidence.
struct AngleSampling {
  double theta = 0;          ///< radians
  SampledAlbedo importance;  ///< drawn as sample() does
  SampledAlbedo cosine;      ///< drawn by the cosine, in proportion to N.V
};

/// The same at several angles, of a material of the model.
struct ModelSampling {
  std::string label;                  ///< the material, and how its patches are drawn where that differs
  std::string proposal;               ///< see proposal_text()
  std::vector<AngleSampling> angles;  ///< one per angle of incidence
};

/// How variances are found.
struct SamplingPageOptions {
  std::size_t count = std::size_t{1} << 18;  ///< samples for each variance
  std::uint64_t seed = 1;                    ///< of the random numbers
};

/// A material that stands for a model: of a middling width, anisotropic lobes a few times longer than wide.
/// \throws ArgumentError for an unknown model
[[nodiscard]] Material typical_material(std::string_view model);

/// All models that have values, each by its typical_material(), at 0, 45, 80 and 89 degrees; the basic patch in each of
/// the three ways of Neumann 2001, 4.2.4.
/// \throws DeviceError; Cancelled.
[[nodiscard]] std::vector<ModelSampling> sample_catalogue(const Device& device, const SamplingPageOptions& options = {},
                                                          const ProgressCallback& progress = {});

/// What was found as a page for people (Markdown): docs/sampling.md. A row per material: strategies, and by angle the
/// variance of a weight over the squared albedo, by importance / by the cosine.
[[nodiscard]] std::string sampling_page(std::span<const ModelSampling> models);

}  // namespace lobe
