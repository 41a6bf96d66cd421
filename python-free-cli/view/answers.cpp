#include "view/answers.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "interface/colours.hpp"
#include "interface/example_value.hpp"
#include "interface/failure.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/core/colour.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/energy/plausibility.hpp"
#include "lobe/fit/fit.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/metric/unit.hpp"
#include "lobe/model/specification.hpp"
#include "lobe/plot/preview_sheet.hpp"
#include "lobe/plot/scene_picture.hpp"
#include "lobe/reflectance/composition.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/render/preview.hpp"
#include "lobe/render/render_scene.hpp"
#include "lobe/render/shader.hpp"
#include "lobe/study/material_file.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

/// What the page draws needs no more digits; every number is told with its error.
constexpr double kDrawnTolerance = 1e-4;
constexpr std::size_t kMostShown = 6;

/// Where to start from: facets with the refractive indices of metals for red, green and blue, those of
/// examples/scenes/metals.toml, and of dielectrics.
struct Start {
  std::string_view name;
  std::string_view text;
};
constexpr std::array kStarts{Start{"aluminium", "ggx_fresnel:alpha=0.2,ior=1.35/0.96/0.6,k=7.5/6.6/5.4"},
                             Start{"copper", "ggx_fresnel:alpha=0.2,ior=0.24/1/1.16,k=3.6/2.6/2.4"},
                             Start{"gold", "ggx_fresnel:alpha=0.2,ior=0.17/0.4/1.45,k=3.2/2.4/1.9"},
                             Start{"silver", "ggx_fresnel:alpha=0.2,ior=0.06/0.06/0.04,k=4.4/3.6/2.6"},
                             Start{"crown glass", "ggx_fresnel:alpha=0.2,ior=1.52,k=0"},
                             Start{"water", "ggx_fresnel:alpha=0.2,ior=1.333,k=0"},
                             Start{"diamond", "ggx_fresnel:alpha=0.2,ior=2.42,k=0"}};
constexpr std::size_t kMostNeighbours = 8;

// Questions are JSON that anybody may have written.

[[noreturn]] void refuse(std::string_view key, std::string_view expected) {
  throw ArgumentError("'" + std::string(key) + "' in a question is not right; expected " + std::string(expected));
}

std::string text_of(const Json& asked, std::string_view key) {
  const auto found = asked.find(key);
  constexpr std::size_t kLongest = 20'000;
  if (found == asked.end() || !found->is_string()) refuse(key, "a text");
  auto text = found->get<std::string>();
  if (text.size() > kLongest) refuse(key, "a text of at most 20000 letters");
  return text;
}

double number_of(const Json& asked, std::string_view key, double otherwise, double least, double most) {
  const auto found = asked.find(key);
  if (found == asked.end()) return otherwise;
  const double value = found->is_number() ? found->get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!(value >= least && value <= most)) refuse(key, fmt::format("a number from {:g} to {:g}", least, most));
  return value;
}

/// An angle from the normal in degrees, in radians; the horizon is left out.
double theta_of(const Json& asked, std::string_view key) {
  constexpr double kMost = 89.99;
  return number_of(asked, key, 0, 0, kMost) * kDegree;
}

double azimuth_of(const Json& asked, std::string_view key) {
  return number_of(asked, key, 0, -360, 360) * kDegree;
}

Reflectance shown(Workshop& workshop, const Json& asked, std::string_view key = "material") {
  return workshop.shown.reflectance(workshop.device, text_of(asked, key));
}

/// Luminance of linear red, green and blue (IEC 61966-2-1).
Eigen::RowVector3d luminance_of_display() {
  return {0.2126, 0.7152, 0.0722};
}

/// The weight of each channel in what a curve shows: its luminance, or its share of a grey.
Eigen::VectorXd luminance_weights(const Reflectance& reflectance) {
  const DisplayColours colours = colours_of(reflectance);
  if (colours.weights.rows() == 1) return colours.weights.row(0).transpose();
  return (luminance_of_display() * colours.weights).transpose();
}

/// Channels as one; errors add up.
Estimate combined(const Eigen::VectorXd& weights, const std::function<Estimate(std::size_t)>& channel) {
  Estimate sum{0, 0};
  for (Eigen::Index c = 0; c < weights.size(); ++c) {
    const Estimate one = channel(static_cast<std::size_t>(c));
    sum.value += weights(c) * one.value;
    sum.error += std::abs(weights(c)) * one.error;
  }
  return sum;
}

Json list_json(const std::vector<Estimate>& list) {
  Json json{{"values", Json::array()}, {"errors", Json::array()}};
  for (const Estimate& one : list) {
    json["values"].push_back(to_json(one.value));
    json["errors"].push_back(to_json(one.error));
  }
  return json;
}

/// What a question asks for in part may be infinite or undefined: the reason, in place of a number.
Json or_reason(const std::function<Json()>& answer) {
  try {
    return answer();
  } catch (const Cancelled&) {
    throw;
  } catch (const DeviceError&) {
    throw;
  } catch (const Error&) {
    return {{"reason", describe_current_exception(nullptr).line}};
  }
}

Json parameters_json(const std::vector<Parameter>& parameters) {
  Json json = Json::array();
  for (const Parameter& one : parameters) {
    json.push_back({{"name", one.name},
                    {"unit", one.unit},
                    {"minimum", one.minimum},
                    {"maximum", to_json(one.maximum)},
                    {"default", one.default_value ? Json(*one.default_value) : Json()},
                    {"typical", example_value(one)},
                    {"description", one.description}});
  }
  return json;
}

Json point_json(const PointLight& point) {
  return {{"direction", point.direction}, {"irradiance", point.irradiance}};
}

Json answer_catalogue(Workshop& workshop, const Json& /*asked*/) {
  Json json{{"models", Json::array()}, {"factors", Json::array()}, {"offers", Json::array()}};
  for (const Model& model : catalogue()) {
    json["models"].push_back({{"name", model.name},
                              {"family", model.family},
                              {"formula", model.formula},
                              {"source", model.source},
                              {"parameters", parameters_json(model.parameters)}});
  }
  for (const FactorModel& factor : factors()) {
    json["factors"].push_back(
        {{"name", factor.name}, {"formula", factor.formula}, {"parameters", parameters_json(factor.parameters)}});
  }
  for (const Offer& offer : workshop.shown.offers()) json["offers"].push_back(offer_json(offer));
  json["first_shown"] = workshop.first_shown;
  json["starts"] = Json::array();
  for (const auto& [name, text] : kStarts) json["starts"].push_back({{"name", name}, {"text", text}});
  json["points"] = Json::array();
  for (const PointLight& point : three_point_lights().points) json["points"].push_back(point_json(point));
  json["scenes"] = Json::array();
  for (const ShownScene& scene : workshop.scenes.scenes()) {
    Json materials = Json::array();
    for (const SceneMaterial& one : scene.file.scene.materials) materials.push_back(one.name);
    json["scenes"].push_back({{"name", scene.name},
                              {"word", scene.word},
                              {"materials", std::move(materials)},
                              {"replaced", scene.replaced},
                              {"size", scene.file.scene.camera.size},
                              {"text", scene.text}});
  }
  json["has_given_scene"] = workshop.scenes.has_given();
  json["reference"] = {{"albedo", kReferenceAlbedo}, {"lightness", kReferenceLightness}};
  return json;
}

Json answer_material(Workshop& workshop, const Json& asked) {
  const std::string text = text_of(asked, "material");
  const auto formula = workshop.shown.formula(text);
  const Reflectance reflectance = shown(workshop, asked);
  const DisplayColours colours = colours_of(reflectance);
  Json json{{"name", workshop.shown.name(text)},
            {"word", workshop.shown.word(text)},
            {"channels", reflectance.channels()},
            {"channel_names", channel_names(reflectance)},
            {"colours", colours.text},
            {"is_isotropic", reflectance.is_isotropic()},
            {"has_delta", reflectance.has_delta()}};
  if (!formula) {
    const BrdfFunction* function = reflectance.function();
    json["format"] = function == nullptr ? "table" : function->format;
    return json;
  }
  json["formula"] = material_json(*formula);
  json["formula"]["adjustments"] = Json::array();
  for (const Adjustment& one : formula->adjustments) json["formula"]["adjustments"].push_back(to_string(one));
  json["is_specification"] = specification(*formula).has_value();
  json["toml"] = material_toml(*formula);
  return json;
}

// Spheres.

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const std::uint32_t three = static_cast<std::uint32_t>(bytes[i]) << 16 |
                                static_cast<std::uint32_t>(left > 1 ? bytes[i + 1] : 0) << 8 |
                                static_cast<std::uint32_t>(left > 2 ? bytes[i + 2] : 0);
    text += kLetters[three >> 18];
    text += kLetters[three >> 12 & 63];
    text += left > 1 ? kLetters[three >> 6 & 63] : '=';
    text += left > 2 ? kLetters[three & 63] : '=';
  }
  return text;
}

/// Lights of one colour, linear sRGB.
struct ColouredLights {
  std::array<double, 3> colour;
  SphereLighting lights;
};

std::array<double, 3> triple_of(const Json& json, std::string_view key, double least, double most) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array() || found->size() != 3) refuse(key, "three numbers");
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& one = (*found)[i];
    values[i] = one.is_number() ? one.get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!(values[i] >= least && values[i] <= most))
      refuse(key, fmt::format("three numbers from {:g} to {:g}", least, most));
  }
  return values;
}

void add_light(std::vector<ColouredLights>& groups, const std::array<double, 3>& colour,
               const std::function<void(SphereLighting&)>& put) {
  const auto found = std::ranges::find(groups, colour, &ColouredLights::colour);
  put(found != groups.end() ? found->lights : groups.emplace_back(ColouredLights{colour, {}}).lights);
}

/// {"points": [{"direction", "irradiance", "colour"}], "sky": {"radiance", "colour"}}, by their colours.
std::vector<ColouredLights> lights_of(const Json& asked) {
  constexpr double kBrightest = 1000;
  constexpr std::size_t kMostPoints = 8;
  std::vector<ColouredLights> groups;
  const auto lights = asked.find("lights");
  if (lights == asked.end() || !lights->is_object()) refuse("lights", "points and a sky");
  if (const auto points = lights->find("points"); points != lights->end()) {
    if (!points->is_array() || points->size() > kMostPoints) refuse("points", "a list of at most 8");
    for (const Json& one : *points) {
      const PointLight point{triple_of(one, "direction", -1, 1), number_of(one, "irradiance", 0, 0, kBrightest)};
      add_light(groups, triple_of(one, "colour", 0, 1), [&](SphereLighting& to) { to.points.push_back(point); });
    }
  }
  if (const auto sky = lights->find("sky"); sky != lights->end()) {
    const double radiance = number_of(*sky, "radiance", 0, 0, kBrightest);
    add_light(groups, triple_of(*sky, "colour", 0, 1), [&](SphereLighting& to) { to.sky = radiance; });
  }
  return groups;
}

/// Light of all groups, as if it were white: what exposure is chosen by, so that colours stay visible.
double exposure_of(const std::vector<ColouredLights>& groups) {
  SphereLighting all;
  for (const ColouredLights& group : groups) {
    all.points.insert(all.points.end(), group.lights.points.begin(), group.lights.points.end());
    all.sky += group.lights.sky;
  }
  return reference_exposure(all);
}

/// The light of a sphere's pixels, linear sRGB, under lights of several colours.
SphereImage coloured_sphere(const Workshop& workshop, const Reflectance& reflectance,
                            const std::vector<ColouredLights>& groups, const SphereOptions& options) {
  SphereImage sum;
  for (const ColouredLights& group : groups) {
    const SphereImage one = render_sphere(workshop.device, reflectance, group.lights, options);
    const Eigen::Map<const Eigen::Array3d> colour(group.colour.data());
    const auto as_colours = [&](const Eigen::MatrixXd& values) -> Eigen::MatrixXd {
      const Eigen::MatrixXd all = values.rows() == 3 ? values : values.replicate(3, 1);
      return all.array().colwise() * colour;
    };
    if (sum.size == 0) {
      sum = one;
      sum.radiance = as_colours(one.radiance);
      sum.error = as_colours(one.error);
    } else {
      sum.radiance += as_colours(one.radiance);
      sum.error += as_colours(one.error);
    }
  }
  return sum;
}

/// A whole number; the least where there is none.
std::size_t whole_of(const Json& asked, std::string_view key, std::size_t least, std::size_t most) {
  const auto lowest = static_cast<double>(least);
  const double value = number_of(asked, key, lowest, lowest, static_cast<double>(most));
  if (value != std::floor(value)) refuse(key, "a whole number");
  return static_cast<std::size_t>(value);
}

/// A scene with the material in place of one of its own, as it is so far: what is asked for again has more samples, as
/// many as a moment gives, until it has those that are wanted.
Json answer_scene(Workshop& workshop, const Json& asked) {
  constexpr std::chrono::milliseconds kMoment{100};
  constexpr std::size_t kMostSamples = 4096;
  constexpr std::size_t kWidest = 512;
  const auto& scenes = workshop.scenes.scenes();
  const ShownScene& shown_scene = scenes[whole_of(asked, "scene", 0, scenes.size() - 1)];
  const Scene& scene = shown_scene.file.scene;
  const std::size_t replaced = whole_of(asked, "replaced", 0, scene.materials.size() - 1);
  const std::size_t samples = whole_of(asked, "samples", 2, kMostSamples);
  const std::size_t width = whole_of(asked, "width", 1, kWidest);
  const Json key{&shown_scene - scenes.data(), replaced, text_of(asked, "material"), width};
  SceneRendering& rendering = workshop.scenes.rendering(key.dump(), [&] {
    Scene changed = scene;
    changed.camera = with_width(changed.camera, width);
    changed.materials[replaced].reflectance = shown(workshop, asked);
    return SceneRendering(workshop.device, std::move(changed),
                          {.proposal = shown_scene.file.strategy, .progress = workshop.progress});
  });
  const auto begin = std::chrono::steady_clock::now();
  const auto is_wanted = [&] {
    if (rendering.samples() < 2) return true;
    return rendering.samples() < samples && std::chrono::steady_clock::now() - begin < kMoment;
  };
  while (is_wanted()) {
    if (!workshop.progress("scene", 0)) throw Cancelled("nobody waits for the scene");
    rendering.refine(1);
  }
  const SceneImage image = rendering.image();
  const double exposure = shown_scene.file.exposure ? *shown_scene.file.exposure : scene_exposure(image);
  const std::string png = scene_png(image, exposure);
  Json json{{"png", base64({png.begin(), png.end()})},
            {"width", image.size[0]},
            {"height", image.size[1]},
            {"samples", image.samples},
            {"noise", to_json(image.relative_noise())},
            {"exposure", exposure},
            {"mean_radiance", Json::array()}};
  const auto means = image.mean_radiance();
  for (const Estimate& mean : means) json["mean_radiance"].push_back(to_json(mean));
  json["mean_luminance"] =
      to_json(combined(luminance_of_display().transpose(), [&](std::size_t c) { return means.at(c); }));
  return json;
}

/// The factor on radiances with which spheres under these lights are shown.
Json answer_exposure(Workshop& /*workshop*/, const Json& asked) {
  return {{"exposure", exposure_of(lights_of(asked))}};
}

Json answer_sphere(Workshop& workshop, const Json& asked) {
  constexpr double kSmallest = 16;
  constexpr double kLargest = 512;
  const auto groups = lights_of(asked);
  const Reflectance reflectance = shown(workshop, asked);
  const DisplayColours colours = colours_of(reflectance);
  const double exposure = exposure_of(groups);
  SphereOptions options;
  options.size = static_cast<std::size_t>(number_of(asked, "size", 160, kSmallest, kLargest));
  options.weights = colours.weights;
  options.white = 1 / exposure;
  options.progress = workshop.progress;
  const DisplayedSphere sphere = display(coloured_sphere(workshop, reflectance, groups, options), exposure);
  return {{"size", sphere.size},       {"rgb", base64(sphere.rgb)},   {"pixels", sphere.pixels},
          {"clipped", sphere.clipped}, {"negative", sphere.negative}, {"largest_error", to_json(sphere.largest_error)},
          {"exposure", exposure},      {"colours", colours.text}};
}

/// A formula as a function for shaders, by which a browser draws its sphere. A reason where there is no such function.
Json answer_shader(Workshop& workshop, const Json& asked) {
  const Reflectance reflectance = shown(workshop, asked);
  const Material* const material = reflectance.formula();
  if (material == nullptr) return {{"reason", "it is no formula"}};
  return or_reason([&]() -> Json {
    ShaderOptions options;
    options.weights = colours_of(reflectance).weights;
    options.has_uniforms = true;
    const Shader shader = glsl_shader(*material, options);
    return {{"text", shader.text},
            {"constants", shader.constants},
            {"weights", shader.weights},
            {"is_isotropic", reflectance.is_isotropic()}};
  });
}

/// A texture of values and the function that looks them up, for tables, files and pumped materials.
Json answer_texture(Workshop& workshop, const Json& asked) {
  const Reflectance reflectance = shown(workshop, asked);
  return or_reason([&]() -> Json {
    ShaderOptions options;
    options.weights = colours_of(reflectance).weights;
    options.progress = workshop.progress;
    const TexturedShader shader = textured_shader(workshop.device, reflectance, options);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(2 * shader.texels.size());
    for (const std::uint16_t number : shader.texels) {
      bytes.push_back(static_cast<std::uint8_t>(number & 0xffU));
      bytes.push_back(static_cast<std::uint8_t>(number >> 8U));
    }
    return {{"text", shader.text},
            {"size", shader.size},
            {"texels", base64(bytes)},
            {"is_isotropic", reflectance.is_isotropic()}};
  });
}

/// The colours of a material under daylight by the viewer's angle in degrees and, if it is anisotropic, azimuth; a
/// browser draws by them.
Json answer_sky(Workshop& workshop, const Json& asked) {
  constexpr std::array kAngles{0.,  5.,  10., 15., 20., 25., 30., 35., 40.,  45., 50.,
                               55., 60., 65., 70., 75., 80., 83., 86., 87.5, 89.};
  constexpr std::array kAnglesOfTurns{0., 15., 25., 35., 45., 52., 60., 66., 72., 77., 82., 86., 89.};
  constexpr std::size_t kAzimuths = 24;
  const Reflectance reflectance = shown(workshop, asked);
  const bool is_isotropic = reflectance.is_isotropic();
  const std::span<const double> angles = is_isotropic ? std::span<const double>(kAngles) : kAnglesOfTurns;
  const std::size_t azimuths = is_isotropic ? 1 : kAzimuths;
  std::vector<Direction> viewers;
  for (const double angle : angles) {
    for (std::size_t k = 0; k < azimuths; ++k) {
      viewers.push_back(
          {angle * kDegree, 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(azimuths)});
    }
  }
  SphereOptions options;
  options.weights = colours_of(reflectance).weights;
  options.progress = workshop.progress;
  const Eigen::MatrixXd values = sky_radiance(workshop.device, reflectance, viewers, options).value;
  Json json{{"angles", std::vector<double>(angles.begin(), angles.end())},
            {"azimuths", azimuths},
            {"colours", Json::array()}};
  for (const auto& row : values.rowwise()) {
    Json& one = json["colours"].emplace_back(Json::array());
    for (const double value : row) one.push_back(to_json(value));
  }
  return json;
}

// Curves.

/// Angles of view in the plane of incidence, degrees, below 0 on the side of the light: every degree, and dense about
/// the mirror and the retro direction.
std::vector<double> plane_angles(double theta_in) {
  constexpr double kLast = 89.5;
  const double centre = to_degrees(theta_in);
  std::vector<double> angles{-kLast, kLast};
  for (int i = -89; i <= 89; ++i) angles.push_back(i);
  for (const double side : {-centre, centre}) {
    angles.push_back(side);
    for (double step = 1.0 / 64; step < 6; step *= std::numbers::sqrt2) {
      for (const double one : {side - step, side + step}) {
        if (std::abs(one) < kLast) angles.push_back(one);
      }
    }
  }
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

std::vector<Directions> plane_pairs(const std::vector<double>& angles, double theta_in, double phi_in) {
  std::vector<Directions> pairs;
  for (const double angle : angles) {
    pairs.push_back({.theta_in = theta_in,
                     .theta_out = std::abs(angle) * kDegree,
                     .delta_phi = angle < 0 ? 0 : std::numbers::pi,
                     .phi_in = phi_in});
  }
  return pairs;
}

std::vector<Estimate> luminances(const Reflectance& reflectance, const std::vector<std::vector<Estimate>>& channels,
                                 std::size_t count) {
  const Eigen::VectorXd weights = luminance_weights(reflectance);
  std::vector<Estimate> list;
  for (std::size_t i = 0; i < count; ++i) {
    list.push_back(combined(weights, [&](std::size_t c) { return channels[c][i]; }));
  }
  return list;
}

/// Luminances that are drawn without their errors.
Json values_json(const Device& device, const Reflectance& reflectance, const std::vector<Directions>& pairs) {
  Json values = Json::array();
  for (const Estimate& one : luminances(reflectance, estimates(evaluate(device, reflectance, pairs)), pairs.size())) {
    values.push_back(to_json(one.value));
  }
  return {{"values", std::move(values)}};
}

Json plane_json(const Device& device, const Reflectance& reflectance, const Json& asked) {
  const double theta_in = theta_of(asked, "theta_in");
  const auto angles = plane_angles(theta_in);
  const auto pairs = plane_pairs(angles, theta_in, azimuth_of(asked, "phi_in"));
  Json json = list_json(luminances(reflectance, estimates(evaluate(device, reflectance, pairs)), pairs.size()));
  json["theta_out"] = angles;
  return json;
}

Json answer_plane(Workshop& workshop, const Json& asked) {
  return plane_json(workshop.device, shown(workshop, asked), asked);
}

/// Samples of a file that lie near the plane of incidence, at about this angle of light or, by reciprocity, of view.
Json answer_samples(Workshop& workshop, const Json& asked) {
  constexpr double kNear = 1.5 * kDegree;  // of the angle of light, and of the plane
  constexpr std::size_t kMost = 2000;
  const Reflectance reflectance = shown(workshop, asked);
  Json json{{"near_deg", to_degrees(kNear)}, {"samples", Json::array()}};
  const BrdfFunction* const function = reflectance.function();
  if (function == nullptr || function->samples == nullptr) return json;
  const MeasuredSamples& all = *function->samples;
  const Eigen::VectorXd weights = luminance_weights(reflectance);
  const double theta_in = theta_of(asked, "theta_in");
  const double phi_in = azimuth_of(asked, "phi_in");
  const auto turned = [](double angle) { return std::abs(std::remainder(angle, 2 * std::numbers::pi)); };
  const auto add = [&](std::size_t row, const Directions& pair) {
    // Near the normal azimuths mean little: the distance from the plane counts.
    const auto off_plane = [&](double theta, double azimuth) { return std::sin(theta) * std::abs(std::sin(azimuth)); };
    if (std::abs(pair.theta_in - theta_in) > kNear || json["samples"].size() >= kMost) return;
    if (off_plane(pair.theta_out, pair.delta_phi) > kNear) return;
    if (!function->is_isotropic && std::sin(pair.theta_in) * turned(pair.phi_in - phi_in) > kNear) return;
    const auto at = static_cast<Eigen::Index>(row);
    const double side = std::cos(pair.delta_phi) > 0 ? -1 : 1;
    Json one{{"theta_out", side * to_degrees(pair.theta_out)}, {"value", to_json(all.values.row(at).dot(weights))}};
    if (all.deviations.size() > 0) {
      one["deviation"] = to_json(std::sqrt(all.deviations.row(at).cwiseAbs2().dot(weights.cwiseAbs2())));
    }
    json["samples"].push_back(std::move(one));
  };
  for (std::size_t row = 0; row < all.pairs.size(); ++row) {
    const Directions& pair = all.pairs[row];
    add(row, pair);
    // A sample at both angles is one.
    if (std::abs(pair.theta_out - theta_in) <= kNear && std::abs(pair.theta_in - theta_in) <= kNear) continue;
    add(row, {pair.theta_out, pair.theta_in, -pair.delta_phi, pair.phi_in + pair.delta_phi});
  }
  return json;
}

/// L and V by half-vector and difference (Rusinkiewicz 1998) with phi_d = 90 degrees, where both are above the horizon.
Directions half_difference_pair(double theta_h, double theta_d) {
  const double along = std::cos(theta_d) * std::sin(theta_h);
  const double across = std::sin(theta_d);
  const double theta = std::acos(std::cos(theta_d) * std::cos(theta_h));
  const double phi_in = std::atan2(across, along);
  return {.theta_in = theta, .theta_out = theta, .delta_phi = -2 * phi_in, .phi_in = phi_in};
}

/// The slice phi_d = 90 degrees in rows of theta_d from 0 to 90 degrees, theta_h along them as its square root, as
/// MERL's files have it.
Json answer_slice(Workshop& workshop, const Json& asked) {
  constexpr std::size_t kNodes = 64;
  constexpr double kRight = std::numbers::pi / 2;
  const Reflectance reflectance = shown(workshop, asked);
  std::vector<Directions> pairs;
  for (std::size_t row = 0; row < kNodes; ++row) {
    for (std::size_t column = 0; column < kNodes; ++column) {
      const double along = (static_cast<double>(column) + 0.5) / kNodes;
      const double across = (static_cast<double>(row) + 0.5) / kNodes;
      pairs.push_back(half_difference_pair(along * along * kRight, across * kRight));
    }
  }
  Json json = values_json(workshop.device, reflectance, pairs);
  json["nodes"] = kNodes;
  return json;
}

/// Values over the whole hemisphere of view for one direction of light, in rows of equal theta_out.
Json answer_lobe(Workshop& workshop, const Json& asked) {
  constexpr int kRings = 31;
  constexpr int kSectors = 72;
  constexpr double kLast = 89.5;  // degrees
  const Reflectance reflectance = shown(workshop, asked);
  const double theta_in = theta_of(asked, "theta_in");
  const double phi_in = azimuth_of(asked, "phi_in");
  std::vector<double> rings;
  std::vector<double> sectors;
  for (int i = 0; i < kRings; ++i) rings.push_back(kLast * i / (kRings - 1));
  for (int j = 0; j < kSectors; ++j) sectors.push_back(360.0 * j / kSectors);
  std::vector<Directions> pairs;
  for (const double theta : rings) {
    for (const double delta : sectors) {
      pairs.push_back(
          {.theta_in = theta_in, .theta_out = theta * kDegree, .delta_phi = delta * kDegree, .phi_in = phi_in});
    }
  }
  Json json = values_json(workshop.device, reflectance, pairs);
  json["theta_out"] = rings;
  json["delta_phi"] = sectors;
  return json;
}

Json answer_value(Workshop& workshop, const Json& asked) {
  const Reflectance reflectance = shown(workshop, asked);
  const Directions pair{.theta_in = theta_of(asked, "theta_in"),
                        .theta_out = theta_of(asked, "theta_out"),
                        .delta_phi = azimuth_of(asked, "delta_phi"),
                        .phi_in = azimuth_of(asked, "phi_in")};
  const auto channels = estimates(evaluate(workshop.device, reflectance, std::span(&pair, 1)));
  Json json{{"channels", Json::array()}};
  for (const auto& channel : channels) json["channels"].push_back(to_json(channel.front()));
  return json;
}

Json answer_albedos(Workshop& workshop, const Json& asked) {
  constexpr std::array kAngles{0.,  5.,  10., 15., 20., 25., 30., 35., 40.,  45., 50.,
                               55., 60., 65., 70., 75., 80., 83., 86., 87.5, 89.};
  const Reflectance reflectance = shown(workshop, asked);
  std::vector<Direction> incident;
  for (const double angle : kAngles) incident.push_back({angle * kDegree, azimuth_of(asked, "phi_in")});
  AlbedoOptions options;
  options.tolerance = kDrawnTolerance;
  const auto channels = albedo(workshop.device, reflectance, incident, options);
  Json json = list_json(luminances(reflectance, channels, incident.size()));
  json["theta_in"] = kAngles;
  return json;
}

/// C_{a,b} and C_{b,a} in the plane of incidence.
Json answer_composition(Workshop& workshop, const Json& asked) {
  constexpr std::size_t kPairsAtOnce = 16;  // computed together, and between two looks at whether somebody waits
  const Reflectance a = shown(workshop, asked, "a");
  const Reflectance b = shown(workshop, asked, "b");
  const double theta_in = theta_of(asked, "theta_in");
  std::vector<double> angles;
  for (double angle = -87; angle <= 87; angle += 3) angles.push_back(angle);
  const auto pairs = plane_pairs(angles, theta_in, azimuth_of(asked, "phi_in"));
  PointwiseOptions options;
  options.tolerance = 1e-2;  // the error is mostly a thousandth of what is stated
  Json json{{"theta_out", angles}};
  for (const auto& [key, first, second] : {std::tuple("ab", &a, &b), std::tuple("ba", &b, &a)}) {
    json[key] = or_reason([&, f = first, g = second] {
      std::vector<Estimate> list;
      const Reflectance& wider = f->channels() > 1 ? *f : *g;
      const Eigen::VectorXd weights = luminance_weights(wider);
      for (std::size_t begin = 0; begin < pairs.size(); begin += kPairsAtOnce) {
        if (!workshop.progress("composition", 0)) throw Cancelled("nobody waits for the composition");
        const std::size_t count = std::min(kPairsAtOnce, pairs.size() - begin);
        const auto channels = composition_at(workshop.device, *f, *g, std::span(pairs).subspan(begin, count), options);
        for (std::size_t i = 0; i < count; ++i) {
          list.push_back(combined(weights, [&](std::size_t c) { return channels[c][i]; }));
        }
      }
      return list_json(list);
    });
  }
  return json;
}

// Numbers.

Json direction_json(const Direction& at) {
  return {{"theta_deg", to_degrees(at.theta)}, {"phi_deg", to_degrees(at.phi)}};
}

/// The verdict of `lobe check`, by the same options.
Json answer_check(Workshop& workshop, const Json& asked) {
  const Plausibility found = check_plausibility(workshop.device, shown(workshop, asked));
  Json json{{"is_plausible", found.is_plausible()}, {"channels", Json::array()}};
  for (const ChannelPlausibility& one : found.channels) {
    Json channel{{"is_non_negative", one.is_non_negative},
                 {"is_reciprocal", one.is_reciprocal},
                 {"conserves_energy", one.conserves_energy},
                 {"largest_albedo", to_json(one.albedo.largest)},
                 {"largest_albedo_at", direction_json(one.albedo.at)},
                 {"reciprocity_defect", to_json(one.reciprocity.relative)},
                 {"least_value", to_json(one.least.value)}};
    if (one.albedo.growth) channel["growth"] = to_json(*one.albedo.growth);
    if (one.mean_albedo) channel["mean_albedo"] = to_json(*one.mean_albedo);
    json["channels"].push_back(std::move(channel));
  }
  return json;
}

MetricOptions metric_options(const Workshop& workshop) {
  MetricOptions options;
  options.tolerance = kDrawnTolerance;
  options.patch_tolerance = 10 * kDrawnTolerance;
  options.progress = workshop.progress;
  return options;
}

/// Distance and angle of every pair of the materials shown, under one lighting.
Json answer_distances(Workshop& workshop, const Json& asked) {
  const auto texts = asked.find("materials");
  if (texts == asked.end() || !texts->is_array() || texts->size() < 2 || texts->size() > kMostShown) {
    refuse("materials", "two to six of them");
  }
  const Lighting lighting = parse_lighting(text_of(asked, "lighting"));
  MetricOptions options = metric_options(workshop);
  options.theta_max = number_of(asked, "theta_max", 90, 1, 90) * kDegree;
  std::vector<Reflectance> all;
  for (std::size_t i = 0; i < texts->size(); ++i) all.push_back(shown(workshop, {{"material", (*texts)[i]}}));
  Json json{{"unit", norm_unit(lighting, UnitStyle::printed)},
            {"definition", lighting.definition()},
            {"pairs", Json::array()}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      // Where one material changes, the pairs of the others stay.
      const Json question{"pair", (*texts)[i], (*texts)[j], lighting.name(), options.theta_max};
      Json pair = workshop.kept.get(question.dump(), [&]() -> Json {
        return or_reason([&]() -> Json {
          MetricOptions own = options;
          own.allow_infinite = have_equal_deltas(workshop.device, all[i], all[j]);
          const MetricResult result = measure(workshop.device, {all[i], all[j]}, lighting, own);
          return {{"distance", to_json({result.combined.distance(0, 1), result.combined.distance_error(0, 1)})},
                  {"norms", Json::array({to_json({result.combined.norm(0), result.combined.norm_error(0)}),
                                         to_json({result.combined.norm(1), result.combined.norm_error(1)})})},
                  {"angle_deg", to_json({to_degrees(angle(result.combined, 0, 1).value),
                                         to_degrees(angle(result.combined, 0, 1).error)})}};
        });
      });
      pair["first"] = i;
      pair["second"] = j;
      json["pairs"].push_back(std::move(pair));
    }
  }
  return json;
}

/// The offers that are nearest to a material under a lighting.
Json answer_nearest(Workshop& workshop, const Json& asked) {
  struct Neighbour {
    const Offer* offer;
    Estimate distance;
  };
  const Reflectance material = shown(workshop, asked);
  const Lighting lighting = parse_lighting(text_of(asked, "lighting"));
  const auto& offers = workshop.shown.offers();
  std::vector<Neighbour> found;
  std::size_t refused = 0;
  for (std::size_t i = 0; i < offers.size(); ++i) {
    if (!workshop.progress("nearest", static_cast<double>(i) / static_cast<double>(offers.size()))) {
      throw Cancelled("nobody waits for the nearest");
    }
    MetricOptions options = metric_options(workshop);
    options.tolerance = 1e-3;
    options.progress = [&](std::string_view, double share) {
      return workshop.progress("nearest", (static_cast<double>(i) + share) / static_cast<double>(offers.size()));
    };
    const Json answer = or_reason([&]() -> Json {
      const Reflectance other = workshop.shown.reflectance(workshop.device, offers[i].text);
      found.push_back({&offers[i], distance(workshop.device, material, other, lighting, options)});
      return {};
    });
    if (answer.contains("reason")) ++refused;
  }
  std::ranges::sort(found, {}, [](const Neighbour& one) { return one.distance.value; });
  Json json{{"unit", norm_unit(lighting, UnitStyle::printed)},
            {"compared", found.size()},
            {"refused", refused},
            {"nearest", Json::array()}};
  for (std::size_t i = 0; i < std::min(found.size(), kMostNeighbours); ++i) {
    json["nearest"].push_back(
        {{"text", found[i].offer->text}, {"name", found[i].offer->name}, {"distance", to_json(found[i].distance)}});
  }
  return json;
}

/// The bytes of a table of the material, on the grid that `lobe tabulate` takes, or on one of 24 rings where every pair
/// of nodes has a value of its own.
Json answer_table(Workshop& workshop, const Json& asked) {
  const Reflectance reflectance = shown(workshop, asked);
  constexpr std::size_t kRings = 24;
  const HemisphereGrid grid =
      reflectance.is_isotropic() ? natural_grid(reflectance) : HemisphereGrid::gauss(kRings, 2 * kRings);
  TabulateOptions options;
  options.progress = workshop.progress;
  const fs::path path = workshop.shown.folder() / "saved.h5";
  save(tabulate(workshop.device, reflectance, grid, options), path, {.overwrite = true});
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::error_code ignored;
  fs::remove(path, ignored);
  return {{"grid", grid.name()}, {"bytes", base64(bytes)}};
}

/// The best member of a family for what is shown.
Json answer_fit(Workshop& workshop, const Json& asked) {
  const Family family = parse_family(text_of(asked, "family"));
  FitOptions options;
  options.searches = 1;
  options.tolerance = 1e-3;
  options.progress = workshop.progress;
  // While the fit is made no other question is answered: what shows its best member comes with it.
  options.watch = [&](const Material& member, double residual) {
    Json best{{"material", member.name}, {"residual", residual}};
    best["plane"] = or_reason([&] { return plane_json(workshop.device, Reflectance(member), asked); });
    if (!best["plane"].contains("reason")) workshop.tell_best(std::move(best));
  };
  const FitResult result = fit(workshop.device, shown(workshop, asked), family, options);
  Json json{{"material", specification(result.material).value_or("")},
            {"relative_residual", to_json(result.relative_residual)},
            {"has_converged", result.converged}};
  return json;
}

}  // namespace

Json offer_json(const Offer& offer) {
  return {{"text", offer.text}, {"name", offer.name}, {"is_formula", offer.operand.is_formula()}};
}

Json answer(Workshop& workshop, const QuestionKind& kind, const Json& asked) {
  if (!kind.is_kept) return kind.answer(workshop, asked);
  Json question = asked;
  for (const char* others : {"kind", "slot", "number"}) question.erase(others);
  return workshop.kept.get(std::string(kind.name) + " " + question.dump(),
                           [&] { return kind.answer(workshop, asked); });
}

std::span<const QuestionKind> question_kinds() {
  static constexpr std::array kKinds{
      QuestionKind{"catalogue", 0, answer_catalogue},   QuestionKind{"material", 0, answer_material},
      QuestionKind{"value", 0, answer_value},           QuestionKind{"shader", 0, answer_shader},
      QuestionKind{"texture", 3, answer_texture, true}, QuestionKind{"sky", 2, answer_sky, true},
      QuestionKind{"exposure", 0, answer_exposure},     QuestionKind{"plane", 1, answer_plane, true},
      QuestionKind{"slice", 2, answer_slice, true},     QuestionKind{"samples", 2, answer_samples, true},
      QuestionKind{"lobe", 1, answer_lobe, true},       QuestionKind{"sphere", 2, answer_sphere, true},
      QuestionKind{"albedos", 2, answer_albedos, true}, QuestionKind{"distances", 4, answer_distances},
      QuestionKind{"check", 3, answer_check, true},     QuestionKind{"composition", 5, answer_composition, true},
      QuestionKind{"scene", 7, answer_scene},           QuestionKind{"nearest", 6, answer_nearest},
      QuestionKind{"table", 6, answer_table},           QuestionKind{"fit", 6, answer_fit}};
  return kKinds;
}

}  // namespace lobe::cli
