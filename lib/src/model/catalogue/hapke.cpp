#include "model/entry.hpp"

namespace lobe {

CatalogueEntry hapke_entry() {
  return {
      .model =
          {.name = "hapke",
           .family = "Hapke",
           .formula = "w/(4 pi) / (u(L) + u(V)) ((1 + B) P + H(u(L)) H(u(V)) - 1) S, P = (1-b^2)/2 ((1+c) (1 - 2 b "
                      "cos g + b^2)^(-3/2) + (1-c) (1 + 2 b cos g + b^2)^(-3/2)), B = b0/(1 + tan(g/2)/h), g the "
                      "angle between L and V, H(x) = 1/(1 - w x (r0 + (1/2 - r0 x) ln((1+x)/x))), r0 = (1-s)/(1+s), "
                      "s^2 = 1-w; u and S are effective cosines and shadowing for theta_bar, cosines and 1 for 0",
           .source =
               "Hapke 1981, with H of Hapke 2002, eq. 13, and the roughness of Hapke 1984, eq. 46 to 51, "
               "with its signs (chapter 12 of Hapke 2012); the bidirectional reflectance over N.L. Both lobes of the "
               "phase function are those of Henyey and Greenstein; the opposition effect is that of shadows. "
               "Albedo up to 1.83, for w = 1 and a sharp lobe back under a wide opposition effect",
           .parameters = {{"w", "1", 0, 1, std::nullopt, "single-scattering albedo of the particles"},
                          {"b", "1", 0, 0.99, 0.0, "asymmetry of both lobes of the phase function; larger is sharper"},
                          {"c", "1", -1, 1, 0.0, "1 scatters back, -1 ahead"},
                          {"b0", "1", 0, 1, 0.0, "height of the opposition effect"},
                          {"h", "1", 1e-3, 10, 0.05, "width of the opposition effect"},
                          {"theta_bar", "rad", 0, 1.2, 0.0, "mean slope angle of the surface"}},
           .traits = {.conserves_energy = false}},
      .kernel = "hapke",
      .typical = {0.4, 0.25, 0.3, 0.8, 0.06, 0.35},
      .coefficients =
          [](Values v) {
            constexpr double kFlat = 1e-12;  // below which no facet is seen
            const double root = std::sqrt(1 - v[0]);
            const double slope = std::tan(v[5]);
            return Coefficients{v[0] / (4 * pi),
                                v[1],
                                v[2],
                                v[3],
                                1 / v[4],
                                slope,
                                1 / std::sqrt(1 + pi * slope * slope),
                                v[0],
                                (1 - root) / (1 + root),
                                1 / std::max(slope, kFlat)};
          },
      .shape = [](Values v) -> LobeShape {
        const double surge = v[3] > 0 ? v[4] : 1;
        LobeShape shape{.retro_width = std::clamp(std::min(surge, (1 - v[1]) / 2), 1e-3, 0.5)};
        if (v[5] > 0) shape.kinks = {plane_kink(1)};  // it depends on |psi|
        return shape;
      },
      .proposal = draw::limb,
      .known = KnownValues{"hapke:w=0.4,b=0.25,c=0.3,b0=0.8,h=0.06,theta_bar=0.35",
                           {0.031830988618379068, 0.25, 0.29999999999999999, 0.80000000000000004, 16.666666666666668,
                            0.36502849483042454, 0.83959415198948806, 0.40000000000000002, 0.12701665379258309,
                            2.7395121590837834},
                           {0.028339418212741028, 0.035923447808450477, 0.032616189943727225, 0.024278050127104652}}};
}

}  // namespace lobe
