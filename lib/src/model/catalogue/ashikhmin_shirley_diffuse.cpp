#include "model/entry.hpp"

namespace lobe {

CatalogueEntry ashikhmin_shirley_diffuse_entry() {
  return {
      .model = {.name = "ashikhmin_shirley_diffuse",
                .family = "Ashikhmin-Shirley",
                .formula = "28/(23 pi) (1-f0) (1-(1-N.L/2)^5) (1-(1-N.V/2)^5)",
                .source = "Ashikhmin and Shirley 2000, diffuse term at R_d = 1: what ashikhmin_shirley lets through",
                .parameters = {{"f0", "1", 0, 1, 0.05, "Fresnel reflectance of the surface at normal incidence"}},
                .traits = {}},
      .kernel = "ashikhmin_shirley_diffuse",
      .typical = {0.05},
      .coefficients = [](Values v) { return Coefficients{28 * (1 - v[0]) / (23 * pi)}; },
      .proposal = draw::diffuse,
      .known = KnownValues{"ashikhmin_shirley_diffuse:f0=0",
                           {0.387507687528093},
                           {0.34921500571107106, 0.29785308067107474, 0.27074666034095929, 0.14103047023973678}}};
}

}  // namespace lobe
