#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/file_set.hpp"
#include "core/files.hpp"
#include "interface/memory.hpp"
#include "interface/output_file.hpp"
#include "interface/reading.hpp"
#include "interface/table_making.hpp"
#include "lobe/energy/energy.hpp"
#include "lobe/io/foreign_export.hpp"
#include "lobe/model/model.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

HemisphereGrid cells_of(const Operand& operand) {
  const bool is_on_cells = operand.is_table() && operand.header().grid.kind() == GridKind::klems;
  return is_on_cells ? operand.header().grid : HemisphereGrid::klems(145);
}

/// What formats of cells hold.
BrdfTable averages_of(Session& session, const Operand& operand) {
  TabulateOptions options = tabulate_options(session);
  options.allow_unresolved = true;  // patches are averages, however narrow the lobe
  return tabulated(session.choose_device(), operand, cells_of(operand), options);
}

/// What has values.
BrdfFunction function_of(Session& session, const Operand& operand) {
  if (operand.is_foreign()) return operand.function();
  if (operand.is_table()) return as_function(operand.load());
  return as_function(session.choose_device(), operand.material());
}

bool has_delta(const Operand& operand) {
  if (operand.is_table()) return operand.header().has_delta();
  return std::ranges::any_of(operand.material().terms, [](const Term& term) { return traits_of(term).has_delta; });
}

std::vector<Estimate> mean_albedos(Session& session, const Operand& operand) {
  if (operand.is_foreign()) return mean_albedo(operand.function());
  if (operand.is_table()) return albedo(operand.load()).mean;
  return mean_albedo(session.choose_device(), operand.material(), {.precision = session.precision()});
}

/// Samples that miss a lobe, or meet it, may have any light.
void warn_of_light(Session& session, const std::string& format, const std::vector<Estimate>& source,
                   const std::vector<Estimate>& file) {
  constexpr double kNoticed = 0.05;  // relative
  for (std::size_t c = 0; c < source.size(); ++c) {
    const double change = std::abs(file[c].value - source[c].value);
    if (change <= kNoticed * std::abs(source[c].value) + file[c].error + source[c].error) continue;
    session.warn(
        fmt::format("the samples of '{}' are too far apart for this: read again the mean albedo is {:.3g} "
                    "instead of {:.3g}",
                    format, file[c].value, source[c].value));
    return;
  }
}

/// Moves a complete file to its place. \throws IoError
void place(const fs::path& staged, const OutputFile& file) {
  write_atomically(file.path(), file.overwrites(), [&](const fs::path& temporary) {
    std::error_code code;
    fs::rename(staged, temporary, code);
    // A link may lead to another file system.
    if (code) fs::copy_file(staged, temporary, fs::copy_options::overwrite_existing);
  });
}

ExitCode execute(Session& session) {
  const auto& arguments = session.arguments();
  const OutputFile file(session);
  const std::string format = arguments.text("format");
  const Operand operand = session.operand("MATERIAL");
  std::optional<BrdfTable> cells;
  if (holds_cells(format)) cells = averages_of(session, operand);
  const BrdfFunction function = cells ? as_function(*cells) : function_of(session, operand);
  const fs::path& path = file.path();
  const WriteOptions saving{.overwrite = file.overwrites(), .command_line = session.command_line()};
  if (is_output_stream(path)) {
    save_measured(function, format, path, saving);
    return ExitCode::success;  // what has gone is not read again
  }
  // The file takes its place when all is known of it, and nothing can fail any more.
  const FileSet made(path.parent_path(), path.filename().string(), file.overwrites());
  const fs::path staged = made.staging() / path.filename();
  save_measured(function, format, staged, saving);
  const BrdfFunction back = load_measured(staged);
  // Averages over patches are held against what they are averages of, where that has values.
  const bool is_averaged = cells && !has_delta(operand);
  const Deviation off = deviation(is_averaged ? function_of(session, operand) : function, back);
  // Patches keep the light; samples and what readers interpolate between them do not.
  const auto means = cells ? albedo(*cells).mean : mean_albedo(back);
  const auto source_means = cells ? means : mean_albedos(session, operand);
  const auto bytes = fs::file_size(staged);
  place(staged, file);
  session.end_progress();
  warn_of_light(session, format, source_means, means);
  if (session.wants_json()) {
    Json answer = json_answer("export");
    answer["file"] = file.path().string();
    answer["file_bytes"] = bytes;
    answer.update(function_json(back));
    answer["mean_albedo"] = Json::array();
    for (const Estimate& mean : means) answer["mean_albedo"].push_back(to_json(mean));
    if (cells) {
      answer["relative_error"] = to_json(relative_error(*cells));
    } else {
      answer["source_mean_albedo"] = Json::array();
      for (const Estimate& mean : source_means) answer["source_mean_albedo"].push_back(to_json(mean));
    }
    answer["median_deviation"] = off.median;
    answer["rms_deviation"] = off.rms;
    session.print_json(answer);
    return ExitCode::success;
  }
  std::vector<Field> fields{{"file", fmt::format("{} ({})", file.path().string(), bytes_text(bytes))}};
  for (auto& field : function_fields(back)) fields.push_back(std::move(field));
  // Files of three channels take a reflectance of one in each.
  for (std::size_t c = 0; c < source_means.size(); ++c) {
    std::string text = format_estimate(source_means[c]);
    if (!cells) text += ", in the file " + format_estimate(means[c]);
    fields.push_back(
        {source_means.size() == 1 ? "mean albedo" : "mean albedo, " + function.channels[c], std::move(text)});
  }
  fields.push_back({"read back", fmt::format("off by {:.2g} (median), {:.2g} (root mean square, relative) up to 75°, "
                                             "between the format's samples",
                                             off.median, off.rms)});
  session.print(fields_text(fields));
  return ExitCode::success;
}

}  // namespace

Command export_command() {
  static const std::string description =
      "Writes a reflectance in a format of other programs, reads it again and says how far that is from what was to be "
      "written: most formats are samples, between which readers interpolate. Those of patches hold averages over each "
      "two of them, which keep the light: their mean albedo is printed with the error of averaging, for samples that "
      "of "
      "the source and that of what the file is read as. Formats: " +
      format_list(true) + ". Delta parts, of which only 'klems' knows, are refused by the others.";
  return {.name = "export",
          .group = "Tables",
          .summary = "a material or table as a file of another program",
          .description = description,
          .positionals = {{.name = "MATERIAL", .help = "what to write", .is_material = true}},
          .options = {{.name = "format", .value = "FORMAT", .help = "the format, see above", .required = true},
                      {.name = "output", .letter = 'o', .value = "FILE", .help = "the file", .required = true},
                      {.name = "samples",
                       .value = "N",
                       .help = "samples per coordinate of a patch to begin with (klems; default 4)"},
                      {.name = "force", .letter = 'f', .help = "replace a file that exists"},
                      json_option()},
          .examples = {{"a glossy paint for renderers",
                        "lobe export lambert:scale=0.3+phong:n=50,scale=0.5 --format merl -o paint.binary"},
                       {"the same for daylight simulation",
                        "lobe export lambert:scale=0.3+phong:n=50,scale=0.5 --format klems -o paint.xml"}},
          .execute = execute};
}

}  // namespace lobe::cli
