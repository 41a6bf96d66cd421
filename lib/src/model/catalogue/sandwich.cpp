#include "model/entry.hpp"

namespace lobe {

CatalogueEntry sandwich_entry() {
  return {.model = {.name = "sandwich",
                    .family = "sandwich",
                    .formula = "1/pi / (2 + k (1/N.L + 1/N.V))^n",
                    .source =
                        "Neumann 2001, eq. 1.62 and 1.63 over Lambert: infinitely many layers of lacquer and flecks; k "
                        "is the ratio of what a layer absorbs to what it reflects, the inverse of what the text says",
                    .parameters = {{"k", "1", 0, 1e4, std::nullopt, "absorbed by reflected light of a layer"},
                                   {"n", "1", 0, 20, 1.0, "order: flecks that are sandwiches themselves"}},
                    .traits = {}},
          .kernel = "sandwich",
          .typical = {1, 1},
          .coefficients =
              [](Values v) {
                return Coefficients{1 / pi, v[0], v[1]};
              },
          .proposal = draw::diffuse,
          .known = KnownValues{
              "sandwich:k=30,n=3",
              {0.31830988618379069, 30, 3},
              {9.7930788957954102e-07, 4.4421309957897603e-07, 3.3056836019310176e-07, 5.4641935242289218e-08}}};
}

}  // namespace lobe
