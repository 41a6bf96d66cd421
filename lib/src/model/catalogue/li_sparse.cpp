#include "model/entry.hpp"

namespace lobe {
namespace {

/// Above 0 where crowns do not shade each other, cos t = 1 (li_sparse.clh).
double crowns_apart(const Kink::Numbers& c, const KinkPair& pair) {
  const double sin_i = std::sqrt(std::max(0.0, (1 - pair.cos_i) * (1 + pair.cos_i)));
  const double sin_o = std::sqrt(std::max(0.0, (1 - pair.cos_o) * (1 + pair.cos_o)));
  const double product = pair.cos_i * pair.cos_o;
  const double sum = pair.cos_i + pair.cos_o;
  const double difference = pair.cos_i - pair.cos_o;
  const double sines = sin_o - sin_i;
  const double apart = 1 - pair.cos_between;
  const double p = std::max(0.0, apart - (difference * difference + sines * sines) / 2);
  const double q = std::max(0.0, 1 + pair.cos_between - (sum * sum + sines * sines) / 2);
  const double secants = std::sqrt(pair.cos_i * pair.cos_i + c[1] * sin_i * sin_i) * pair.cos_o +
                         std::sqrt(pair.cos_o * pair.cos_o + c[1] * sin_o * sin_o) * pair.cos_i;
  const double distance2 = difference * difference + std::max(0.0, 2 * product * apart) + c[1] * p * q;
  return c[0] * std::sqrt(distance2) - secants;
}

}  // namespace

CatalogueEntry li_sparse_entry() {
  return {
      .model = {.name = "li_sparse",
                .family = "Ross-Li",
                .formula = "1/pi (O - sec L' - sec V' + (1 + cos xi') sec L' sec V'/2), O = (t - sin t cos t) (sec L' "
                           "+ sec V')/pi, cos t = min(1, h_b sqrt(D^2 + (tan L' tan V' sin phi)^2) / (sec L' + sec "
                           "V')), tan X' = b_r tan(theta_X), D^2 = tan^2 L' + tan^2 V' - 2 tan L' tan V' cos phi, cos "
                           "xi' = cos L' cos V' + sin L' sin V' cos phi, phi = phi_V - phi_L",
                .source =
                    "Lucht, Schaaf, Strahler 2000, eq. 39 to 44 (Wanner, Li, Strahler 1995): reciprocal geometric "
                    "kernel, a reflectance factor there, hence 1/pi here; its mean albedo is the white-sky albedo of "
                    "the kernel, -1.3776579 by default, not -1.377622. Mostly negative; it grows as 1/(N.L) at grazing "
                    "angles, so that norms are infinite (the albedo does not for b_r = 1, but is out of reach, too)",
                .parameters = {{"h_b", "1", 0.1, 10, 2.0, "height of the crowns over their vertical radius"},
                               {"b_r", "1", 0.1, 10, 1.0, "vertical over horizontal radius of the crowns"}},
                .traits = {.conserves_energy = false, .non_negative = false}},
      .kernel = "li_sparse",
      .typical = {2, 1},
      .coefficients =
          [](Values v) {
            return Coefficients{1 / pi, v[0] * v[1], v[1] * v[1]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.retro_width = std::clamp(0.25 / (v[0] * v[1]), 1e-3, 0.5),
                .has_infinite_norm = true,
                .kinks = std::vector<Kink>{{crowns_apart, {v[0] * v[1], v[1] * v[1]}, 1.5}}};
      },
      .proposal = draw::limb,
      .known = KnownValues{"li_sparse:h_b=2,b_r=1.8",
                           {0.31830988618379069, 3.6000000000000001, 3.2400000000000002},
                           {-0.52241899462066854, -0.29314413729845051, -0.52254176457379131, -2.9375546463165332}}};
}

}  // namespace lobe
