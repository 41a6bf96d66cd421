#include "model/entry.hpp"
#include "model/family/base_plane.hpp"

namespace lobe {
namespace {

/// \param v R, inner, rise
Coefficients patch_band_coefficients(Values v) {
  const double inner = v[0] * v[1];
  const double width = v[0] - inner;
  const double slope = 2 * (2 * v[2] - 1) / (width * width);
  return {(2 * (1 - v[2]) / width - slope * inner) / pi, slope / pi, inner, v[0]};
}

/// The constant of a basic patch has a kink at a radius of 1.
std::vector<Kink> patch_band_kinks(Values v) {
  if (v[0] <= 1 || inner_radius(v) >= 1) return {};
  return {distance_kink(1, 2)};
}

}  // namespace

CatalogueEntry patch_band_entry() {
  return {.model = {.name = "patch_band",
                    .family = "patch mixture",
                    .formula = "integral of p(t) / (pi min(1,t^2)) over t from max(m, rR) to R, m = |V_P-L'_P|",
                    .source = "Neumann 2001, eq. 4.20 and 4.40 with c(R) of 4.7, by which 4.40 as printed multiplies: "
                              "basic patches mixed by a density p that is linear from rR to R, p(rR) : p(R) = 1-q : q; "
                              "the 'mixture' of a study file is a sum of these",
                    .parameters = {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt,
                                    "largest radius in the base plane; smaller is sharper"},
                                   {"inner", "1", 1e-3, 0.999, std::nullopt, "r, the smallest radius by R"},
                                   {"rise", "1", 0, 1, 0.5, "q, share of the density at R; 0.5 is uniform"}},
                    .traits = {}},
          .kernel = "patch_band",
          .typical = {0.4, 0.0446, 0.5},
          .coefficients = patch_band_coefficients,
          .shape = [](Values v) -> LobeShape {
            return {.width = std::min({1.0, v[0] / 2, 1.5 * inner_radius(v)}),
                    .patch_radius = v[0],
                    .inner_patch_radius = inner_radius(v),
                    .kinks = patch_band_kinks(v)};
          },
          .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
            const double radius = v[0];
            const double inner = v[0] * v[1];
            const auto profile = [=](double m) { return std::max(1 / std::max(m, inner) - 1 / radius, 0.0); };
            const auto make = [&] { return draw::bounded_table(profile, inner, radius); };
            return {draw::patch_mixture(draw::mirror_of(scene.light), draw::known_table(v, make))};
          },
          .known = KnownValues{"patch_band:R=1.5,inner=0.4,rise=0.2",
                               {0.8488263631567754, -0.47157020175376407, 0.60000000000000009, 1.5},
                               {0.45467590512648132, 0.069175916711986252, 0.097951938110739573, 0.45467590512648132}}};
}

}  // namespace lobe
