#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "hemisphere/gauss.hpp"
#include "hemisphere/kink.hpp"
#include "hemisphere/patch_edge.hpp"

namespace lobe {

/// A kink of a narrow lobe, or of a mirror with its factors, that the mirror direction may cross.
struct PeakKink {
  Kink kink;
  double width = 0;  ///< half-vector width of the lobe, radians; 0 of a mirror
};

/// Extent of a set of lobes, as quadrature must know it: how narrow they are and where they jump.
struct LobeExtent {
  double width = 1;                 ///< smallest half-vector width, radians, in (0, 1]
  std::vector<double> patch_radii;  ///< base-plane distances from the mirror direction at which lobes jump (4.2)
  /// Width about the retro direction: half the smallest angle between L and V over which a retro-reflecting lobe falls
  /// off, radians, in (0, 1]; 1 without such lobes.
  double retro_width = 1;
  std::vector<double> retro_patch_radii;  ///< base-plane distances from the retro direction at which lobes jump (4.29)
  /// Factors of lobes that depend on both elevations alone and have kinks: each a function of N.L and N.X that tells
  /// its smooth pieces apart by number.
  std::vector<std::function<unsigned(double cos_i, double cos_o)>> pieces = {};
  /// How many times longer than wide anisotropic lobes are, but for those of which the rules know the norm; 0: all are
  /// isotropic.
  double aspect = 0;
  /// Where anisotropic lobes jump, or what norm they depend on, about the mirror direction and about the retro
  /// direction.
  std::vector<PatchEdge> patch_edges = {};
  std::vector<PatchEdge> retro_patch_edges = {};
  bool half_turn = true;    ///< half a turn about the normal leaves all lobes the same
  bool both_sides = false;  ///< lobes are not the same for -phi_d, with or without another phi_h
  /// Azimuth (radians) of a vertical plane whose mirror image leaves all lobes the same, like that of the plane across,
  /// where some are anisotropic.
  std::optional<double> mirror_plane = std::nullopt;
  /// Cosine of the largest polar angle of both directions that integrals reach to; 0: to the horizon.
  double cos_min = 0;
  /// Where else lobes are not smooth, beside the limits that the rules have anyway.
  std::vector<Kink> kinks = {};
  bool hides_jumps = false;  ///< lobes jump where no limit of a panel is
  /// Kinks of narrow lobes, which `kinks` has, too, and of mirrors, which it does not have.
  std::vector<PeakKink> peak_kinks = {};
  bool both_orders = false;  ///< some lobes are not the same with L and V exchanged
  /// Where the factors that `pieces` tells of go over from one piece to the next, beside N.L = N.V: for rules of pairs.
  std::vector<Kink> piece_kinks = {};
  /// All where nothing is known, and for rules that compare levels: cube roots, which some metrics take, and edges of
  /// patches that end as a small power need their limits even where lobes have no such kink.
  CommonKinks common = CommonKinks::all();
};

/// The extent of the lobes f(V, L).
[[nodiscard]] LobeExtent exchanged(LobeExtent extent);

/// The isotropic pair at two elevations above the horizon and an azimuth psi from the mirror direction.
[[nodiscard]] KinkPair kink_pair(double elevation_i, double elevation_o, double psi);

/// Elevations of L, of those between limits, at which its mirror direction crosses a kink; roots for mirrors.
[[nodiscard]] std::vector<PanelEdge> peak_crossings(const PeakKink& peak, std::span<const PanelEdge> limits);

/// Elevations of L at which kinks reach the horizon or the normal of V or leave them, between limits that are there:
/// there integrals over V are not smooth in L. Where the mirror direction of L crosses a kink of a lobe, its integrals
/// bend within its width: panels shrink towards there.
/// \param lowest elevation of the horizon, above 0 in a smaller domain
void add_kink_slabs(const LobeExtent& extent, double lowest, std::vector<PanelEdge>& edges);

/// Panels of the elevation of X (radians, [0, pi/2]) for integrals of f(L, X) over the hemisphere of X, at an elevation
/// of L: they shrink geometrically towards the elevation of L and end on the horizon or where the domain does, wherever
/// a kink of azimuth_panels() begins or ends, and where one piece of a factor ends.
[[nodiscard]] std::vector<PanelEdge> elevation_panels(double incident, const LobeExtent& extent);

/// Panels of psi in [0, pi], the azimuth of X from the mirror direction of L, at given elevations of both: limits on
/// the kinks of the lobes, on L.X = N.L N.X and on the edges of patches; panels shrink towards psi = 0 in proportion to
/// N.L + N.X, and towards psi = pi for retro-reflecting lobes, with a limit on L.X = 0.
[[nodiscard]] std::vector<PanelEdge> azimuth_panels(double incident, double elevation, const LobeExtent& extent);

}  // namespace lobe
