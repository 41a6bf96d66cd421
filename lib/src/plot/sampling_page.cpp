#include "lobe/plot/sampling_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"
#include "model/catalogue.hpp"

namespace lobe {
namespace {

constexpr std::array kPageAngles{0.0, 45.0, 80.0, 89.0};  // degrees

ModelSampling sample_model(const Device& device, const Material& material, PatchDraw patches, std::string label,
                           const SamplingPageOptions& options) {
  ModelSampling found{std::move(label), sampling_strategy_text(material.terms.front()), {}};
  for (const double angle : kPageAngles) {
    const Direction in{angle * kDegree, 0};
    SamplingOptions sampling{.seed = options.seed, .patches = patches};
    AngleSampling at{in.theta, sampled_albedo(device, material, in, options.count, sampling), {}};
    sampling.proposal = SamplingStrategy::cosine;
    at.cosine = sampled_albedo(device, material, in, options.count, sampling);
    found.angles.push_back(std::move(at));
  }
  return found;
}

/// Two digits; rounding of weights that are all the same counts for nothing.
std::string variance_text(const SampledAlbedo& found) {
  constexpr double kNothing = 1e-6;
  const double variance = found.relative_variance(0);
  if (!std::isfinite(variance)) return "–";
  return variance < kNothing ? "0" : fmt::format("{:.2g}", variance);
}

}  // namespace

Material typical_material(std::string_view model) {
  const CatalogueEntry& entry = find_entry(model);
  std::vector<NamedValue> values;
  for (std::size_t k = 0; k < entry.typical.size(); ++k) {
    values.emplace_back(entry.model.parameters[k].name, entry.typical[k]);
  }
  return make_material(model, values);
}

std::vector<ModelSampling> sample_catalogue(const Device& device, const SamplingPageOptions& options,
                                            const ProgressCallback& progress) {
  std::vector<ModelSampling> found;
  const auto models = catalogue();
  for (std::size_t k = 0; k < models.size(); ++k) {
    if (progress && !progress("sampling", static_cast<double>(k) / static_cast<double>(models.size()))) {
      throw Cancelled("interrupted");
    }
    if (models[k].traits.has_delta) continue;
    const Material material = typical_material(models[k].name);
    if (models[k].name != "basic_patch") {
      found.push_back(sample_model(device, material, PatchDraw::exact, material.name, options));
      continue;
    }
    const std::array ways{std::pair{PatchDraw::exact, "exact"}, std::pair{PatchDraw::rejection, "rejection"},
                          std::pair{PatchDraw::roulette, "roulette"}};
    for (const auto& [way, name] : ways) {
      found.push_back(sample_model(device, material, way, material.name + " " + name, options));
    }
  }
  return found;
}

std::string sampling_page(std::span<const ModelSampling> models) {
  std::string text = R"(# Drawing directions by importance

Made by `lobe sample --catalogue`.

A path tracer wants directions V with a density near f(L, V) N.V and the weight f N.V / density of each: the mean of the
weights is the albedo (1.13), that of weights times radiance the reflected radiance (3.18). `lobe sample MATERIAL --theta 45`
writes them, `sample()` of `lobe/sampling/sampling.hpp` draws them on the device. Random numbers are those of Philox4x32-10 (Salmon et
al. 2011) by seed and number of the sample, so that the same seed gives the same samples on every device and for every
division of work.

| strategy | density |
|---|---|
| cosine | N.V / pi |
| uniform | 1 / (2 pi), for what is above 0 down to the horizon |
| power | (n+1)/(2 pi) max(0, A.V)^n (3.19), A the mirror direction, L, the normal, or the axis M L of Lafortune's lobes |
| power on the inner sphere | the same of V_S = 2 (N.V) V - N (1.69), times 4 N.V |
| Beckmann facets | half-vectors H with D(H) N.H = exp(-tan^2/m^2) / (pi m^2 (N.H)^3); V the mirror direction about H (Walter 2005) |
| cosine-power facets | half-vectors H with (n+1)/(2 pi) (N.H)^n (Ashikhmin and Shirley 2000) |
| visible facets | half-vectors of Trowbridge and Reitz that L sees (Heitz 2018) |
| patch | evenly in a disc of the base plane, exactly, by rejection or by Russian roulette (4.2.4) |
| patches by F^-1 | a radius by the inverse of its distribution, then a point of that patch (4.4) |

Models with several strategies draw from their mixture, whose density all samples are weighed by; so do sums of models, with
probabilities in proportion to the albedos of the terms, estimated by 4096 samples each, averaged over channels. Factors only
weigh. Mirrors are drawn with a probability of their own. Tables draw a cell of the base plane by the alias method, in
proportion to the mean size of the interpolated values there, a tenth of them by the cosine; weights are those of the values
that `lobe eval` interpolates. The density is above 0 wherever the reflectance is not 0.

Directions below the horizon and points outside the unit disc are lost: their weight is 0, which is unbiased (3.4.1).

## Variance

)";
  if (!models.empty()) {
    fmt::format_to(std::back_inserter(text),
                   "The variance of a weight over the squared albedo, by importance / by the cosine alone, from {} "
                   "samples each:\nhow many samples a relative standard error of 1 takes. Figure 4.9 shows in pictures "
                   "what stands here for patches. Large\nvalues by the cosine are lower bounds: few of the samples see "
                   "the lobe. – stands for lobes that none saw.\n\n",
                   SamplingPageOptions{}.count);
  }
  text += "| material | strategies | 0° | 45° | 80° | 89° | lost at 89° |\n|---|---|---|---|---|---|---|\n";
  for (const auto& model : models) {
    fmt::format_to(std::back_inserter(text), "| `{}` | {} |", model.label, model.proposal);
    for (const auto& at : model.angles) {
      fmt::format_to(std::back_inserter(text), " {} / {} |", variance_text(at.importance), variance_text(at.cosine));
    }
    fmt::format_to(std::back_inserter(text), " {:.2g} |\n", model.angles.back().importance.lost);
  }
  return text;
}

}  // namespace lobe
