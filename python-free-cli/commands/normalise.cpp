#include "interface/options.hpp"
#include "interface/repairing.hpp"
#include "lobe/energy/repair.hpp"

namespace lobe::cli {
namespace {

ExitCode execute_normalise(Session& session) {
  return repair(session, "normalise",
                [](const Device& device, const Reflectance& table) { return Repaired{normalise(device, table)}; });
}

}  // namespace

Command normalise_command() {
  return {
      .name = "normalise",
      .group = "Repair",
      .summary = "scale a table to a largest albedo of 1",
      .description =
          "Divides a table by its largest albedo, over all of its directions of light and all channels, and prints how "
          "far that moves it. The shape of the reflectance stays the same; it becomes darker, or brighter, as a "
          "whole.\n"
          "For a material, '@normalise' at its end does the same to its formula: lobe tabulate 'ward:m=0.2@normalise'.",
      .positionals = {{.handle = argument::a, .help = "the table or material", .is_material = true}},
      .options = table_command_options(
          {}, "the grid (default: the table's own; else as fine as a material or file needs)", false),
      .examples = {{"a paint that reflects more light than it receives",
                    "lobe tabulate lambert:scale=0.5+phong:n=20,scale=0.7 -o paint.h5"},
                   {"the same paint, darker as a whole", "lobe normalise paint.h5 -o normalised.h5"}},
      .execute = execute_normalise};
}

}  // namespace lobe::cli
