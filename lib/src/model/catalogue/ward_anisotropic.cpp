#include "model/entry.hpp"
#include "model/family/azimuths.hpp"

namespace lobe {

CatalogueEntry ward_anisotropic_entry() {
  const auto roughness_along = [](std::string_view name, std::string_view axis) -> Parameter {
    return {name, "1", 1e-5, 100, std::nullopt, axis};
  };
  return {
      .model = {.name = "ward_anisotropic",
                .family = "Ward",
                .formula = "exp(-(u/m_x)^2-(v/m_y)^2) / (4 pi m_x m_y sqrt(N.L N.V)), (u, v) the slopes H_x/H_z, "
                           "H_y/H_z along the axes of the lobe",
                .source = "Neumann 2001, eq. 1.46 and 1.47 (Ward 1992) with the exponent of 1.47, of which 1.48 is an "
                          "approximation; the albedo diverges as (N.L)^-1/2 at grazing angles",
                .parameters = {roughness_along("m_x", "rms slope along the first axis; smaller is sharper"),
                               roughness_along("m_y", "rms slope across; smaller is sharper"), rotation()},
                .traits = {.isotropic = false, .conserves_energy = false}},
      .kernel = "ward_anisotropic",
      .typical = {0.1, 0.3, 0.4},
      .coefficients =
          [](Values v) {
            const Axis axis(v[2]);
            return Coefficients{1 / (4 * pi * v[0] * v[1]), axis.cosine / v[0], axis.sine / v[0], -axis.sine / v[1],
                                axis.cosine / v[1]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min({1.0, v[0], v[1]}),
                .aspect = aspect_of(v[0], v[1]),
                .both_sides = false,
                .mirror_plane = v[2]};
      },
      .proposal = [](Values v, const draw::Scene&) -> draw::Parts { return {draw::beckmann(v[0], v[1], v[2])}; },
      .known = KnownValues{"ward_anisotropic:m_x=0.05,m_y=0.5,rotation=0",
                           {3.183098861837907, 20, 0, -0, 2},
                           {0.86098325785974872, 0.082308084377900312, 8.7435401918917888e-25, 9.0890999388195866}}};
}

}  // namespace lobe
