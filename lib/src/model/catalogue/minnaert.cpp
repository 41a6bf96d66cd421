#include "model/entry.hpp"

namespace lobe {

CatalogueEntry minnaert_entry() {
  return {
      .model = {.name = "minnaert",
                .family = "Minnaert",
                .formula = "(k+2)/(2 pi) ((N.L) (N.V))^k",
                .source = "Neumann 2001, eq. 1.32 (Minnaert 1941): albedo (N.L)^k; k = 0 is Lambert",
                .parameters = {{"k", "1", 0, 100, std::nullopt, "exponent; larger is darker towards grazing angles"}},
                .traits = {}},
      .kernel = "minnaert",
      .typical = {1},
      .coefficients =
          [](Values v) {
            return Coefficients{cosine_lobe_constant(v[0]), v[0]};
          },
      .shape = [](Values v) -> LobeShape { return {.width = half_lobe_width(2 * v[0])}; },
      .proposal = [](Values v, const draw::Scene&) -> draw::Parts { return {draw::power(draw::kNormal, v[0] + 1)}; },
      .known = KnownValues{"minnaert:k=0.5",
                           {0.39788735772973838, 0.5},
                           {0.35772420581373421, 0.27435004948316677, 0.26529104843819912, 0.13449505162805858}}};
}

}  // namespace lobe
