#include "model/entry.hpp"

namespace lobe {
namespace {

/// Where the attenuation begins, and where the reflectance becomes 0.
std::vector<Kink> bagher_kinks(Values v) {
  std::vector<Kink> kinks;
  const double theta0 = v[6];
  if (theta0 > 0 && v[5] < kSmoothOrder) kinks = cosine_kinks(std::cos(theta0), v[5]);
  const auto reflectance = [&](double cosine) { return v[2] + (1 - v[2]) * std::pow(1 - cosine, 5) - v[3] * cosine; };
  constexpr int kSteps = 32;
  std::vector<PanelEdge> zeros;
  append_zeros(reflectance, std::array<PanelEdge, 2>{{{0}, {1}}}, kSteps, false, zeros);
  for (const PanelEdge& zero : zeros) kinks.push_back(difference_kink(zero.at, 1));
  return kinks;
}

}  // namespace

CatalogueEntry bagher_sgd_entry() {
  return {
      .model = {.name = "bagher_sgd",
                .family = "Bagher",
                .formula =
                    "D F G(theta_L) G(theta_V) / (pi N.L N.V), D = e^-x / (pi alpha Gamma(1-p, alpha) x^p cos^4 "
                    "delta), x = alpha + tan^2 delta/alpha, cos delta = N.H, F = max(0, f0 + (1-f0)(1-L.H)^5 - f1 "
                    "L.H), G = 1 - lambda (e^E - 1), E = ln(1+1/lambda) (max(0, theta-theta0)/(pi/2-theta0))^k",
                .source = "Bagher, Soler, Holzschuch 2012, specular term with the shifted-gamma distribution. Of the "
                          "published constants K normalises D, and c makes G 0 at grazing angles (theirs leave up to "
                          "0.0026 of G there, for which norms would be infinite); both are computed here. f0, f1 and "
                          "the attenuation are fitted, so that the albedo may have any size",
                .parameters = {{"alpha", "1", 1e-5, 10, std::nullopt, "roughness; smaller is sharper"},
                               {"p", "1", 0, 3, std::nullopt, "power of the distribution; larger falls off faster"},
                               {"f0", "1", 0, 10, 1.0, "first parameter of the reflectance"},
                               {"f1", "1", -10, 10, 0.0, "second parameter of the reflectance"},
                               {"lambda", "1", 1e-10, 1e8, 1.0, "shape of the attenuation"},
                               {"k", "1", 1, 1e3, 10.0, "power of the attenuation; larger is nearer to the horizon"},
                               {"theta0", "rad", -pi / 2, 1.5, 0.0, "angle at which the attenuation begins"}},
                .traits = {.conserves_energy = false}},
      .kernel = "bagher_sgd",
      .typical = {0.2, 0.4, 1, 0, 1, 10, 0},
      .coefficients =
          [](Values v) {
            return Coefficients{shifted_gamma_constant(v[0], v[1]) / (pi * pi),
                                v[0],
                                v[1],
                                v[2],
                                1 - v[2],
                                v[3],
                                1 + v[4],
                                std::log1p(1 / v[4]),
                                v[5],
                                1 / (pi / 2 - v[6])};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0]), .kinks = bagher_kinks(v)}; },
      .known =
          KnownValues{
              "bagher_sgd:alpha=0.854048,p=1.40232,f0=0.0346142,f1=-0.0688995,lambda=1.72476,k=5.57044,theta0=0.249637",
              {0.47488376195050558, 0.85404800000000003, 1.40232, 0.034614199999999998, 0.96538579999999996,
               -0.068899500000000002, 2.7247599999999998, 0.45729244047301909, 5.5704399999999996, 0.75691097940925711},
              {0.029998721314439931, 0.024544253975980992, 0.02852401379635296, 0.28242477383947706}}};
}

}  // namespace lobe
