#include "interface/options.hpp"
#include "interface/repairing.hpp"
#include "lobe/energy/repair.hpp"

namespace lobe::cli {
namespace {

ExitCode execute_symmetrise(Session& session) {
  return repair(session, "symmetrise",
                [](const Device& device, const Reflectance& table) { return Repaired{symmetrise(device, table)}; });
}

}  // namespace

Command symmetrise_command() {
  return {
      .name = "symmetrise",
      .group = "Repair",
      .summary = "find the nearest reciprocal table",
      .description =
          "Replaces f(L, V) and f(V, L) by their mean, which gives the nearest reciprocal table, and prints how far "
          "that moves it. A table that is reciprocal to the last bit stays unchanged.",
      .positionals = {{.handle = argument::a, .help = "the table or material", .is_material = true}},
      .options = table_command_options(
          {}, "the grid (default: the table's own; else as fine as a material or file needs)", false),
      .examples = {{"a composition, which is not reciprocal", "lobe compose phong:n=20 ward:m=0.3 -o c.h5"},
                   {"how far it is from being reciprocal", "lobe symmetrise c.h5"}},
      .execute = execute_symmetrise};
}

}  // namespace lobe::cli
