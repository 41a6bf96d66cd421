#include "model/entry.hpp"
#include "model/family/diffraction.hpp"

namespace lobe {

CatalogueEntry stam_entry() {
  return {
      .model = {.name = "stam",
                .family = "Stam",
                .formula = "F(ior, k, L.H) (1+L.V)^2 / (N.L N.V (N.L+N.V)^2) pi tau^2 sum_m e^-g g^m / (m! m) exp(-(pi "
                           "tau |V_P-L'_P|)^2 / m), g = (2 pi sigma (N.L+N.V))^2, lengths in wavelengths",
                .source = "Neumann 2001, eq. 1.51 (Stam 1999), of a Gaussian height field with the autocorrelation "
                          "exp(-r^2/tau^2); 1 - L.V and L - V there have L from the light. No shadowing, so the albedo "
                          "grows as 1/(N.L) at grazing angles and norms are infinite; the ideal mirror is not in it",
                .parameters = {surface_height(), surface_correlation(), refractive_index(), extinction()},
                .traits = {.conserves_energy = false}},
      .kernel = "stam",
      .typical = {0.2, 2, 1.58, 0},
      .coefficients =
          [](Values v) {
            const double lobe = pi * v[1];
            const double phase = 4 * pi * pi * v[0] * v[0];
            return Coefficients{lobe * v[1], lobe * lobe, phase,
                                v[2],        v[3],        static_cast<double>(roughness_terms(4 * phase))};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, 1 / (2 * pi * v[1])),
                .has_infinite_norm = true,
                .kinks = critical_kinks(v[2], v[3])};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        return {draw::with_share(0.8, diffraction_patch(draw::mirror_of(scene.light), v[0], v[1])),
                draw::with_share(0.2, draw::uniform())};
      },
      .known = KnownValues{"stam:sigma=0.18,tau=3,ior=0.82,k=5.99",
                           {28.274333882308138, 88.826439609804225, 1.2791007303811808, 0.81999999999999995,
                            5.9900000000000002, 37},
                           {4.1867210162672519, 2.7787837932123294e-08, 3.2391129739930169e-07, 8.3433784296808025}}};
}

}  // namespace lobe
