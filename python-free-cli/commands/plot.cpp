#include <filesystem>
#include <utility>
#include <vector>

#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "interface/report.hpp"
#include "interface/table_making.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "lobe/plot/table_pictures.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

TablePictureOptions picture_options(const Arguments& arguments) {
  return {.format = arguments.text(option::format) == "svg" ? PictureFormat::svg : PictureFormat::png,
          .overwrite = arguments.has(option::force)};
}

void report(Session& session, const Device& device, const PictureFiles& files) {
  if (session.wants_json()) {
    Json answer = json_answer("plot");
    answer["pictures"] = files_json(files.pictures);
    answer["scripts"] = files_json(files.scripts);
    answer["note"] = files.note;
    answer["units"] = {{"bytes", "B"}};
    answer["memory"] = session.memory_json();
    answer["device"] = to_json(device.info());
    session.print_json(answer);
    return;
  }
  for (const auto* group : {&files.pictures, &files.scripts}) {
    for (const auto& file : *group) session.print(file.lexically_normal().string() + "\n");
  }
}

/// What is drawn: all on --grid, where that is given, else everything as it is.
std::vector<Reflectance> reflectances(Session& session, const Device& device, std::span<const Operand> operands) {
  std::vector<Reflectance> all;
  if (const auto grid = given_grid(session.arguments())) {
    session.state_memory(tabulated_bytes(operands, *grid));
    for (auto& table : tabulated(session, device, operands, *grid, tabulate_options(session))) {
      all.emplace_back(std::move(table));
    }
    return all;
  }
  std::uint64_t bytes = 0;
  for (const Operand& operand : operands) {
    if (const BrdfTable* header = operand.shape().table()) bytes += value_bytes(*header);
  }
  session.state_memory(bytes);
  for (const Operand& operand : operands) all.push_back(operand.reflectance());
  return all;
}

ExitCode execute_plot(Session& session) {
  const auto& arguments = session.arguments();
  std::vector<Operand> operands;
  for (const auto& text : arguments.texts(argument::materials)) operands.emplace_back(text, read_options(arguments));
  const fs::path target = arguments.text(option::output);
  if (!target.has_filename()) throw ArgumentError("--output " + target.string() + " lacks a stem; give DIR/STEM");
  if (target.extension() == ".png" || target.extension() == ".svg") {
    throw ArgumentError("--output " + target.string() + " is the name of one picture; give what several names begin " +
                        "with, as in --output " + (target.parent_path() / target.stem()).string());
  }
  const auto device = session.choose_device();
  const std::vector<Reflectance> drawn = reflectances(session, device, operands);
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  const fs::path directory = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const auto files =
      write_reflectance_pictures(device, drawn, directory, target.filename().string(), picture_options(arguments));
  if (!files.note.empty()) session.warn(files.note);
  report(session, device, files);
  return ExitCode::success;
}

}  // namespace

Command plot_command() {
  std::vector<Option> options{
      {.handle = option::output,
       .letter = 'o',
       .value = "DIR/STEM",
       .help = "beginning of the pictures' names",
       .required = true},
      {.handle = option::format, .value = "KIND", .help = "png (default) or svg", .choices = {"png", "svg"}},
      {.handle = option::force, .letter = 'f', .help = "replace existing files"},
      json_option()};
  for (const auto& option : tabulation_options("draw materials and files as tables on this grid (default: by their own "
                                               "values)")) {
    options.push_back(option);
  }
  return {.name = "plot",
          .group = "Tables",
          .summary = "draw tables beside each other",
          .description =
              "Draws polar curves in the plane of incidence, the slice over the half-vector angles, and the "
              "directional albedos of several tables, materials and files beside each other, and prints the names of "
              "the pictures. Without --grid, materials and files are drawn by their own values, however narrow their "
              "highlights.",
          .positionals = {{.handle = argument::materials,
                           .help = "the tables and materials, such as a composition and its two factors",
                           .is_material = true,
                           .is_repeated = true}},
          .options = std::move(options),
          .examples = {{"a composition", "lobe compose phong:n=20 ward:m=0.3 -o c.h5"},
                       {"the composition and its factors",
                        "lobe plot c.h5 phong:n=20 ward:m=0.3 -o pictures/c --format svg"}},
          .execute = execute_plot};
}

}  // namespace lobe::cli
