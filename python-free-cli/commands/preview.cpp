#include "lobe/render/preview.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "interface/colours.hpp"
#include "interface/operand_list.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/session.hpp"
#include "interface/table_report.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/colour.hpp"
#include "lobe/core/error.hpp"
#include "lobe/plot/preview_sheet.hpp"

namespace lobe::cli {
namespace {

constexpr Count kColumns{"columns"};
constexpr Words kLight{"light"};
constexpr Count kSize{"size"};

namespace fs = std::filesystem;

constexpr unsigned kLargestSize = 1024;
constexpr unsigned kMostColumns = 64;

/// A lighting of the sheet: every material has a sphere under it.
struct Light {
  std::string name;
  SphereLighting lighting;
  double exposure = 1;
};

std::vector<Light> lights_of(const Arguments& arguments) {
  const auto names = arguments.has(kLight) ? arguments.words(kLight) : std::vector<std::string>{"point", "daylight"};
  std::vector<Light> lights;
  for (const auto& name : names) {
    Light light{name, {}};
    if (name == "point" || name == "both") light.lighting.points = three_point_lights().points;
    if (name == "daylight" || name == "both") light.lighting.sky = homogeneous_daylight().sky;
    if (light.lighting.points.empty() && light.lighting.sky == 0) {
      throw ArgumentError("unknown light '" + name + "'; expected a list of point, daylight and both");
    }
    if (std::ranges::find(lights, name, &Light::name) != lights.end()) {
      throw ArgumentError("--light names '" + name + "' twice; expected each once");
    }
    light.exposure = reference_exposure(light.lighting);
    lights.push_back(std::move(light));
  }
  return lights;
}

std::string name_of(const Operand& operand) {
  return operand.shape().table() == nullptr ? operand.shape().name() : fs::path(operand.label()).stem().string();
}

struct Sheet {
  std::vector<SheetCell> cells;
  std::vector<std::string> colours;
};

void add_cell(Sheet& sheet, const Device& device, const Operand& operand, std::string name,
              std::span<const Light> lights, SphereOptions options) {
  const DisplayColours colours = colours_of(operand.shape());
  options.weights = colours.weights;
  SheetCell cell{std::move(name), {}};
  const Reflectance reflectance = operand.reflectance();
  for (const Light& light : lights) {
    options.white = 1 / light.exposure;
    cell.spheres.push_back(display(render_sphere(device, reflectance, light.lighting, options), light.exposure));
  }
  sheet.cells.push_back(std::move(cell));
  sheet.colours.push_back(colours.text);
}

std::string caption_of(std::span<const Light> lights) {
  std::string names;
  for (const Light& light : lights) {
    names += names.empty() ? "" : " | ";
    names += light.name == "point" ? "three point lights" : light.name == "both" ? "lights and daylight" : light.name;
  }
  return fmt::format("{}; a grey sphere of albedo {} is shown at {}", names, kReferenceAlbedo, kReferenceLightness);
}

Json lights_json(std::span<const Light> lights) {
  Json json = Json::array();
  for (const Light& light : lights) {
    Json entry{
        {"name", light.name}, {"exposure", light.exposure}, {"sky", light.lighting.sky}, {"points", Json::array()}};
    for (const PointLight& point : light.lighting.points) {
      entry["points"].push_back({{"direction", point.direction}, {"irradiance", point.irradiance}});
    }
    json.push_back(std::move(entry));
  }
  return json;
}

Json cell_json(const SheetCell& cell, const std::string& colours, std::span<const Light> lights) {
  Json json{{"name", cell.name}, {"colours", colours}, {"spheres", Json::array()}};
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const DisplayedSphere& sphere = cell.spheres[k];
    json["spheres"].push_back({{"light", lights[k].name},
                               {"pixels", sphere.pixels},
                               {"clipped_pixels", sphere.clipped},
                               {"negative_pixels", sphere.negative},
                               {"largest_error", to_json(sphere.largest_error)},
                               {"mean_error", to_json(sphere.mean_error)}});
  }
  return json;
}

std::string sheet_text(const Sheet& sheet, std::span<const Light> lights, bool color) {
  std::vector<std::vector<std::string>> rows{
      {"material", "colours", "light", "clipped", "below 0", "largest error", "mean error"}};
  for (std::size_t i = 0; i < sheet.cells.size(); ++i) {
    for (std::size_t k = 0; k < lights.size(); ++k) {
      const DisplayedSphere& sphere = sheet.cells[i].spheres[k];
      const auto share = [&](std::size_t count) {
        return fmt::format("{:.2g} %", 100.0 * static_cast<double>(count) / static_cast<double>(sphere.pixels));
      };
      rows.push_back({k == 0 ? sheet.cells[i].name : "", k == 0 ? sheet.colours[i] : "", lights[k].name,
                      share(sphere.clipped), share(sphere.negative), fmt::format("{:.1e}", sphere.largest_error),
                      fmt::format("{:.1e}", sphere.mean_error)});
    }
  }
  return format_table(rows, 3, color);
}

ExitCode execute_preview(Session& session) {
  const auto& arguments = session.arguments();
  const OutputFile output(session);
  (void)sheet_format(output.path());
  const auto lights = lights_of(arguments);
  SphereOptions options;
  if (arguments.has(kSize)) options.size = arguments.count(kSize, kLargestSize);
  options.precision = session.precision();
  const SheetOptions layout{.columns = arguments.has(kColumns) ? arguments.count(kColumns, kMostColumns) : 0,
                            .overwrite = output.overwrites()};
  const auto list = read_operands(session, arguments.texts(argument::materials), {});
  const auto device = session.choose_device();

  const ProgressCallback progress = session.progress();
  const auto count = static_cast<double>(list.operands.size() + 1);
  Sheet sheet;
  const auto add = [&](const Operand& operand, std::string name) {
    const double done = static_cast<double>(sheet.cells.size()) / count;
    options.progress = [&progress, done](std::string_view stage, double) { return !progress || progress(stage, done); };
    add_cell(sheet, device, operand, std::move(name), lights, options);
  };
  add(Operand(parse_material(fmt::format("lambert:scale={}", kReferenceAlbedo))), "grey reference sphere");
  for (const Operand& operand : list.operands) add(operand, name_of(operand));
  session.end_progress();
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  const auto [width, height] = write_preview_sheet(sheet.cells, caption_of(lights), output.path(), layout);

  if (!session.wants_json()) {
    session.print(sheet_text(sheet, lights, session.colors_output()));
    session.print(fmt::format("{}: {} x {} pixels\n", output.path().string(), width, height));
    return ExitCode::success;
  }
  Json answer = json_answer("preview");
  answer["picture"] = output.path().lexically_normal().string();
  answer["width"] = width;
  answer["height"] = height;
  answer["sphere_size"] = options.size;
  answer["reference"] = {{"albedo", kReferenceAlbedo}, {"lightness", kReferenceLightness}};
  answer["units"] = {{"exposure", "1 / radiance"}, {"irradiance", "sr radiance"}, {"errors", "white"}};
  answer["lights"] = lights_json(lights);
  answer["materials"] = Json::array();
  for (std::size_t i = 0; i < sheet.cells.size(); ++i) {
    answer["materials"].push_back(cell_json(sheet.cells[i], sheet.colours[i], lights));
  }
  answer["device"] = to_json(device.info());
  session.print_json(answer);
  return ExitCode::success;
}

}  // namespace

Command preview_command() {
  return {
      .name = "preview",
      .group = "Materials",
      .summary = "draw spheres under point lights and daylight",
      .description =
          "Renders a sphere of each material under three point lights and under uniform daylight (Neumann 2001, 3.6), "
          "estimates the quadrature error of each pixel, and draws the spheres as one picture with their names. The "
          "exposure shows a grey reference sphere, the first on the sheet, at half of the display's range; it is the "
          "same for all materials. Spectra are shown as the CIE 1931 observer sees them under D65, and channels other "
          "than red, green and blue as a grey.\n"
          "Prints how many pixels are brighter than the display's white or below 0, and errors relative to white.",
      .positionals = {{.handle = argument::materials,
                       .help = "the materials, tables and files to show; a study file stands for all its materials",
                       .is_material = true,
                       .is_repeated = true}},
      .options = {{.handle = option::output,
                   .letter = 'o',
                   .value = "FILE",
                   .help = "the picture, .png or .svg",
                   .required = true},
                  {.handle = kSize, .value = "N", .help = "pixels across a sphere (default 192)"},
                  {.handle = kColumns, .value = "N", .help = "materials per row (default: for a sheet of about 4 : 3)"},
                  {.handle = kLight,
                   .value = "LIST",
                   .help = "lights of the spheres, a list of point, daylight and both (default point,daylight)"},
                  {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
                  set_option(),
                  json_option()},
      .examples = {{"a paint and a metal",
                    "lobe preview lambert:scale=0.3+ward:m=0.1,scale=0.5 ggx:alpha=0.3 -o sheet.png"},
                   {"a family of a study, under both lights at once",
                    "lobe preview 'studies/classical-families.toml#Ward' --light both --size 96 -o ward.png"}},
      .execute = execute_preview};
}

}  // namespace lobe::cli
