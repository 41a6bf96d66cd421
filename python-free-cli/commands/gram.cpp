#include "interface/matrix.hpp"
#include "interface/measuring.hpp"

namespace lobe::cli {
namespace {

ExitCode execute_gram(Session& session) {
  return answer_matrix(session, {.command = "gram",
                                 .name = "gram",
                                 .formula = "f.g",
                                 .value = &Metric::gram,
                                 .error = &Metric::gram_error,
                                 .deviation = &ProductDeviations::gram,
                                 .unit = [](const Lighting& lighting) { return product_unit(lighting); }});
}

}  // namespace

Command gram_command() {
  return {.name = "gram",
          .group = "Metric",
          .summary = "compute the Gram matrix of many materials",
          .description =
              "Computes the Gram matrix of materials under each lighting, all entries with error bounds; for materials "
              "with several channels, the weighted sum of their products and the product of each one. The text shows "
              "the lower triangle. The CSV has a row per lighting, channel, quantity ('gram', 'gram_error') and "
              "material.\n"
              "A study file gives its materials, their channel weights and, without --lighting, its lightings; the "
              "tolerance is that of --tolerance. If a table is among the materials, all are brought to the grid of the "
              "first one; the errors then include that of the grid.",
          .positionals = matrix_positionals(),
          .options = matrix_options(),
          .examples = {{"three materials under two lightings",
                        "lobe gram lambert phong:n=20 ward:m=0.2 --lighting point --lighting daylight"},
                       {"a family of a study, for a spreadsheet",
                        "lobe gram studies/classical-families.toml --family Ward -o ward.csv"}},
          .execute = execute_gram};
}

}  // namespace lobe::cli
