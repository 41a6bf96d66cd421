#include "model/entry.hpp"

namespace lobe {

CatalogueEntry blinn_entry() {
  return {
      .model =
          {.name = "blinn",
           .family = "Blinn",
           .formula = "C(n) (N.H)^n",
           .source =
               "Neumann 2001, eq. 1.34 (Blinn 1977); C(n) in closed form, so that the albedo at normal incidence is 1",
           .parameters = {exponent()},
           .traits = {}},
      .kernel = "blinn",
      .typical = {40},
      .coefficients =
          [](Values v) {
            return Coefficients{blinn_constant(v[0]), v[0]};
          },
      .shape = [](Values v) -> LobeShape { return {.width = half_lobe_width(v[0])}; },
      .proposal = draw::power_facets,
      .known = KnownValues{"blinn:n=8",
                           {0.59220443941170364, 8},
                           {0.57853302060869982, 0.06682632249867973, 0.095739196973937277, 0.58292403321478992}}};
}

}  // namespace lobe
