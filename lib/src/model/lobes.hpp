#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "hemisphere/mirror_panels.hpp"
#include "lobe/model/material.hpp"
#include "model/delta.hpp"

namespace lobe {

/// The distinct lobes of a set of materials and how the materials are made of them:
/// f_material = sum over lobes of mix[channel](material, lobe) * f_lobe. Everything that is linear or bilinear in the
/// reflectance is computed for lobes and then mixed.
struct LobeSet {
  std::vector<LobeBatch> batches;  ///< lobes grouped by kernel; their order is the order of the columns of mix
  std::vector<std::string> names;  ///< of lobes, for messages: "ward(m=0.2)"
  /// materials x lobes, one matrix per channel
  std::vector<Eigen::SparseMatrix<double, Eigen::RowMajor>> mix;
  /// Delta parts among the lobes: the last ones, not in any batch.
  std::vector<DeltaLobe> deltas;
  /// Smallest width of the lobes without delta parts about the mirror direction, in radians of the half-vector, in (0,
  /// 1]; about the retro direction of half the angle between L and V, 1 without such lobes.
  double narrowest = 1;
  double narrowest_retro = 1;
  /// How many times longer than wide the most drawn out anisotropic lobe is, but for those in a norm of the base plane;
  /// 0 where all are isotropic.
  double aspect = 0;
  /// Names of lobes whose norms under point, daylight and patch lights are infinite.
  std::vector<std::string> infinite;
  /// Base-plane distances from the mirror direction at which lobes jump (4.2), rising, each once; the same from the
  /// retro direction.
  std::vector<double> patch_radii;
  std::vector<double> retro_patch_radii;
  bool has_fractional_edge = false;  ///< see LobeShape
  /// Edges of anisotropic lobes, and norms that have kinks, about both directions, each once.
  std::vector<PatchEdge> patch_edges;
  std::vector<PatchEdge> retro_patch_edges;
  std::vector<bool> is_retro_patch;  ///< by batch: anisotropic, with its edge about the retro direction
  /// By lobe with values in sr^-1: anisotropic, with an edge, or a norm with kinks, about the mirror direction; the
  /// same about the retro direction.
  std::vector<bool> has_mirror_edge;
  std::vector<bool> has_retro_edge;
  bool half_turn = true;                              ///< half a turn about the normal leaves all lobes the same
  bool both_sides = false;                            ///< see LobeExtent
  bool both_orders = false;                           ///< see LobeExtent
  std::optional<double> mirror_plane = std::nullopt;  ///< see LobeExtent

  /// Where lobes are not smooth beside what the rules know anyway: the least smooth of all.
  std::vector<Kink> kinks;
  std::vector<PeakKink> peak_kinks;  ///< see LobeExtent
  /// The same for panels of one given direction where groups of lobes take rules of their own over the other one: many
  /// more kinks, as these cost nothing on other axes.
  std::vector<Kink> given_kinks;
  std::vector<PeakKink> given_peak_kinks;
  CommonKinks common;
  /// Materials with jumps that no limit of a panel follows: of formulas, where these have too many, or where they
  /// depend on azimuths about the normal.
  std::vector<bool> hides_jumps;
  [[nodiscard]] bool has_hidden_jumps() const { return std::ranges::count(hides_jumps, true) > 0; }

  /// Pieces of the divisors, for pumped lobes.
  std::vector<std::function<unsigned(double cos_i, double cos_o)>> pieces;
  std::vector<Kink> piece_kinks;  ///< see LobeExtent

  /// Cosine of the largest polar angle of both directions that integrals reach to; 0: to the horizon.
  double cos_min = 0;

  /// What tells rules where lobes are narrow and where they are not smooth.
  struct Limits {
    double narrowest = 1;
    double narrowest_retro = 1;
    double aspect = 0;
    std::vector<double> patch_radii;
    std::vector<double> retro_patch_radii;
    std::vector<PatchEdge> patch_edges;
    std::vector<PatchEdge> retro_patch_edges;
    std::vector<Kink> kinks;
    std::vector<std::function<unsigned(double cos_i, double cos_o)>> pieces;
  };
  /// By batch the group that it is in: those of one group take one rule over one direction, at the other one given.
  /// They have the same kinks and edges, or are parts of one material (model/rule_groups.hpp).
  std::vector<std::size_t> group_of_batch;
  std::vector<Limits> group_limits;  ///< by group

  [[nodiscard]] std::size_t lobes() const { return names.size(); }
  /// Lobes with values in sr^-1.
  [[nodiscard]] std::size_t smooth_lobes() const { return names.size() - deltas.size(); }
  [[nodiscard]] std::size_t channels() const { return mix.size(); }
  [[nodiscard]] LobeExtent extent() const {
    return {narrowest,   patch_radii,        narrowest_retro, retro_patch_radii, pieces,       aspect,
            patch_edges, retro_patch_edges,  half_turn,       both_sides,        mirror_plane, cos_min,
            kinks,       has_hidden_jumps(), peak_kinks,      both_orders,       piece_kinks,  common};
  }
  /// The extent for panels of the given direction where groups have rules of their own over the other one.
  [[nodiscard]] LobeExtent given_extent() const {
    LobeExtent all = extent();
    all.kinks = given_kinks;
    all.peak_kinks = given_peak_kinks;
    return all;
  }
  /// The extent of the lobes of one group alone, for integrals over one of both directions.
  [[nodiscard]] LobeExtent extent_of_group(std::size_t group) const;
  /// Whether anisotropic lobes, or norms, have edges about the mirror direction and others about the retro direction.
  [[nodiscard]] bool has_opposite_patches() const { return !patch_edges.empty() && !retro_patch_edges.empty(); }
  /// The lobes of these numbers, rising, all delta parts among them; without materials. Limits stay those of the whole
  /// set.
  [[nodiscard]] LobeSet selected(std::span<const Eigen::Index> wanted) const;
  /// The smallest of all widths.
  [[nodiscard]] double sharpest() const { return std::min(narrowest, narrowest_retro); }
};

/// Kinds of lobes that a computation accepts beside isotropic ones with values in sr^-1.
struct LobeKinds {
  bool with_deltas = false;
  bool with_anisotropic = false;
};

/// \throws ArgumentError when there is no material, a material has no term, or channel counts do not fit: every
///   material has one channel or the largest number among them. NumericError for delta parts and anisotropic models
///   unless they are wanted.
[[nodiscard]] LobeSet make_lobe_set(std::span<const Material> materials, LobeKinds kinds = {});

}  // namespace lobe
