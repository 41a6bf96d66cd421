#include <fmt/core.h>

#include <cmath>

#include "interface/pair.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// Norms may be infinite where the product is not.
ExitCode execute_product(Session& session) {
  const PairAnswer answer = compare(session, InfiniteNorms::allowed);
  if (std::isinf(answer.combined.product.estimate.value)) {
    throw NumericError(
        fmt::format("the product of '{}' and '{}' under lighting '{}' is infinite: both have the same "
                    "delta part; daylight, patch lights and materials as lights take it",
                    answer.operands[0].label(), answer.operands[1].label(), answer.lighting.name()));
  }
  print(session, "product", answer, &Pair::product);
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
              "error then includes that of the grid.\n"
              "The product of a material with the identity, 'lobe product A rrim', is its trace, the weighted mean "
              "albedo |A|_W of section 5.3.4 (eq. 5.25), under every lighting for which it is finite.",
          .positionals = pair_positionals(),
          .options = pair_options(),
          .examples = {{"two highlights under point light", "lobe product phong:n=20 ward:m=0.2"},
                       {"the light of a uniform sky that both reflect, in sr",
                        "lobe product lambert ward:m=0.2 --lighting daylight"},
                       {"the trace of a material under the light of a lobe",
                        "lobe product ward:m=0.2 rrim --lighting material:phong:n=5"}},
          .execute = execute_product};
}

}  // namespace lobe::cli
