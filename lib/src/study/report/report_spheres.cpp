#include <string>

#include "lobe/core/colour.hpp"
#include "lobe/core/error.hpp"
#include "lobe/render/preview.hpp"
#include "lobe/study/report_page.hpp"

namespace lobe {
namespace {

constexpr double kSphereTolerance = 1.0 / 256;  // of white: a level of the display

/// Colours of a study's channels; three channels are red, green and blue unless their names say otherwise.
DisplayColours sphere_colours(const Study& study, std::size_t channels) {
  if (channels == study.channels.size()) return display_colours(study.channels, {});
  std::vector<std::string> numbers;
  for (std::size_t c = 1; c <= channels; ++c) numbers.push_back(std::to_string(c));
  return display_colours(numbers, {});
}

}  // namespace

ReportSpheres report_spheres(const Device& device, const StudyResult& result, const ProgressCallback& progress) {
  const Study& study = result.study;
  ReportSpheres spheres;
  if (study.materials.size() > kMostReportSpheres) return spheres;
  const SphereLighting lights = three_point_lights();
  const double exposure = reference_exposure(lights);
  SphereOptions options{.size = kReportSphereSize, .white = 1 / exposure, .tolerance = kSphereTolerance};
  for (const StudyMaterial& material : study.materials) {
    auto& sphere = spheres.emplace_back();
    const Material* formula = material.formula();
    if (formula == nullptr) continue;
    const double done = static_cast<double>(spheres.size() - 1) / static_cast<double>(study.materials.size());
    options.progress = [&](std::string_view, double) { return !progress || progress("spheres", done); };
    options.weights = sphere_colours(study, formula->channels()).weights;
    try {
      sphere = display(render_sphere(device, *formula, lights, options), exposure);
    } catch (const NumericError&) {
      // Lobes much narrower than a pixel: the material has no sphere.
    }
  }
  return spheres;
}

}  // namespace lobe
