#include "model/entry.hpp"

namespace lobe {

CatalogueEntry rpv_entry() {
  return {
      .model = {.name = "rpv",
                .family = "RPV",
                .formula =
                    "rho/pi (N.L N.V (N.L+N.V))^(k-1) (1-T^2)/(1+2 T L.V+T^2)^(3/2) (1 + (1-rho_c)/(1+G)), G^2 = "
                    "tan^2 L + tan^2 V - 2 tan L tan V cos(phi_V-phi_L), T = asymmetry",
                .source =
                    "Rahman, Pinty, Verstraete 1993, soils and vegetation; reflectance factors there, hence 1/pi here. "
                    "The albedo is not bounded at grazing angles for k < 1",
                .parameters = {{"rho", "1", 0, 10, std::nullopt, "amplitude rho_0"},
                               {"k", "1", 0.4, 2, std::nullopt, "below 1 a bowl, above 1 a bell"},
                               {"asymmetry", "1", -0.9, 0.9, std::nullopt,
                                "asymmetry of Henyey and Greenstein, negative for scattering back to the light"},
                               {"rho_c", "1", 0, 1, 1.0, "hot spot: none with 1"}},
                .traits = {.conserves_energy = false}},
      .kernel = "rpv",
      .typical = {0.1, 0.8, -0.1, 0.5},
      .coefficients =
          [](Values v) {
            const double asymmetry = std::abs(v[2]);
            return Coefficients{v[0] * (1 - asymmetry) * (1 + asymmetry) / pi,
                                v[1] - 1,
                                (1 - asymmetry) * (1 - asymmetry),
                                v[2] > 0 ? 4 * asymmetry : 0,
                                v[2] < 0 ? 4 * asymmetry : 0,
                                1 - v[3]};
          },
      .shape = [](Values v) -> LobeShape {
        const double lobe = std::max(0.05, 1 - std::abs(v[2]));
        return {.retro_width = v[3] < 1 ? std::min(0.2, lobe) : v[2] < 0 ? lobe : 1};
      },
      .proposal = draw::limb,
      .known = KnownValues{"rpv:rho=0.2,k=0.6,asymmetry=-0.5,rho_c=0",
                           {0.047746482927568612, -0.40000000000000002, 0.25, 0, 2, 1},
                           {0.12621445470055551, 0.17935166291551261, 0.15598334590247867, 0.053328382283884278}}};
}

}  // namespace lobe
