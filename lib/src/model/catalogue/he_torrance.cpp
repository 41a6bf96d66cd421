#include "model/entry.hpp"
#include "model/family/diffraction.hpp"

namespace lobe {

CatalogueEntry he_torrance_entry() {
  return {
      .model =
          {.name = "he_torrance",
           .family = "He-Torrance",
           .formula = "F(ior, k, L.H) (2 L.H/N.H)^2 S(N.L) S(N.V) D / (pi N.L N.V), D = (pi tau/2)^2 sum_m e^-g g^m / "
                      "(m! m) exp(-(pi tau |V_P-L'_P|)^2 / m), g = (2 pi s (N.L+N.V))^2, s = sigma / sqrt(1+z^2), z "
                      "exp(z^2/2) = (K(N.L)+K(N.V)) / sqrt(8 pi), K = tan erfc(c), S = (1 - erfc(c)/2) / (1 + "
                      "(1/(sqrt(pi) c) - erfc(c))/2), c = tau cot/(2 sigma), lengths in wavelengths",
           .source =
               "He, Torrance, Sillion, Greenberg 1991, eq. 24, 25, 76 and 78 to 84: directional-diffuse part, "
               "unpolarised, isotropic; G of eq. 76 is (2 L.H/N.H)^2. S as printed (Smith's has a factor exp(-c^2) "
               "more). The ideal specular part, F e^-g S of a mirror, and the uniform-diffuse one are not in it",
           .parameters = {surface_height(), surface_correlation(), refractive_index(), extinction()},
           .traits = {}},
      .kernel = "he_torrance",
      .typical = {0.2, 2, 1.58, 0},
      .coefficients =
          [](Values v) {
            const double lobe = pi * v[1];
            const double phase = 4 * pi * pi * v[0] * v[0];
            return Coefficients{lobe * v[1],
                                lobe * lobe,
                                phase,
                                2 * v[0] / v[1],
                                v[2],
                                v[3],
                                static_cast<double>(roughness_terms(4 * phase))};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, 1 / (2 * pi * v[1])), .kinks = critical_kinks(v[2], v[3])};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        return {draw::with_share(0.8, diffraction_patch(draw::mirror_of(scene.light), v[0], v[1])),
                draw::with_share(0.2, draw::cosine())};
      },
      .known = KnownValues{"he_torrance:sigma=0.3,tau=1,ior=2,k=0",
                           {3.1415926535897931, 9.869604401089358, 3.5530575843921688, 0.59999999999999998, 2, 0, 61},
                           {0.028753696028062291, 0.013152133439303649, 0.017308659855903331, 0.15242266341072686}}};
}

}  // namespace lobe
