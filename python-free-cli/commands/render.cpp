#include "lobe/render/render_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "core/text.hpp"
#include "interface/operand.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/session.hpp"
#include "interface/table_report.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/file_set.hpp"
#include "lobe/plot/scene_picture.hpp"
#include "lobe/study/scene_file.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

constexpr Text kScene{"SCENE"};
constexpr Flag kCompare{"compare-sampling"};
constexpr Number kExposure{"exposure"};
constexpr Flag kLive{"live"};
constexpr Number kNoise{"noise"};
constexpr Text kDrawPatches{"patches"};
constexpr Texts kReplace{"replace"};
constexpr Count kSceneSeed{"seed"};
constexpr Text kStrategy{"strategy"};
constexpr Number kTime{"time"};
constexpr Count kWidth{"width"};

constexpr unsigned kMostPixels = 8192;
constexpr unsigned kMostSceneSamples = 1'000'000;
constexpr unsigned kLargestSeed = 4'294'967'295;

/// A number that has to be above 0; `otherwise` where it is not given.
double amount(const Arguments& arguments, const Number& handle, double otherwise) {
  if (!arguments.has(handle)) return otherwise;
  const double value = arguments.number(handle);
  if (!(value > 0)) {
    throw ArgumentError(fmt::format("{} {} is out of range; expected a number above 0", handle.dashed(), value));
  }
  return value;
}

std::string_view name_of(SamplingStrategy strategy) {
  return strategy == SamplingStrategy::cosine ? "cosine" : "importance";
}

/// "NAME=MATERIAL", another reflectance for a material of the scene.
void replace_material(Scene& scene, const std::string& text) {
  const std::size_t mark = text.find('=');
  if (mark == std::string::npos || mark == 0) {
    throw ArgumentError(fmt::format("{} '{}' names no material of the scene; expected NAME=MATERIAL", kReplace.dashed(),
                                    excerpt(text)));
  }
  const std::string name = text.substr(0, mark);
  const auto found = std::ranges::find(scene.materials, name, &SceneMaterial::name);
  if (found == scene.materials.end()) {
    std::vector<std::string_view> names;
    for (const SceneMaterial& material : scene.materials) names.push_back(material.name);
    throw ArgumentError("the scene has no material '" + excerpt(name) + "'" + did_you_mean(name, names));
  }
  found->reflectance = Operand(text.substr(mark + 1)).reflectance();
}

/// The scene, and how the command line changes it.
SceneFile scene_of(const Arguments& arguments) {
  SceneFile file = load_scene(arguments.text(kScene));
  for (const std::string& text : arguments.texts(kReplace)) replace_material(file.scene, text);
  if (arguments.has(option::samples)) file.samples = arguments.count(option::samples, kMostSceneSamples);
  if (arguments.has(kStrategy)) {
    file.strategy = arguments.text(kStrategy) == "cosine" ? SamplingStrategy::cosine : SamplingStrategy::tailored;
  }
  if (arguments.has(kExposure)) file.exposure = amount(arguments, kExposure, 1);
  if (arguments.has(kWidth)) {
    file.scene.camera = with_width(file.scene.camera, arguments.count(kWidth, kMostPixels));
  }
  return file;
}

SceneOptions options_of(Session& session, const SceneFile& file) {
  const auto& arguments = session.arguments();
  SceneOptions options{.samples = file.samples,
                       .noise = amount(arguments, kNoise, 0),
                       .seconds = amount(arguments, kTime, 0),
                       .proposal = file.strategy};
  if (arguments.has(kSceneSeed)) options.seed = arguments.count(kSceneSeed, kLargestSeed);
  if (arguments.text(kDrawPatches) == "rejection") options.patches = PatchDraw::rejection;
  if (arguments.text(kDrawPatches) == "roulette") options.patches = PatchDraw::roulette;
  options.precision = session.precision();
  return options;
}

/// The files of a picture, .png and .exr.
class PictureFiles {
 public:
  explicit PictureFiles(const Session& session) : output_(session) {
    if (!output_.is_wanted()) throw ArgumentError("nothing to write; give a picture by --output FILE.png");
    if (picture().extension() != ".png") {
      throw ArgumentError(picture().string() + " is no name of a picture; expected one that ends with .png");
    }
    std::error_code ignored;
    if (fs::exists(radiances(), ignored) && !output_.overwrites()) {
      throw IoError(radiances().string() + " exists; use --force to replace it, or give another --output");
    }
  }

  [[nodiscard]] const fs::path& picture() const { return output_.path(); }
  [[nodiscard]] fs::path radiances() const { return fs::path(picture()).replace_extension(".exr"); }

  void write(const SceneImage& image, double exposure) {
    if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
    const fs::path folder = picture().has_parent_path() ? picture().parent_path() : fs::path(".");
    FileSet files(folder, picture().stem().string() + ".scene", is_written_ || output_.overwrites());
    files.write(picture().filename().string(), scene_png(image, exposure));
    files.write(radiances().filename().string(), scene_exr(image));
    files.keep();
    is_written_ = true;
  }

 private:
  OutputFile output_;
  bool is_written_ = false;  ///< by this command, which may replace what it wrote
};

double exposure_of(const SceneFile& file, const SceneImage& image) {
  return file.exposure ? *file.exposure : scene_exposure(image);
}

Json picture_json(const SceneFile& file, const SceneOptions& options, const SceneImage& image) {
  Json answer;
  answer["title"] = file.scene.title;
  answer["width"] = image.size[0];
  answer["height"] = image.size[1];
  answer["samples"] = image.samples;
  answer["seconds"] = image.seconds;
  answer["strategy"] = name_of(options.proposal);
  answer["seed"] = options.seed;
  answer["bounces"] = file.scene.bounces;
  answer["exposure"] = exposure_of(file, image);
  answer["mean_radiance"] = Json::array();
  for (const Estimate& mean : image.mean_radiance()) answer["mean_radiance"].push_back(to_json(mean));
  answer["mean_variance"] = Json::array();
  const Eigen::Vector3d variance = image.variance_of_mean().rowwise().mean();
  for (const double value : variance) answer["mean_variance"].push_back(to_json(value));
  answer["relative_noise"] = to_json(image.relative_noise());
  return answer;
}

ExitCode draw_picture(Session& session, const SceneFile& file) {
  PictureFiles files(session);
  SceneOptions options = options_of(session, file);
  options.progress = session.progress();
  if (session.arguments().has(kLive)) {
    options.refined = [&, next = std::size_t{1}](const SceneImage& image) mutable {
      if (image.samples < next || image.samples == options.samples) return;
      files.write(image, exposure_of(file, image));
      next = 2 * image.samples;
    };
  }
  const auto device = session.choose_device();
  const SceneImage image = render_scene(device, file.scene, options);
  session.end_progress();
  files.write(image, exposure_of(file, image));
  if (session.wants_json()) {
    Json answer = json_answer("render");
    answer["scene"] = session.arguments().text(kScene);
    answer["picture"] = files.picture().lexically_normal().string();
    answer["radiances"] = files.radiances().lexically_normal().string();
    answer.update(picture_json(file, options, image));
    answer["device"] = to_json(device.info());
    session.print_json(answer);
    return ExitCode::success;
  }
  const auto means = image.mean_radiance();
  session.print(fmt::format("{} and {}: {} x {} pixels, {} samples each, by {}\n", files.picture().string(),
                            files.radiances().string(), image.size[0], image.size[1], image.samples,
                            name_of(options.proposal)));
  session.print(fmt::format("mean radiance {}, {}, {}; noise {:.2g} % of it; {:.3g} s\n", format_estimate(means[0]),
                            format_estimate(means[1]), format_estimate(means[2]), 100 * image.relative_noise(),
                            image.seconds));
  return ExitCode::success;
}

/// A ratio, which 0 / 0 is not.
std::string ratio_text(const Estimate& ratio) {
  return std::isnan(ratio.value) ? "undefined" : format_estimate(ratio);
}

Json ratio_json(const Estimate& ratio) {
  return std::isnan(ratio.value) ? Json() : to_json(ratio);
}

Json contest_json(const SamplingContest& contest) {
  Json json{{"material", contest.material}, {"pixels", contest.pixels}};
  constexpr std::array kNames{"cosine", "importance"};
  for (std::size_t s = 0; s < kNames.size(); ++s) {
    json[kNames.at(s)] = {{"variance", to_json(contest.variance.at(s))},
                          {"radiance", to_json(contest.radiance.at(s))},
                          {"seconds_per_sample", contest.seconds.at(s)}};
  }
  json["equal_samples"] = ratio_json(contest.equal_samples);
  json["equal_time"] = ratio_json(contest.equal_time);
  return json;
}

ExitCode compare_strategies(Session& session, const SceneFile& file) {
  const auto& arguments = session.arguments();
  if (!file.comparison) {
    throw ArgumentError(arguments.text(kScene) + " has no [comparison]; expected one with 'material' and 'with'");
  }
  if (arguments.has(option::output)) throw ArgumentError("--compare-sampling draws no picture; leave out --output");
  SceneOptions options = options_of(session, file);
  options.progress = session.progress();
  const auto device = session.choose_device();
  const auto contests = compare_sampling(device, file.scene, file.comparison->material, file.comparison->with, options);
  session.end_progress();
  if (session.wants_json()) {
    Json answer = json_answer("render");
    answer["scene"] = arguments.text(kScene);
    answer["samples"] = options.samples;
    answer["seed"] = options.seed;
    answer["comparison"] = Json::array();
    for (const SamplingContest& contest : contests) answer["comparison"].push_back(contest_json(contest));
    answer["device"] = to_json(device.info());
    session.print_json(answer);
    return ExitCode::success;
  }
  std::vector<std::vector<std::string>> rows{{"material", "variance by cosines", "by importance",
                                              "ratio at equal samples", "time per sample", "ratio at equal time"}};
  for (const SamplingContest& contest : contests) {
    rows.push_back({contest.material, fmt::format("{:.3g}", contest.variance[0].value),
                    fmt::format("{:.3g}", contest.variance[1].value), ratio_text(contest.equal_samples),
                    fmt::format("x {:.2f}", contest.seconds[1] / contest.seconds[0]), ratio_text(contest.equal_time)});
  }
  session.print(format_table(rows, 1, session.colors_output()));
  return ExitCode::success;
}

ExitCode execute_render(Session& session) {
  const SceneFile file = scene_of(session.arguments());
  return session.arguments().has(kCompare) ? compare_strategies(session, file) : draw_picture(session, file);
}

}  // namespace

Command render_command() {
  return {
      .name = "render",
      .group = "Materials",
      .summary = "draw a scene of shapes and lights by path tracing",
      .description =
          "Draws the scene of a TOML file, of spheres, boxes, cylinders, planes and meshes under point lights and a "
          "sky, by path tracing with the samplers of 'lobe sample'. FILE.png shows it; FILE.exr holds the radiances "
          "and, in further channels, the variance of each pixel's mean. The same seed gives the same files, unless "
          "--time ends the work.\n"
          "With --compare-sampling, draws the materials that the scene lists under [comparison] in turn, by cosines "
          "and by importance, and prints the variances of single samples, their ratio, and their ratio for samples "
          "that take equally long (Neumann 2001, figure 4.9). docs/render.md describes scene files.",
      .positionals = {{.handle = kScene, .help = "the scene file"}},
      .options = {{.handle = option::output,
                   .letter = 'o',
                   .value = "FILE",
                   .help = "the picture, FILE.png; radiances and variances go to FILE.exr beside it"},
                  {.handle = option::samples,
                   .value = "N",
                   .help = "samples per pixel, at least 2 (default: those of the scene, or 64)"},
                  {.handle = kNoise,
                   .value = "X",
                   .help = "stop earlier when the root of the mean variance is below X times the mean radiance"},
                  {.handle = kTime, .value = "S", .help = "stop earlier, after S seconds"},
                  {.handle = kLive, .help = "also write the files during the work, each time samples have doubled"},
                  {.handle = kStrategy,
                   .value = "S",
                   .help = "how directions are drawn, by importance or by cosine (default: that of the scene)",
                   .choices = {"importance", "cosine"}},
                  {.handle = kDrawPatches,
                   .value = "W",
                   .help = "how to draw directions within patches (default exact)",
                   .choices = {"exact", "rejection", "roulette"}},
                  {.handle = kSceneSeed, .value = "S", .help = "seed of the random numbers, from 1 on (default 1)"},
                  {.handle = kWidth, .value = "N", .help = "width of the picture in pixels, its height in proportion"},
                  {.handle = kReplace,
                   .value = "NAME=MATERIAL",
                   .help = "draw this in place of a material of the scene; may be repeated"},
                  {.handle = kExposure,
                   .value = "X",
                   .help = "factor on radiances in FILE.png (default: 98 % of the numbers are below white)"},
                  {.handle = kCompare, .help = "compare strategies of sampling instead of drawing a picture"},
                  {.handle = option::force, .letter = 'f', .help = "replace existing files"},
                  json_option()},
      .examples =
          {{"metal spheres, quickly", "lobe render examples/scenes/metals.toml --width 80 --samples 32 -o metals.png"},
           {"another material for one of them",
            "lobe render examples/scenes/metals.toml --replace gold=ggx:alpha=0.1 --width 80 --samples 16 -o ggx.png"},
           {"what importance sampling is worth for ten materials",
            "lobe render examples/scenes/sampling.toml --compare-sampling --samples 16"}},
      .execute = execute_render};
}

}  // namespace lobe::cli
