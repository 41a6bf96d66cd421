#pragma once

/// Distributions that directions are drawn from, as parts that entries of the catalogue combine.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "device/draw_directions.hpp"
#include "lobe/model/sampling_strategy.hpp"

namespace lobe {

/// One per parameter of a model.
using Values = std::span<const double>;

namespace draw {

/// Their shares sum to 1.
using Parts = std::vector<ProposalPart>;

/// Situation for which a density is wanted.
struct Scene {
  UnitVector light;
  PatchDraw patches;
};

inline constexpr UnitVector kNormal{0, 0, 1};

[[nodiscard]] UnitVector mirror_of(const UnitVector& light);
/// X_S of the light, mirrored, on the sphere within the hemisphere (1.69).
[[nodiscard]] UnitVector inner_mirror(const UnitVector& light);

// Densities, each with all of the share.

[[nodiscard]] ProposalPart cosine();
/// A power of the cosine about an axis of any length but 0.
[[nodiscard]] ProposalPart power(const UnitVector& axis, double n, bool on_inner_sphere = false);
/// Uniform density over the hemisphere, for reflectances that stay above 0 down to the horizon.
[[nodiscard]] ProposalPart uniform();
[[nodiscard]] ProposalPart beckmann(double m_x, double m_y, double rotation);
[[nodiscard]] ProposalPart cosine_facets(double n_u, double n_v, double rotation);
[[nodiscard]] ProposalPart visible_facets(const UnitVector& light, double a_x, double a_y, double rotation);
[[nodiscard]] ProposalPart visible_facets(const UnitVector& light, double a);
[[nodiscard]] ProposalPart patch(const UnitVector& centre, double radius, PatchDraw draw);

/// What a density that falls with the distance in the base plane looks up, for any centre: radii, the shares of the
/// directions within them, and densities.
/// \param profile falling with the distance, taken as linear between some radii
/// \param scale over which it falls
[[nodiscard]] NumberTable mixture_table(const std::function<double(double)>& profile, double scale);
/// \param profile with kinks at `inner` and at `radius`, from where on it is 0
[[nodiscard]] NumberTable bounded_table(const std::function<double(double)>& profile, double inner, double radius);

/// The last few tables that a thread has needed for one kind of profile. They depend on parameters alone, and take
/// longer than many directions that are drawn from them.
class KnownTables {
 public:
  /// \param make called where no table is known for these parameters
  [[nodiscard]] NumberTable table(Values parameters, const std::function<NumberTable()>& make);

 private:
  struct Known {
    std::vector<double> parameters;
    NumberTable table;
  };
  std::vector<Known> known_;
  std::size_t next_ = 0;  ///< to be forgotten
};

/// make(), or what a function of its type gave for the same parameters before.
template <typename Make>
[[nodiscard]] NumberTable known_table(Values parameters, const Make& make) {
  thread_local KnownTables tables;
  return tables.table(parameters, make);
}

[[nodiscard]] ProposalPart patch_mixture(const UnitVector& centre, const NumberTable& table);

/// \param parameters on which the profile and its scale depend, and nothing else
template <typename Profile>
[[nodiscard]] ProposalPart patch_mixture(const UnitVector& centre, Values parameters, const Profile& profile,
                                         double scale) {
  return patch_mixture(centre, known_table(parameters, [&] { return mixture_table(profile, scale); }));
}
[[nodiscard]] ProposalPart exponential_patch(const UnitVector& centre, double s);

[[nodiscard]] ProposalPart with_share(double share, ProposalPart part);

// Proposals.

/// For what nothing more is known of than how wide it is.
[[nodiscard]] Parts general(const UnitVector& light, double width, double retro_width);
/// A distribution with a longer tail than that of Trowbridge and Reitz.
[[nodiscard]] Parts long_tail(const UnitVector& light, double a);

// Proposals of several models, as CatalogueEntry::proposal; what they take from the values comes first in these.

[[nodiscard]] Parts diffuse(Values v, const Scene& scene);
/// Such as 1/(N.L + N.V): at grazing incidence much the same for all directions.
[[nodiscard]] Parts limb(Values v, const Scene& scene);
/// \param v n
[[nodiscard]] Parts mirror_power(Values v, const Scene& scene);
/// \param v m
[[nodiscard]] Parts beckmann_facets(Values v, const Scene& scene);
/// \param v n
[[nodiscard]] Parts power_facets(Values v, const Scene& scene);
/// D N.H of a distribution (N.H)^n.
/// \param v n
[[nodiscard]] Parts power_facets_with_cosine(Values v, const Scene& scene);
/// exp(-delta^2/m^2), which falls more slowly than Beckmann's distribution.
/// \param v m
[[nodiscard]] Parts gaussian_facets(Values v, const Scene& scene);
/// \param v axis ratio
[[nodiscard]] Parts trowbridge_facets(Values v, const Scene& scene);
/// \param v roughness, the square of the axis ratio
[[nodiscard]] Parts schlick_facets(Values v, const Scene& scene);
/// \param v s
[[nodiscard]] Parts exponential(Values v, const Scene& scene);

}  // namespace draw
}  // namespace lobe
