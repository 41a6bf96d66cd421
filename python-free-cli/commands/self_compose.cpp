#include <array>

#include "interface/composition.hpp"
#include "interface/options.hpp"
#include "interface/table_making.hpp"

namespace lobe::cli {
namespace {

constexpr Count kPower{"times"};

ExitCode execute_self_compose(Session& session) {
  const auto& arguments = session.arguments();
  const std::array operand{session.operand(argument::a)};
  const unsigned times = arguments.has(kPower) ? arguments.count(kPower) : 1;
  const TableOutput output(session);
  const auto device = session.choose_device();

  return finish(session, "self-compose", device, composition(session, device, operand, times), output);
}

}  // namespace

Command self_compose_command() {
  return {
      .name = "self-compose",
      .group = "Tables",
      .summary = "compose a reflectance with itself",
      .description =
          "Composes a material or table with itself, once or several times, and prints the properties of the result; "
          "-o writes it as a table.",
      .positionals = {{.handle = argument::a, .help = "the material or table", .is_material = true}},
      .options = composition_options(
          {{.handle = kPower, .value = "N", .help = "number of compositions, with N + 1 factors (default 1)"}}, false),
      .examples = {{"light reflected twice", "lobe self-compose phong:n=20"},
                   {"light reflected four times", "lobe self-compose phong:n=20 --times 3 -o fourfold.h5"}},
      .execute = execute_self_compose};
}

}  // namespace lobe::cli
