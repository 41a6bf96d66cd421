#include "interface/matrix.hpp"
#include "interface/measuring.hpp"

namespace lobe::cli {
namespace {

ExitCode execute_distance_matrix(Session& session) {
  return answer_matrix(session, {.command = "distance-matrix",
                                 .name = "distance",
                                 .formula = "|f-g|",
                                 .value = &Metric::distance,
                                 .error = &Metric::distance_error,
                                 .deviation = &ProductDeviations::distance,
                                 .unit = [](const Lighting& lighting) { return norm_unit(lighting); }});
}

}  // namespace

Command distance_matrix_command() {
  return {.name = "distance-matrix",
          .group = "Metric",
          .summary = "compute the distances between many materials",
          .description =
              "Computes the distances between materials under each lighting, all with error bounds; for materials with "
              "several channels, over all channels together and for each one. The text shows the lower triangle. The "
              "CSV has a row per lighting, channel, quantity ('distance', 'distance_error') and material.\n"
              "A study file gives its materials, their channel weights and, without --lighting, its lightings; the "
              "tolerance is that of --tolerance. If a table is among the materials, all are brought to the grid of the "
              "first one; the errors then include that of the grid. 'lobe run' also draws the matrix.",
          .positionals = matrix_positionals(),
          .options = matrix_options(),
          .examples = {{"three materials", "lobe distance-matrix lambert phong:n=20 ward:m=0.2"},
                       {"a family of a study beside a material, as CSV",
                        "lobe distance-matrix studies/classical-families.toml#Blinn ward:m=0.2 --csv"}},
          .execute = execute_distance_matrix};
}

}  // namespace lobe::cli
