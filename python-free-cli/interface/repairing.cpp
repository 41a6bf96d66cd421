#include "interface/repairing.hpp"
#include "interface/options.hpp"

#include <fmt/core.h>

#include <array>

namespace lobe::cli {

void add_displacement(Findings& findings, const Device& device, const Reflectance& before, const Reflectance& after) {
  const Displacement moved = displacement(device, before, after);
  const std::string lighting = moved.lighting.name();
  findings.fields.push_back({"moved by", fmt::format("{} under {}; relative {}", format_estimate(moved.absolute),
                                                     lighting, format_estimate(moved.relative))});
  findings.json["moved"] = {
      {"lighting", lighting}, {"absolute", to_json(moved.absolute)}, {"relative", to_json(moved.relative)}};
}

ExitCode repair(Session& session, std::string_view command,
                const std::function<Repaired(const Device&, const Reflectance&)>& work) {
  const std::array operand{session.operand(argument::a)};
  const TableOutput output(session);
  const auto options = tabulate_options(session);
  const auto device = session.choose_device();
  const auto grid = common_grid(session, device, operand);

  const std::uint64_t bytes = value_bytes(operand.front(), grid);
  // Before, after, and what lies between them.
  session.state_memory(tabulated_bytes(operand, grid) + 2 * bytes, 2 * bytes);
  const Reflectance before = tabulated(session, device, operand.front(), grid, options);
  Repaired repaired = work(device, before);
  add_displacement(repaired.findings, device, before, repaired.table);
  return finish(session, command, device, *repaired.table.table(), output, repaired.findings);
}

}  // namespace lobe::cli
