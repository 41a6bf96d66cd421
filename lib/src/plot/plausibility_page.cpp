#include "lobe/plot/plausibility_page.hpp"
#include "lobe/core/directions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace lobe {
namespace {

/// Bold what the model violates, and of which material that was seen.
std::string finding_text(bool is_kept, const std::string& finding, const Material& material) {
  return fmt::format("{} of `{}`", is_kept ? finding : fmt::format("**{}**", finding), material.name);
}

std::string angle_text(const Direction& at) {
  constexpr double kGrazing = 89.9;
  const double theta_deg = to_degrees(at.theta);
  const std::string theta = theta_deg > kGrazing ? "grazing" : fmt::format("{:.3g}°", theta_deg);
  return at.phi == 0 ? theta : fmt::format("{}, azimuth {:.3g}°", theta, to_degrees(at.phi));
}

/// A digit, of those above 1 all.
std::string error_text(double error) {
  constexpr double kLong = 1e4;
  return error < 1 || error >= kLong ? fmt::format("{:.1g}", error) : fmt::format("{:.0f}", error);
}

std::string albedo_text(const ModelPlausibility& model) {
  const AlbedoBound& bound = model.albedo.found.albedo;
  const std::string finding =
      bound.growth ? fmt::format("(N.L)^-{:.3f} ± {}", bound.growth->value, error_text(bound.growth->error))
                   : fmt::format("{:.5g} ± {} at {}", bound.largest.value, error_text(bound.largest.error),
                                 angle_text(bound.at));
  return finding_text(model.conserves_energy, finding, model.albedo.material);
}

std::string value_text(const ModelPlausibility& model) {
  const double least = model.least.found.least.value.value;
  if (model.is_non_negative) return fmt::format("{:.2g}", least);
  return finding_text(false, fmt::format("{:.2g}", least), model.least.material);
}

std::string reciprocity_text(const ModelPlausibility& model) {
  if (model.is_reciprocal) return "rounding";
  const double defect = model.reciprocity.found.reciprocity.relative;
  return finding_text(false, fmt::format("{:.2g}", defect), model.reciprocity.material);
}

}  // namespace

std::string plausibility_page(std::span<const ModelPlausibility> models) {
  const auto plausible = std::ranges::count_if(models, [](const ModelPlausibility& model) {
    return model.is_non_negative && model.is_reciprocal && model.conserves_energy;
  });
  std::size_t materials = 0;
  std::size_t overflowing = 0;
  for (const auto& model : models) {
    materials += model.materials;
    overflowing += model.overflowing;
  }
  std::string text = fmt::format(
      R"(# What the models of the catalogue keep

Made by `lobe check --catalogue`; a test holds the catalogue and this page against each other. Of each model stands here
the worst over materials at the ends, in the middle and at random places of its parameters' ranges, at scale 1; from an
albedo above 1 the search went on to where it is larger. Infinite ranges end at 1e6, and anisotropic lobes are at most 20
times longer than wide.

The largest albedo is that over all angles of incidence, up to an elevation of 1e-7 rad or, for narrow lobes, 1e-12;
where albedos grow towards grazing incidence without bound, the power of N.L stands there instead. The reciprocity defect
is the largest difference of f(L, V) and f(V, L), relative to the larger of both or to a thousandth of the mean value. It
and the smallest value were looked for among 1024 pairs of directions and then around the worst. A search proves nothing:
what is **bold** was seen and is what the catalogue declares not to be kept; the rest was not seen otherwise.

Of {} models {} keep everything. {} materials were looked at, {} more left out, as their albedos are no finite numbers.

| model | largest albedo | smallest value, sr^-1 | reciprocity defect |
|---|---|---|---|
)",
      models.size(), plausible, materials, overflowing);
  for (const auto& model : models) {
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} |\n", model.model, albedo_text(model),
                   value_text(model), reciprocity_text(model));
  }
  return text;
}

}  // namespace lobe
