#include "model/entry.hpp"
#include "model/family/trowbridge.hpp"

namespace lobe {

CatalogueEntry cook_torrance_trowbridge_entry() {
  return {.model = {.name = "cook_torrance_trowbridge",
                    .family = "Cook-Torrance",
                    .formula = "q^2 / (4 pi (1+(q^2-1) cos^2 delta)^2) G F / (N.L N.V), cos delta = N.H, G = min(1, 2 "
                               "N.H N.L/L.H, 2 N.H N.V/L.H), F = f0 + (1-f0)(1-L.H)^5",
                    .source = "Neumann 2001, eq. 1.35 and 1.37 with the distribution of Trowbridge and Reitz 1975, "
                              "normalised; F = 1 by default, else Schlick's approximation",
                    .parameters = {axis_ratio(), normal_reflectance()},
                    .traits = {}},
          .kernel = "cook_torrance_trowbridge",
          .typical = {0.2, 1},
          .coefficients = trowbridge_coefficients_with_schlick,
          .shape = [](Values v) -> LobeShape { return {.width = v[0], .common = {.attenuation = true}}; },
          .proposal = draw::trowbridge_facets,
          .known = KnownValues{"cook_torrance_trowbridge:q=0.3,f0=0.04",
                               {0.0071619724391352897, 0.089999999999999997, 0.040000000000000001, 0.95999999999999996},
                               {0.039033947093578873, 0.00269848608804366, 0.002891225035397323, 1.1498832558596268}}};
}

}  // namespace lobe
