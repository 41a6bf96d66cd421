#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "interface/operand.hpp"
#include "interface/output_file.hpp"
#include "interface/session.hpp"
#include "interface/table_report.hpp"
#include "lobe/device/device.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/table.hpp"

namespace lobe::cli {

// Code shared by the commands that make tables: options, operands on a grid, the output file, the report on it.

/// --grid, --cell-points, --allow-unresolved and --strict.
[[nodiscard]] std::vector<Option> tabulation_options(std::string_view grid_help);
/// --output, --dense, --no-compress, --force and --json.
[[nodiscard]] std::vector<Option> table_output_options(bool needs_output);

/// `own` and the options of the two lists above.
[[nodiscard]] std::vector<Option> table_command_options(std::vector<Option> own, std::string_view grid_help,
                                                        bool needs_output = true);

/// The grid of --grid, if given.
[[nodiscard]] std::optional<HemisphereGrid> given_grid(const Arguments& arguments);
/// The grid of --grid, else resolving_grid().
[[nodiscard]] HemisphereGrid common_grid(const Session& session, const Device& device,
                                         std::span<const Operand> operands, TableUse use = TableUse::values);

/// How materials are tabulated by these options. A grid that does not resolve them is refused with --strict alone.
[[nodiscard]] TabulateOptions tabulate_options(Session& session);

/// Notes that the grid of a table does not resolve the reflectance that it was made of, and which one does, unless
/// that was asked for by --allow-unresolved.
void note_if_unresolved(Session& session, const Device& device, const Reflectance& reflectance, const BrdfTable& table,
                        const TabulateOptions& options);

/// tabulate() of an operand, with note_if_unresolved(); a table on the grid as it is.
[[nodiscard]] BrdfTable tabulated(Session& session, const Device& device, const Operand& operand,
                                  const HemisphereGrid& grid, const TabulateOptions& options);

/// All operands, the first one as by tabulated(). Further tables keep their grids: the library brings them to that of
/// the first, if it can by their formulas.
[[nodiscard]] std::vector<BrdfTable> tabulated(Session& session, const Device& device,
                                               std::span<const Operand> operands, const HemisphereGrid& grid,
                                               const TabulateOptions& options);

/// Bytes of the values of a table; a shape is enough.
[[nodiscard]] std::uint64_t value_bytes(const BrdfTable& shape);
/// Bytes of the values of an operand brought to a grid.
[[nodiscard]] std::uint64_t value_bytes(const Operand& operand, const HemisphereGrid& grid);
/// Bytes that tabulated() takes for all operands at its peak.
[[nodiscard]] std::uint64_t tabulated_bytes(std::span<const Operand> operands, const HemisphereGrid& grid);

/// The table that a command leaves in the file of --output.
class TableOutput {
 public:
  /// \throws as OutputFile.
  explicit TableOutput(const Session& session) : session_(session), file_(session) {}

  [[nodiscard]] bool is_wanted() const { return file_.is_wanted(); }
  /// Writes the table, unless no file is wanted.
  /// \throws IoError; Cancelled after Ctrl-C.
  void save(const BrdfTable& table) const;
  /// Empty where no file is wanted.
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  const Session& session_;
  OutputFile file_;
};

/// Findings of a command besides its table.
struct Findings {
  std::vector<Field> fields = {};
  Json json = Json::object();
};

/// Ends a command that made a table: saves it, prints what it is and what else was found, warns where it is not
/// resolved.
/// \param command name for the JSON schema
ExitCode finish(Session& session, std::string_view command, const Device& device, const BrdfTable& table,
                const TableOutput& output, const Findings& findings = {});

}  // namespace lobe::cli
