#include "interface/table_making.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "interface/memory.hpp"
#include "interface/options.hpp"
#include "interface/table_report.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/files.hpp"
#include "lobe/hdf5/table_file.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

/// Bytes that tabulating takes beside the table: those of the parts that averages over cells are refined by.
std::uint64_t tabulation_workspace(const BrdfTable& shape) {
  constexpr std::uint64_t kParts = std::uint64_t{128} << 20U;
  return shape.grid.has_cells() ? std::min(kParts, 4 * value_bytes(shape)) : 0;
}

void print_text(Session& session, const BrdfTable& table, const TableAlbedo& albedos, const TableOutput& output,
                const Findings& findings) {
  std::vector<Field> fields;
  if (output.is_wanted()) {
    const std::string path = output.path().string();
    // What has gone into a pipe has no size any more.
    fields.push_back({"table", is_output_stream(output.path())
                                   ? path
                                   : fmt::format("{} ({})", path, bytes_text(fs::file_size(output.path())))});
  }
  const auto add = [&](const std::vector<Field>& more) { fields.insert(fields.end(), more.begin(), more.end()); };
  add(header_fields(table));
  add({{"relative error", relative_text(relative_error(table))}});
  add(albedo_fields(table, albedos));
  add(findings.fields);
  session.print(fields_text(fields));
}

void print_json(Session& session, std::string_view command, const Device& device, const BrdfTable& table,
                const TableAlbedo& albedos, const TableOutput& output, const Findings& findings) {
  Json answer = json_answer(command);
  if (output.is_wanted()) {
    answer["file"] = output.path().string();
    if (!is_output_stream(output.path())) answer["file_bytes"] = fs::file_size(output.path());
  }
  answer.update(header_json(table));
  answer["relative_error"] = to_json(relative_error(table));
  answer.update(albedo_json(table, albedos));
  answer.update(findings.json);
  answer["units"] = table_units();
  answer["memory"] = session.memory_json();
  answer["precision"] = to_string(session.precision());
  answer["device"] = to_json(device.info());
  session.print_json(answer);
}

}  // namespace

std::vector<Option> tabulation_options(std::string_view grid_help) {
  return {
      {.handle = option::grid, .value = "GRID", .help = grid_help},
      {.handle = option::cell_points,
       .value = "N",
       .help = "initial points per coordinate of a cell, for averages (default 4)"},
      {.handle = option::allow_unresolved, .help = "ask for a table that its grid does not resolve, without a warning"},
      strict_option()};
}

std::vector<Option> table_output_options(bool needs_output) {
  return {{.handle = option::output,
           .letter = 'o',
           .value = "FILE",
           .help = "the table's file (.h5)",
           .required = needs_output},
          {.handle = option::dense, .help = "write an isotropic table as a general one, with all four angles"},
          {.handle = option::no_compress, .help = "write larger files, faster"},
          {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
          json_option()};
}

std::vector<Option> table_command_options(std::vector<Option> own, std::string_view grid_help, bool needs_output) {
  for (const auto& options : {tabulation_options(grid_help), table_output_options(needs_output)}) {
    own.insert(own.end(), options.begin(), options.end());
  }
  return own;
}

std::optional<HemisphereGrid> given_grid(const Arguments& arguments) {
  if (!arguments.has(option::grid)) return {};
  return HemisphereGrid::parse(arguments.text(option::grid));
}

HemisphereGrid common_grid(const Session& session, const Device& device, std::span<const Operand> operands,
                           TableUse use) {
  if (const auto grid = given_grid(session.arguments())) return *grid;
  std::vector<Reflectance> reflectances;
  for (const Operand& operand : operands) reflectances.push_back(operand.shape());
  return resolving_grid(device, reflectances, use, {.precision = session.precision()});
}

TabulateOptions tabulate_options(Session& session) {
  const auto& arguments = session.arguments();
  TabulateOptions options{.precision = session.precision(),
                          .allow_unresolved = arguments.has(option::allow_unresolved) || !arguments.has(option::strict),
                          .progress = session.progress()};
  if (arguments.has(option::cell_points)) options.cell_points = arguments.count(option::cell_points);
  options.exact_grid = arguments.is_given(option::exact_grid);
  return options;
}

void note_if_unresolved(Session& session, const Device& device, const Reflectance& reflectance, const BrdfTable& table,
                        const TabulateOptions& options) {
  if (!table.is_unresolved || reflectance.table() != nullptr) return;
  if (session.arguments().has(option::allow_unresolved)) return;
  session.note_coarse(table.grid, reflectance.name(), resolution_needed(device, reflectance, table.grid, options));
}

BrdfTable tabulated(Session& session, const Device& device, const Operand& operand, const HemisphereGrid& grid,
                    const TabulateOptions& options) {
  const BrdfTable* header = operand.shape().table();
  if (header != nullptr && header->grid == grid) return operand.table();
  const Reflectance reflectance = operand.reflectance();
  BrdfTable table = tabulate(device, reflectance, grid, options);
  note_if_unresolved(session, device, reflectance, table, options);
  return table;
}

std::vector<BrdfTable> tabulated(Session& session, const Device& device, std::span<const Operand> operands,
                                 const HemisphereGrid& grid, const TabulateOptions& options) {
  std::vector<BrdfTable> tables{tabulated(session, device, operands.front(), grid, options)};
  for (const auto& operand : operands.subspan(1)) {
    const BrdfTable* header = operand.shape().table();
    tables.push_back(tabulated(session, device, operand, header == nullptr ? grid : header->grid, options));
  }
  return tables;
}

std::uint64_t value_bytes(const BrdfTable& shape) {
  return sizeof(double) * shape.channels * shape.size();
}

std::uint64_t value_bytes(const Operand& operand, const HemisphereGrid& grid) {
  BrdfTable shape = operand.shape_on(grid);
  shape.grid = grid;
  return value_bytes(shape);
}

std::uint64_t tabulated_bytes(std::span<const Operand> operands, const HemisphereGrid& grid) {
  std::uint64_t tables = 0;
  std::uint64_t peak = 0;
  for (const auto& operand : operands) {
    BrdfTable shape = operand.shape_on(grid);
    std::uint64_t workspace = operand.is_formula() ? tabulation_workspace(shape) : 0;
    if (&operand == operands.data() && !(shape.grid == grid)) {
      workspace = value_bytes(shape);  // the table before it is brought to the grid
      shape.grid = grid;
    }
    tables += value_bytes(shape);
    peak = std::max(peak, tables + workspace);
  }
  return peak;
}

void TableOutput::save(const BrdfTable& table) const {
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  if (!is_wanted()) return;
  const auto& arguments = session_.arguments();
  lobe::save(table, path(),
             {.dense = arguments.has(option::dense),
              .compress = !arguments.has(option::no_compress),
              .overwrite = file_.overwrites(),
              .command_line = session_.command_line()});
}

ExitCode finish(Session& session, std::string_view command, const Device& device, const BrdfTable& table,
                const TableOutput& output, const Findings& findings) {
  output.save(table);
  session.end_progress();
  const TableAlbedo albedos = row_albedos(table);
  if (session.wants_json()) {
    print_json(session, command, device, table, albedos, output, findings);
  } else {
    print_text(session, table, albedos, output, findings);
  }
  // What was tabulated by now is noted already; a factor that came as an unresolved table is not.
  if (table.is_unresolved && !session.has_coarse_grid()) session.note_coarse(table.grid);
  return ExitCode::success;
}

}  // namespace lobe::cli
