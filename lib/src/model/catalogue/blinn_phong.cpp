#include "model/entry.hpp"

namespace lobe {

CatalogueEntry blinn_phong_entry() {
  return {.model = {.name = "blinn_phong",
                    .family = "Blinn-Phong",
                    .formula = "(n+2)/(2 pi) (N.H)^n",
                    .source = "Ngan, Durand, Matusik 2005 (Blinn 1977): the constant of the fits of measured "
                              "materials; albedo above 1 for small n",
                    .parameters = {exponent()},
                    .traits = {.conserves_energy = false}},
          .kernel = "blinn",
          .typical = {40},
          .coefficients =
              [](Values v) {
                return Coefficients{cosine_lobe_constant(v[0]), v[0]};
              },
          .shape = [](Values v) -> LobeShape { return {.width = half_lobe_width(v[0])}; },
          .proposal = draw::power_facets};
}

}  // namespace lobe
