#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "interface/deviations.hpp"
#include "interface/memory.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/reading.hpp"
#include "interface/table_making.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/file_set.hpp"
#include "lobe/core/files.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/formats/measured_export.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

constexpr Count kLeaves{"leaves"};
constexpr Count kLightAngles{"light-angles"};
constexpr Count kLightAzimuths{"light-azimuths"};
constexpr Count kNodes{"nodes"};
constexpr Flag kSpectra{"spectra"};

/// How to write, by the options; those of one format are refused for others.
WriteOptions saving_of(Session& session, const OutputFile& file, const std::string& format) {
  const auto& arguments = session.arguments();
  WriteOptions saving{
      .overwrite = file.overwrites(), .command_line = session.command_line(), .progress = session.progress()};
  const auto is_given = [&](const auto& option, const std::string& whose = "rgl") {
    if (!arguments.has(option)) return false;
    if (format == whose) return true;
    throw ArgumentError(option.dashed() + " is for the format '" + whose + "'; leave it out for '" + format + "'");
  };
  if (arguments.has(option::cell_points) && !holds_cells(format)) {
    throw ArgumentError(option::cell_points.dashed() + " is for formats of cells; leave it out for '" + format + "'");
  }
  if (is_given(kLightAngles)) saving.light_angles = arguments.count(kLightAngles);
  if (is_given(kLightAzimuths)) saving.light_azimuths = arguments.count(kLightAzimuths);
  if (is_given(kNodes)) saving.nodes = arguments.count(kNodes);
  if (is_given(kLeaves, "tensor-tree")) saving.leaves = arguments.count(kLeaves);
  saving.spectra = is_given(kSpectra);
  return saving;
}

/// Averages for formats of cells: over a reflectance's own patches if it has some, else over those of klems:145.
BrdfTable averages_of(Session& session, const Reflectance& reflectance) {
  const auto& arguments = session.arguments();
  TabulateOptions options{.precision = session.precision(),
                          .allow_unresolved = true,  // patches are averages, however narrow the lobe
                          .progress = session.progress()};
  if (arguments.has(option::cell_points)) options.cell_points = arguments.count(option::cell_points);
  const HemisphereGrid own = natural_grid(reflectance);
  const HemisphereGrid grid = own.kind() == GridKind::klems ? own : HemisphereGrid::klems(145);
  return tabulate(session.device(), reflectance, grid, options);
}

/// With what a format of standard deviations takes them from, where the operand states some.
Reflectance with_deviations(Session& session, const Operand& operand, const std::string& format) {
  if (holds_deviations(format)) {
    const auto functions = replicated(session, {&operand, 1});
    if (!functions.empty()) return functions.front();
  }
  return operand.reflectance();
}

/// Samples that miss a lobe, or meet it, may have any light.
/// \return whether there is anything to warn of
bool warn_of_light(Session& session, const std::string& format, const std::vector<Estimate>& source,
                   const std::vector<Estimate>& file) {
  constexpr double kNoticed = 0.05;  // relative
  for (std::size_t c = 0; c < source.size(); ++c) {
    const double change = std::abs(file[c].value - source[c].value);
    if (change <= kNoticed * std::abs(source[c].value) + file[c].error + source[c].error) continue;
    session.warn(
        fmt::format("the samples of '{}' are too far apart for this: read again the mean albedo is {:.3g} "
                    "instead of {:.3g}",
                    format, file[c].value, source[c].value));
    return true;
  }
  return false;
}

/// What the errors of mean albedos hide shows in values.
void warn_of_values(Session& session, const std::string& format, const Deviation& off) {
  constexpr double kNoticed = 0.4;  // relative
  if (off.rms <= kNoticed) return;
  session.warn(
      fmt::format("the samples of '{}' are too far apart for this: read again values are off by {:.2g} (root "
                  "mean square, relative), at most {:.2g} of the largest value",
                  format, off.rms, off.largest));
}

/// Moves a complete file to its place.
/// \throws IoError
void place(const fs::path& staged, const OutputFile& file) {
  write_atomically(file.path(), file.overwrites(), [&](const fs::path& temporary) {
    std::error_code code;
    fs::rename(staged, temporary, code);
    // A link may lead to another file system.
    if (code) fs::copy_file(staged, temporary, fs::copy_options::overwrite_existing);
  });
}

ExitCode execute_export(Session& session) {
  const auto& arguments = session.arguments();
  const OutputFile file(session);
  const std::string format = arguments.text(option::format);
  const WriteOptions saving = saving_of(session, file, format);
  const Operand operand = session.operand(argument::material);
  const Device& device = session.device();
  const Reflectance source = operand.reflectance();
  const bool is_averaged = holds_cells(format);
  const Reflectance written =
      is_averaged ? Reflectance(averages_of(session, source)) : with_deviations(session, operand, format);
  const fs::path& path = file.path();
  if (is_output_stream(path)) {
    save_measured(device, written, format, path, saving);
    return ExitCode::success;  // what has gone is not read again
  }
  // The file takes its place when all is known of it, and nothing can fail any more.
  const FileSet made(path.parent_path(), path.filename().string(), file.overwrites());
  const fs::path staged = made.staging() / path.filename();
  save_measured(device, written, format, staged, saving);
  const BrdfFunction back = load_measured(staged);
  // Averages over patches are held against what they are averages of, where that has values.
  const Deviation off = deviation(device, is_averaged && source.has_delta() ? written : source, back);
  // Patches keep the light; samples and what readers interpolate between them do not.
  const auto means = mean_albedo(device, is_averaged ? written : Reflectance(back));
  const auto source_means = is_averaged ? means : mean_albedo(device, source, {.precision = session.precision()});
  const auto bytes = fs::file_size(staged);
  place(staged, file);
  session.end_progress();
  if (!warn_of_light(session, format, source_means, means) && !is_averaged) warn_of_values(session, format, off);
  if (session.wants_json()) {
    Json answer = json_answer("export");
    answer["file"] = file.path().string();
    answer["file_bytes"] = bytes;
    answer.update(function_json(back));
    answer["mean_albedo"] = Json::array();
    for (const Estimate& mean : means) answer["mean_albedo"].push_back(to_json(mean));
    if (is_averaged) {
      answer["relative_error"] = to_json(relative_error(*written.table()));
    } else {
      answer["source_mean_albedo"] = Json::array();
      for (const Estimate& mean : source_means) answer["source_mean_albedo"].push_back(to_json(mean));
    }
    answer["median_deviation"] = off.median;
    answer["rms_deviation"] = off.rms;
    answer["largest_deviation"] = off.largest;
    session.print_json(answer);
    return ExitCode::success;
  }
  std::vector<Field> fields{{"file", fmt::format("{} ({})", file.path().string(), bytes_text(bytes))}};
  for (auto& field : function_fields(back)) fields.push_back(std::move(field));
  const auto names = channel_names(source);
  // Files of three channels take a reflectance of one in each.
  for (std::size_t c = 0; c < source_means.size(); ++c) {
    std::string text = format_estimate(source_means[c]);
    if (!is_averaged) text += ", in the file " + format_estimate(means[c]);
    const std::string channel = names.empty() ? std::to_string(c + 1) : names[c];
    fields.push_back({source_means.size() == 1 ? "mean albedo" : "mean albedo, " + channel, std::move(text)});
  }
  fields.push_back({"read back", fmt::format("off by {:.2g} (median), {:.2g} (root mean square, relative), at most "
                                             "{:.2g} of the largest value, up to 75°, between the format's samples",
                                             off.median, off.rms, off.largest)});
  session.print(fields_text(fields));
  return ExitCode::success;
}

}  // namespace

Command export_command() {
  static const std::string description =
      "Writes a reflectance in another program's format, reads the file back, and prints how far it is from the "
      "source: most formats hold samples, between which readers interpolate. Formats of patches hold averages over "
      "each pair of patches, which conserve the light: their mean albedo is printed with the error of averaging. For "
      "samples, the mean albedos of the source and of the file are printed. Formats: " +
      format_list(true) + ". Only 'klems' stores delta parts; the others refuse them.";
  return {
      .name = "export",
      .group = "Tables",
      .summary = "write a file for another program",
      .description = description,
      .positionals = {{.handle = argument::material, .help = "the material to write", .is_material = true}},
      .options = {{.handle = option::format, .value = "FORMAT", .help = "the format (see above)", .required = true},
                  {.handle = option::output, .letter = 'o', .value = "FILE", .help = "the file", .required = true},
                  {.handle = option::cell_points,
                   .value = "N",
                   .help = "initial points per coordinate of a patch (klems; default 4)"},
                  {.handle = kLeaves,
                   .value = "N",
                   .help = "leaves along each axis of the viewer's square, a power of two (tensor-tree; default 64, "
                           "of anisotropic materials 16)"},
                  {.handle = kLightAngles,
                   .value = "N",
                   .help = "angles of the light, 0 to 89 degrees from the normal (rgl; default 24)"},
                  {.handle = kLightAzimuths,
                   .value = "N",
                   .help = "azimuths of the light, of anisotropic materials (rgl; default 32)"},
                  {.handle = kNodes,
                   .value = "N",
                   .help = "the viewer's directions by each of the light, N x N (rgl; default 48)"},
                  {.handle = kSpectra,
                   .help = "write a single channel as a spectrum, for pbrt and spectral Mitsuba (rgl)"},
                  {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
                  json_option()},
      .examples = {{"a rough metal for Mitsuba's 'measured'",
                    "lobe export ggx:alpha=0.2,scale=0.8 --format rgl -o rough.bsdf"},
                   {"a glossy paint for renderers",
                    "lobe export lambert:scale=0.3+phong:n=50,scale=0.5 --format merl -o paint.binary"},
                   {"the same for daylight simulation",
                    "lobe export lambert:scale=0.3+phong:n=50,scale=0.5 --format klems -o paint.xml"}},
      .execute = execute_export};
}

}  // namespace lobe::cli
