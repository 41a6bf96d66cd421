#include <fmt/ranges.h>

#include <numbers>

#include "lobe/error.hpp"
#include "lobe/measured.hpp"
#include "table_making.hpp"
#include "terminal.hpp"

namespace lobe::cli {
namespace {

ExitCode execute(Session& session) {
  const auto& arguments = session.arguments();
  ReadOptions reading;
  if (arguments.has("wavelengths")) reading.wavelengths = arguments.numbers("wavelengths");
  if (arguments.has("theta-max")) reading.theta_max = arguments.number("theta-max") * std::numbers::pi / 180;
  const auto brdf = load_measured(arguments.text("FILE"), reading);
  const TableOutput output(session);
  const auto options = tabulate_options(session);
  const HemisphereGrid grid = common_grid(arguments, {});
  const auto device = session.choose_device();

  const InterruptWatch watch;
  BrdfTable shape;
  shape.grid = grid;
  shape.form = grid.is_product() ? TableForm::isotropic : TableForm::general;
  shape.channels = brdf.channels.size();
  session.state_memory(value_bytes(shape), value_bytes(shape));
  const Findings findings{
      {{"format", brdf.format},
       {"conventions", brdf.conventions},
       {"channels", fmt::format("{}", fmt::join(brdf.channels, ", "))}},
      {{"format", brdf.format}, {"conventions", brdf.conventions}, {"channel_names", brdf.channels}}};
  return finish(session, "import", device, tabulate(brdf, grid, options), output, findings);
}

}  // namespace

Command import_command() {
  return {
      .name = "import",
      .group = "Tables",
      .summary = "a file of measured reflectances as a table",
      .description =
          "Reads a measured or encoded reflectance and writes it as a table, which stands wherever a material does: "
          "it can be checked, repaired, composed, and measured against models. Formats, recognised by content:\n"
          "NBRDF neural encodings (.h5, Sztrajman et al. 2021), as of the MERL materials; Zernike coefficients of "
          "NIST (.csv, Germer 2017). Values are taken as the file has them: nothing is made reciprocal.",
      .positionals = {{.name = "FILE", .help = "the file to read"}},
      .options = table_command_options(
          {{.name = "wavelengths", .value = "LIST", .help = "channels of spectral files, nm: 450,532,633"},
           {.name = "theta-max",
            .value = "DEGREES",
            .help = "angle from the normal up to which the file counts; beyond, values are those there (default 90)"}},
          "the grid (default gauss:64x128)"),
      .examples = {{"a neural encoding", "lobe import pink-felt.h5 -o felt-table.h5 --grid gauss:32x64"},
                   {"sintered PTFE at two wavelengths",
                    "lobe import PTFE.coeff.csv --wavelengths 532,633 --theta-max 80 -o ptfe.h5"}},
      .execute = execute};
}

}  // namespace lobe::cli
