#include "model/entry.hpp"

namespace lobe {
namespace {

/// The fit R to the share of uniform light that goes to V: a Gaussian of N.V, and what is added.
struct SheenFit {
  explicit SheenFit(double y)
      : width(y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y))),
        middle(y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y)),
        rest(std::max(0.0, y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y))) *
             width * std::sqrt(2 * pi)) {}
  double width, middle;
  double rest;  ///< relative to the Gaussian's peak
};

}  // namespace

CatalogueEntry zeltner_sheen_entry() {
  return {
      .model = {.name = "zeltner_sheen",
                .family = "sheen",
                .formula = "R/pi (a / |(a L_x + b L_z, a L_y, L_z)|^2)^2, the x axis along V; R = exp(-(x - m)^2/(2 "
                           "s^2)) / (s sqrt(2 pi)) + max(0, o), x = N.V, y = alpha, s = y (0.0206607 + 1.58491 y) / "
                           "(0.0379424 + y (1.32227 + y)), m = y (-0.193854 + y (-1.14885 + y (1.7932 - 0.95943 y^2))) "
                           "/ (0.046391 + y), o = y (0.000654023 + (-0.0207818 + 0.119681 y) y) / (1.26264 + y "
                           "(-1.92021 + y)), a = (2.58126 x + 0.813703 y) y / (1 + 0.310327 x^2 + 2.60994 x y), b = "
                           "sqrt(1 - x) (y - 1) y^3 / (0.0000254053 + 1.71228 x - 1.71506 x y + 1.34174 y^2)",
                .source = "Zeltner, Burley, Chiang 2022: a linearly transformed cosine of L for each elevation of V, "
                          "not reciprocal. The fits to their tables are those of MaterialX (mx_microfacet_sheen.glsl) "
                          "and OpenPBR, but o, which falls to -2.1e-5 between alpha = 0.041 and 0.132, is not below 0. "
                          "R, at most 0.75, is the reflectance of uniform light towards V; albedos of light from L are "
                          "above 1 at grazing angles for alpha < 0.32, up to 5.2. The authors print the formula with "
                          "the directions exchanged, and compute this one",
                .parameters = {{"alpha", "1", 0.01, 1, std::nullopt, "roughness; smaller is nearer to grazing"}},
                .traits = {.reciprocal = false, .conserves_energy = false}},
      .kernel = "zeltner_sheen",
      .typical = {0.5},
      .coefficients =
          [](Values v) {
            const double y = v[0];
            const SheenFit fit(y);
            return Coefficients{1 / (pi * fit.width * std::sqrt(2 * pi)),
                                -1 / (2 * fit.width * fit.width),
                                fit.middle,
                                fit.rest,
                                2.58126 * y,
                                0.813703 * y * y,
                                2.60994 * y,
                                (y - 1) * y * y * y,
                                1.71228 - 1.71506 * y,
                                0.0000254053 + 1.34174 * y * y};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::clamp(v[0], 0.05, 1.0)}; },
      .proposal = draw::limb,
      .known = KnownValues{"zeltner_sheen:alpha=0.5",
                           {0.29644182203844299, -2.7247619500240332, -0.3476845107258355, 0.019611671524268112,
                            1.2906299999999999, 0.20342574999999999, 1.30497, -0.0625, 0.85475000000000001,
                            0.33546040529999999},
                           {0.0041378900454491262, 0.014994950236841659, 0.014078785911825277, 0.17505000239105606}}};
}

}  // namespace lobe
