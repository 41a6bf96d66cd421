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
          "Divides a table by its largest albedo of light from any of its directions, over all channels, and says "
          "how far that moves it. The shape of the reflectance stays; all of it becomes darker, or brighter.\n"
          "Of a material, '@normalise' at its end does the same by its formula: lobe tabulate 'ward:m=0.2@normalise'.",
      .positionals = {{.handle = argument::a, .help = "the table or material", .is_material = true}},
      .options = table_command_options({}, "the grid (default: that of the table; of a material gauss:64x128)", false),
      .examples = {{"a paint of a diffuser and a gloss that sum up to too much",
                    "lobe tabulate lambert:scale=0.5+phong:n=20,scale=0.7 -o paint.h5"},
                   {"made darker as a whole", "lobe normalise paint.h5 -o normalised.h5"}},
      .execute = execute_normalise};
}

}  // namespace lobe::cli
