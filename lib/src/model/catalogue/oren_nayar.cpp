#include "model/entry.hpp"

namespace lobe {

CatalogueEntry oren_nayar_entry() {
  return {
      .model =
          {.name = "oren_nayar",
           .family = "Oren-Nayar",
           .formula = "1/pi (A + B max(0, L.V - N.L N.V) / max(N.L, N.V)), A = 1 - 0.5 s^2/(s^2+a), B = 0.45 "
                      "s^2/(s^2+0.09), s = sigma",
           .source =
               "Neumann 2001, eq. 1.56 (Oren and Nayar 1994), simplified model at reflectance 1; sign of N.L N.V "
               "corrected, and a = 0.33 as published where the text prints 1/2. Albedo up to 1.015 at grazing angles",
           .parameters = {{"sigma", "rad", 0, pi / 2, std::nullopt, "standard deviation of the facets' slope angle"},
                          {"a_denominator", "1", 0.01, 10, 0.33, "constant a in the denominator of A"}},
           .traits = {.conserves_energy = false}},
      .kernel = "oren_nayar",
      .typical = {0.2, 0.33},
      .coefficients =
          [](Values v) {
            const double s2 = v[0] * v[0];
            return Coefficients{(1 - 0.5 * s2 / (s2 + v[1])) / pi, 0.45 * s2 / (s2 + 0.09) / pi};
          },
      .proposal = draw::diffuse,
      .known = KnownValues{"oren_nayar:sigma=0.2,a_denominator=0.33",
                           {0.30110394639007226, 0.044073676548524877},
                           {0.30110394639007226, 0.31164103653478875, 0.30902637242231751, 0.30110394639007226}}};
}

}  // namespace lobe
