#include <fmt/format.h>

#include <string>
#include <variant>

#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "interface/table_making.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/chosen_file.hpp"
#include "lobe/study/load_reflectance.hpp"

namespace lobe::cli {
namespace {

BrdfTable imported(Session& session, const Device& device, const Reflectance& reflectance) {
  const TabulateOptions options = tabulate_options(session);
  const auto given = given_grid(session.arguments());
  const HemisphereGrid grid = given ? *given : resolving_grid(device, {reflectance}, TableUse::values, options);
  if (const BrdfFunction* function = reflectance.function()) {
    const BrdfTable shape = shape_of(*function, grid);
    session.state_memory(value_bytes(shape), value_bytes(shape));
  }
  BrdfTable table = tabulate(device, reflectance, grid, options);
  note_if_unresolved(session, device, reflectance, table, options);
  return table;
}

ExitCode execute_import(Session& session) {
  const TableOutput output(session);
  const ChosenFile file = parse_file(session.arguments().text(argument::file), read_options(session.arguments()));
  const Reflectance loaded = load_reflectance(file);
  if (loaded.formula() != nullptr) {
    throw ArgumentError("'" + session.arguments().text(argument::file) +
                        "' is a material file; 'lobe tabulate' makes a table of it");
  }
  const auto device = session.choose_device();
  Findings findings;
  if (const BrdfFunction* function = loaded.function())
    findings = {function_fields(*function), function_json(*function)};
  return finish(session, "import", device, imported(session, device, loaded), output, findings);
}

}  // namespace

Command import_command() {
  static const std::string description =
      "Reads a reflectance of another program, or some channels of a table, and writes it as a table. Measured files "
      "also stand wherever a material does, without options. Values are taken as the file has them: nothing is clamped "
      "or made reciprocal. Formats, recognised by content: " +
      format_list(false) + ".";
  std::vector<Option> options = reading_options();
  return {.name = "import",
          .group = "Tables",
          .summary = "turn another program's file into a table",
          .description = description,
          .positionals = {{.handle = argument::file, .help = "the file to read; - is standard input"}},
          .options = table_command_options(std::move(options),
                                           "the grid (default: the file's cells, else as fine as the file needs)"),
          .examples = {{"a neural encoding", "lobe import pink-felt.h5 -o felt-table.h5 --grid gauss:32x64"},
                       {"sintered PTFE at two wavelengths",
                        "lobe import PTFE.coeff.csv --wavelengths 532,633 --theta-max 80 -o ptfe.h5"}},
          .execute = execute_import};
}

}  // namespace lobe::cli
