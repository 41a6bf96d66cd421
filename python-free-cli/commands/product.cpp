#include "interface/pair.hpp"

namespace lobe::cli {
namespace {

ExitCode execute_product(Session& session) {
  print(session, "product", compare(session), &Pair::product);
  return ExitCode::success;
}

}  // namespace

Command product_command() {
  return {.name = "product",
          .group = "Metric",
          .summary = "compute the scalar product of two materials",
          .description =
              "Computes the scalar product A.B of two materials under a lighting, with an error bound; for materials "
              "with several channels, the weighted sum of their products and the product of each one. -v adds norms, "
              "distance and angle; the JSON holds them all.\n"
              "Tables are multiplied on the grid of the first one, and materials beside them are tabulated on it; the "
              "error then includes that of the grid.",
          .positionals = pair_positionals(),
          .options = pair_options(),
          .examples = {{"two highlights under point light", "lobe product phong:n=20 ward:m=0.2"},
                       {"the light of a uniform sky that both reflect, in sr",
                        "lobe product lambert ward:m=0.2 --lighting daylight"}},
          .execute = execute_product};
}

}  // namespace lobe::cli
