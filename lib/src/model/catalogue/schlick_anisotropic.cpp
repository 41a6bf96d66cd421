#include "model/entry.hpp"
#include "model/family/azimuths.hpp"

namespace lobe {

CatalogueEntry schlick_anisotropic_entry() {
  return {
      .model = {.name = "schlick_anisotropic",
                .family = "Schlick",
                .formula = "r A / (4 pi (1-(1-r)(N.H)^2)^2 (r+(1-r) N.L) (r+(1-r) N.V)), A = sqrt(p / (p^2+(1-p^2) "
                           "w^2)), w the cosine of the azimuth of H from the lobe's first axis",
                .source = "Neumann 2001, eq. 1.49 and 1.50 (Schlick 1994). At H = N, where A has no limit, w is 0. The "
                          "albedo exceeds 1 at grazing angles for small r, as of schlick",
                .parameters = {{"r", "1", 1e-10, 1, std::nullopt, "roughness; smaller is sharper"},
                               {"p", "1", 1e-3, 1, std::nullopt,
                                "isotropy; smaller is more drawn out across the first axis"},
                               rotation()},
                .traits = {.isotropic = false, .conserves_energy = false}},
      .kernel = "schlick_anisotropic",
      .typical = {0.05, 0.4, 0.4},
      .coefficients =
          [](Values v) {
            const Axis axis(v[2]);
            return Coefficients{v[0] / (4 * pi), v[0], 1 - v[0], v[1], (1 - v[1]) * (1 + v[1]), axis.cosine, axis.sine};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::sqrt(v[0]), .aspect = 1 / v[1], .both_sides = false, .mirror_plane = v[2]};
      },
      .proposal = draw::schlick_facets,
      .known = KnownValues{"schlick_anisotropic:r=0.0001,p=0.1,rotation=0.6",
                           {7.9577471545947669e-06, 0.0001, 0.99990000000000001, 0.10000000000000001,
                            0.9900000000000001, 0.82533561490967833, 0.56464247339503537},
                           {0.29824475198847999, 5.7675985020969575e-05, 0.00031654734035920542, 2.0500587307565703}}};
}

}  // namespace lobe
