#include "model/lobes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "core/text.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "lobe/core/error.hpp"
#include "model/catalogue.hpp"
#include "model/divisor_pieces.hpp"
#include "model/factors.hpp"
#include "model/formula.hpp"
#include "model/formula_kinks.hpp"
#include "model/formula_tree.hpp"
#include "model/rule_groups.hpp"
#include "model/terms.hpp"
#include "model/traits.hpp"

namespace lobe {
namespace {

/// Each costs a panel more on every axis. Sets of twelve Lafortune lobes with a kink each were within what is stated of
/// them without any limits: what one lobe's levels agree on by accident, others' do not.
constexpr std::size_t kMostKinks = 4;
/// Jumps, of formulas, matter more: without a limit at one the levels agree on what is wrong by a hundredth.
constexpr std::size_t kMostJumps = 8;
/// Most kinks that panels of the given direction end on where groups of lobes have rules of their own over the other
/// one: each costs one or two panels there, and none on other axes.
constexpr std::size_t kMostGivenKinks = 16;
/// Lobes wider than that, in radians of the half-vector, bend no integral more than panels bear.
constexpr double kNarrow = 0.3;

/// "ward(m=0.2) lacquer(s=1)".
std::string describe(const Term& term) {
  const auto with_values = [](std::string_view name, const auto& names, const std::vector<double>& values) {
    std::string text(name);
    for (std::size_t i = 0; i < values.size(); ++i) {
      text += (i == 0 ? "(" : ", ") + std::string(names[i]) + "=" + shortest(values[i]);
    }
    return values.empty() ? text : text + ")";
  };
  std::string text =
      traits_of(term).has_delta ? term.model : with_values(term.model, parameter_names(term), term.values);
  for (const Factor& factor : term.factors) {
    std::vector<std::string_view> names;
    for (const auto& parameter : find_factor(factor.name).parameters) names.push_back(parameter.name);
    text += " " + with_values(factor.name, names, factor.values);
  }
  if (term.pumping) {
    text += " pumped by " + std::string(to_string(term.pumping->correction)) + " " +
            std::to_string(term.pumping->albedos.size()) + " times";
  }
  if (!term.complement_of.empty()) text += " of what an albedo leaves";
  return text;
}

/// A term without delta part, as the rules of quadrature and the device need it.
struct Lobe {
  LobeKernel kernel;
  Coefficients coefficients{};
  std::vector<double> curves;
  std::string name;
  double width = 1;
  double retro_width = 1;
  bool is_infinite = false;
  double aspect = 0;  ///< of isotropic lobes 0
  std::vector<double> patch_radii;
  bool has_fractional_edge = false;
  std::optional<double> retro_patch_radius;
  std::optional<PatchEdge> patch_edge;
  std::optional<PatchEdge> retro_patch_edge;
  bool half_turn = true;
  bool both_sides = false;
  std::optional<double> mirror_plane;
  std::vector<Kink> kinks;
  CommonKinks common;
  bool hides_jumps = false;  ///< some are not among the kinks, or no limit of a rule
};

/// The vertical mirror planes of anisotropic lobes, two each, a quarter of a turn apart.
class MirrorPlanes {
 public:
  void add(std::optional<double> plane) {
    constexpr double kRounding = 1e-14;  // of angles that are the same but for full turns, in radians
    if (!first_) first_ = plane;
    are_shared_ = are_shared_ && plane && std::abs(std::remainder(*plane - *first_, std::numbers::pi / 2)) <= kRounding;
  }
  [[nodiscard]] bool are_shared() const { return are_shared_; }
  /// One of them, where they are shared; none without anisotropic lobes.
  [[nodiscard]] std::optional<double> shared() const { return are_shared_ ? first_ : std::nullopt; }

 private:
  std::optional<double> first_;
  bool are_shared_ = true;
};

/// Largest number of parts in curves that the device takes together, rounded up: each number is a kernel of its own.
std::size_t most_parts(std::span<const std::vector<double>> curves) {
  std::size_t most = 0;
  for (const auto& curve : curves) most = std::max(most, parts_of(curve));
  constexpr std::size_t kLeast = 16;
  return most == 0 ? 0 : std::max(kLeast, std::bit_ceil(most));
}

Lobe lobe_of_formula(const Term& term) {
  const Formula& formula = *term.formula;
  Lobe lobe;
  lobe.kernel = {.model = std::string(kFormulaFunction),
                 .source = formula_source(formula),
                 .is_anisotropic = is_anisotropic(formula)};
  lobe.coefficients[0] = 1;
  std::ranges::copy(term.values, lobe.coefficients.begin() + 1);
  lobe.width = formula.width;
  lobe.aspect = lobe.kernel.is_anisotropic ? 1 : 0;
  lobe.half_turn = !lobe.kernel.is_anisotropic;
  lobe.both_sides = lobe.kernel.is_anisotropic;
  FormulaKinks found = formula_kinks(read_formula_tree(formula), term.values);
  lobe.kinks = std::move(found.kinks);
  lobe.common = CommonKinks::all();  // which may be among those that are too many
  lobe.hides_jumps = found.has_many_steps;
  for (Kink& kink : lobe.kinks) {
    kink.is_of_anisotropic = lobe.kernel.is_anisotropic;
    if (kink.is_anisotropic && kink.is_jump()) lobe.hides_jumps = true;
  }
  return lobe;
}

Lobe lobe_of_model(const Term& term) {
  const CatalogueEntry& entry = find_entry(term.model);
  const auto& values = term.values;
  Lobe lobe;
  lobe.kernel = {.model = std::string(entry.kernel), .is_anisotropic = !entry.model.traits.isotropic};
  lobe.coefficients = entry.coefficients(values);
  LobeShape shape = entry.shape(values);
  lobe.width = shape.width;
  lobe.retro_width = shape.retro_width;
  lobe.is_infinite = shape.has_infinite_norm;
  if (lobe.kernel.is_anisotropic) lobe.aspect = shape.aspect;
  for (const double radius : {shape.inner_patch_radius, shape.patch_radius}) {
    if (radius > 0) lobe.patch_radii.push_back(radius);
  }
  lobe.has_fractional_edge = shape.has_fractional_edge;
  if (shape.retro_patch_radius > 0) lobe.retro_patch_radius = shape.retro_patch_radius;
  lobe.patch_edge = shape.patch_edge;
  lobe.retro_patch_edge = shape.retro_patch_edge;
  if (lobe.patch_edge || lobe.retro_patch_edge) lobe.aspect = 1;  // the rules know the axes
  lobe.half_turn = shape.half_turn;
  lobe.both_sides = lobe.kernel.is_anisotropic && shape.both_sides;
  lobe.mirror_plane = shape.mirror_plane;
  lobe.kinks = std::move(shape.kinks);
  lobe.common = shape.common;
  return lobe;
}

GrazingGrowth growth_of(const std::vector<Factor>& factors) {
  GrazingGrowth sum;
  for (const Factor& factor : factors) {
    const FactorEntry& entry = find_factor_entry(factor.name);
    if (entry.growth == nullptr) continue;
    const GrazingGrowth growth = entry.growth(factor.values);
    sum = {sum.alone + growth.alone, sum.mirror + growth.mirror, sum.retro + growth.retro};
  }
  return sum;
}

bool has_finite_norms(const std::vector<Factor>& factors) {
  return std::ranges::any_of(factors, [](const Factor& factor) {
    const FactorEntry& entry = find_factor_entry(factor.name);
    return entry.makes_norms_finite != nullptr && entry.makes_norms_finite(factor.values);
  });
}

/// A delta part that reflects without bound towards the horizon has neither norms nor a place in a table.
void require_bounded_delta(const Material& material, const Term& term) {
  const GrazingGrowth growth = growth_of(term.factors);
  const double power = term.model == "mirror" ? growth.mirror : growth.retro;
  if (power <= 0 || has_finite_norms(term.factors)) return;
  throw NumericError("material '" + material.name + "' has factors that make the delta part '" + term.model +
                     "' grow as (N.L)^-" + shortest(power) + " towards grazing angles; expected ones that do not");
}

Lobe lobe_of(const Term& term) {
  require_consistent(term);
  Lobe lobe = term.formula ? lobe_of_formula(term) : lobe_of_model(term);
  lobe.name = describe(term);
  auto place = lobe.coefficients.end() - kMaxFactors * kFactorCoefficients;
  for (const Factor& factor : term.factors) {
    const FactorEntry& entry = find_factor_entry(factor.name);
    lobe.kernel.factors.push_back(factor.name);
    place = std::ranges::copy(entry.coefficients(factor.values), place).out;
    if (entry.kinks != nullptr) {
      const auto kinks = entry.kinks(factor.values);
      lobe.kinks.insert(lobe.kinks.end(), kinks.begin(), kinks.end());
    }
  }
  // f ~ (N.L)^-q has a norm for q < 1 only.
  if (growth_of(term.factors).alone >= 1) lobe.is_infinite = true;
  if (has_finite_norms(term.factors)) lobe.is_infinite = false;
  if (term.pumping) {
    lobe.kernel.pumping = to_string(term.pumping->correction);
    lobe.kernel.curves = term.pumping->albedos.size();
    lobe.kernel.curve_parts = most_parts(term.pumping->albedos);
    for (const auto& curve : term.pumping->albedos) {
      const auto padded = padded_curve(curve, lobe.kernel.curve_parts);
      lobe.curves.insert(lobe.curves.end(), padded.begin(), padded.end());
    }
  }
  return lobe;
}

void require_kinds(const Material& material, const Term& term, LobeKinds kinds) {
  const Traits traits = traits_of(term);
  if (!traits.isotropic && !kinds.with_anisotropic) {
    refuse_anisotropic(material.name, term.model, "products of formulas here; of others there are those of tables");
  }
  if (traits.has_delta && !kinds.with_deltas) {
    throw NumericError(
        "material '" + material.name + "' contains the delta part '" + term.model +
        "', which has no values in sr^-1 and an infinite norm under point light; albedos, daylight, patch "
        "lights and tables take it");
  }
}

// Lobes with the same kernel, coefficients and curves are the same function.
using Key = std::tuple<LobeKernel, Coefficients, std::vector<double>>;

Key key_of(const Lobe& lobe) {
  return {lobe.kernel, lobe.coefficients, lobe.curves};
}

using DeltaKey = std::tuple<DeltaKind, std::vector<double>, Key>;

DeltaKey key_of(const DeltaLobe& delta) {
  return {delta.kind, delta.term.complement_of, key_of(lobe_of(without_delta(delta)))};
}

/// Where the lobe of a term is: one of both.
struct Place {
  const Key* smooth = nullptr;
  const DeltaKey* delta = nullptr;
};

/// The lobes of materials, each once, and of every term in order where its lobe is.
struct Collection {
  std::map<Key, Lobe> distinct;
  std::map<std::vector<double>, Pumping> pumpings;  ///< by their curves
  std::map<DeltaKey, DeltaLobe> deltas;
  std::vector<Place> of_terms;
};

Collection collect(std::span<const Material> materials, LobeKinds kinds) {
  Collection found;
  for (const auto& material : materials) {
    if (material.terms.empty())
      throw ArgumentError("material '" + material.name + "' has no terms", {.topic = Topic::materials});
    if (!material.adjustments.empty()) {
      throw ArgumentError("material '" + material.name + "' is still to be adjusted ('" +
                          to_string(material.adjustments.front()) + "'); expected what prepare() returns");
    }
    for (const auto& term : material.terms) {
      require_kinds(material, term, kinds);
      if (traits_of(term).has_delta) {
        require_consistent(term);
        require_bounded_delta(material, term);
        DeltaLobe delta = delta_lobe(term);
        DeltaKey key = key_of(delta);
        found.of_terms.push_back({nullptr, &found.deltas.try_emplace(std::move(key), std::move(delta)).first->first});
        continue;
      }
      Lobe lobe = lobe_of(term);
      Key key = key_of(lobe);
      if (term.pumping) found.pumpings.try_emplace(lobe.curves, *term.pumping);
      found.of_terms.push_back({&found.distinct.try_emplace(std::move(key), std::move(lobe)).first->first, nullptr});
    }
  }
  if (found.distinct.empty()) {  // quadrature and sampling want a lobe, if only as a rule for delta parts
    Lobe lobe = lobe_of(make_material("lambert").terms.front());
    Key key = key_of(lobe);
    found.distinct.try_emplace(std::move(key), std::move(lobe));
  }
  return found;
}

/// The least smooth kinks of all, in order, as many as panels can end on.
std::vector<Kink> least_smooth(const std::set<Kink>& all) {
  std::vector<Kink> kinks(all.begin(), all.end());
  const auto jumps = static_cast<std::size_t>(std::ranges::count_if(kinks, &Kink::is_jump));
  kinks.resize(std::min(kinks.size(), std::clamp(jumps, kMostKinks, kMostJumps)));
  return kinks;
}

/// Limits of the lobes of a batch.
class CollectedLimits {
 public:
  void add(const Lobe& lobe) {
    limits_.narrowest = std::min(limits_.narrowest, lobe.width);
    limits_.narrowest_retro = std::min(limits_.narrowest_retro, lobe.retro_width);
    limits_.aspect = std::max(limits_.aspect, lobe.aspect);
    radii_.insert(lobe.patch_radii.begin(), lobe.patch_radii.end());
    if (lobe.retro_patch_radius) retro_radii_.insert(*lobe.retro_patch_radius);
    if (lobe.patch_edge) edges_.insert(*lobe.patch_edge);
    if (lobe.retro_patch_edge) retro_edges_.insert(*lobe.retro_patch_edge);
    kinks_.insert(lobe.kinks.begin(), lobe.kinks.end());
    if (!lobe.curves.empty()) curves_.insert(lobe.curves);
  }
  [[nodiscard]] LobeSet::Limits limits(const std::map<std::vector<double>, Pumping>& pumpings) const {
    LobeSet::Limits result = limits_;
    result.patch_radii.assign(radii_.begin(), radii_.end());
    result.retro_patch_radii.assign(retro_radii_.begin(), retro_radii_.end());
    result.patch_edges.assign(edges_.begin(), edges_.end());
    result.retro_patch_edges.assign(retro_edges_.begin(), retro_edges_.end());
    result.kinks.assign(kinks_.begin(), kinks_.end());
    for (const auto& curves : curves_) result.pieces.push_back(divisor_pieces(pumpings.at(curves)));
    return result;
  }

 private:
  LobeSet::Limits limits_;  ///< but for what is listed once
  std::set<double> radii_;
  std::set<double> retro_radii_;
  std::set<PatchEdge> edges_;
  std::set<PatchEdge> retro_edges_;
  std::set<Kink> kinks_;
  std::set<std::vector<double>> curves_;
};

bool has_kink(std::span<const Kink> kinks, const Kink& wanted) {
  return std::ranges::any_of(kinks, [&](const Kink& kink) { return !(kink < wanted) && !(wanted < kink); });
}

/// Whether each material has a lobe with jumps that are no limits of panels.
std::vector<bool> hiding_materials(std::span<const Material> materials, const Collection& found,
                                   std::span<const Kink> limits) {
  const auto is_missing = [&](const Kink& kink) { return kink.is_jump() && !has_kink(limits, kink); };
  std::vector<bool> hides;
  auto place = found.of_terms.begin();
  for (const Material& material : materials) {
    bool any = false;
    for (std::size_t k = 0; k < material.terms.size(); ++k, ++place) {
      if (place->smooth == nullptr) continue;
      const Lobe& lobe = found.distinct.at(*place->smooth);
      any = any || lobe.hides_jumps || std::ranges::any_of(lobe.kinks, is_missing);
    }
    hides.push_back(any);
  }
  return hides;
}

/// Groups of lobes, and the kinks that panels of the given direction end on: all, if rules of every group end on its
/// own ones.
void group(std::span<const LobeSet::Limits> of_batches, const std::set<Kink>& all, LobeSet& set) {
  set.given_kinks = set.kinks;
  // Panels of one direction never end on kinks that see azimuths.
  const auto count = static_cast<std::size_t>(std::ranges::count(all, false, &Kink::is_anisotropic));
  if (count <= kMostGivenKinks) {
    set.given_kinks.clear();
    std::ranges::copy_if(all, std::back_inserter(set.given_kinks),
                         [](const Kink& kink) { return !kink.is_anisotropic; });
    group_by_limits(of_batches, true, set);
    const bool have_all_kinks = std::ranges::all_of(set.group_limits, [](const LobeSet::Limits& limits) {
      return least_smooth({limits.kinks.begin(), limits.kinks.end()}).size() == limits.kinks.size();
    });
    if (have_all_kinks) return;
    set.given_kinks = set.kinks;
  }
  group_by_limits(of_batches, false, set);
}

}  // namespace

LobeExtent LobeSet::extent_of_group(std::size_t group) const {
  const Limits& limits = group_limits[group];
  LobeExtent part = extent();
  part.width = limits.narrowest;
  part.retro_width = limits.narrowest_retro;
  part.aspect = limits.aspect;
  part.patch_radii = limits.patch_radii;
  part.retro_patch_radii = limits.retro_patch_radii;
  part.patch_edges = limits.patch_edges;
  part.retro_patch_edges = limits.retro_patch_edges;
  part.pieces = limits.pieces;
  part.kinks = least_smooth({limits.kinks.begin(), limits.kinks.end()});
  return part;
}

LobeSet LobeSet::selected(std::span<const Eigen::Index> wanted) const {
  LobeSet some = *this;
  some.mix.clear();
  some.names.clear();
  for (const Eigen::Index lobe : wanted) some.names.push_back(names[static_cast<std::size_t>(lobe)]);
  auto next = wanted.begin();
  some.has_mirror_edge.clear();
  some.has_retro_edge.clear();
  for (const Eigen::Index lobe : wanted) {
    const auto place = static_cast<std::size_t>(lobe);
    if (place >= smooth_lobes()) break;
    some.has_mirror_edge.push_back(has_mirror_edge[place]);
    some.has_retro_edge.push_back(has_retro_edge[place]);
  }
  Eigen::Index first = 0;
  for (LobeBatch& batch : some.batches) {
    const auto all = std::exchange(batch.coefficients, {});
    const auto curves = std::exchange(batch.curves, {});
    const auto end = first + static_cast<Eigen::Index>(all.size());
    for (; next != wanted.end() && *next < end; ++next) {
      const auto place = static_cast<std::size_t>(*next - first);
      batch.coefficients.push_back(all[place]);
      if (!curves.empty()) batch.curves.push_back(curves[place]);
    }
    first = end;
  }
  std::vector<std::size_t> kept;
  for (std::size_t b = 0; b < some.batches.size(); ++b) {
    if (!some.batches[b].coefficients.empty()) kept.push_back(b);
  }
  some.is_retro_patch.clear();
  some.group_of_batch.clear();
  for (const std::size_t b : kept) {
    some.is_retro_patch.push_back(is_retro_patch[b]);
    some.group_of_batch.push_back(group_of_batch[b]);
  }
  std::erase_if(some.batches, [](const LobeBatch& batch) { return batch.coefficients.empty(); });
  return some;
}

LobeSet make_lobe_set(std::span<const Material> materials, LobeKinds kinds) {
  if (materials.empty()) throw ArgumentError("no materials; expected at least one");
  std::size_t channels = 1;
  for (const auto& material : materials) channels = std::max(channels, material.channels());
  const Collection found = collect(materials, kinds);
  LobeSet set;
  std::map<const Key*, std::size_t> column;
  std::set<double> radii;
  std::set<double> retro_radii;
  std::set<Kink> kinks;
  std::map<Kink, double> narrow_kinks;                    // and the smallest width
  std::map<std::vector<double>, double> narrow_pumpings;  // by their curves, and the smallest width
  std::set<Kink> mirror_kinks;
  std::set<PatchEdge> patch_edges;
  std::set<PatchEdge> retro_patch_edges;
  MirrorPlanes planes;
  std::vector<CollectedLimits> batch_limits;
  for (const auto& [key, lobe] : found.distinct) {
    if (set.batches.empty() || set.batches.back().kernel != lobe.kernel) {
      set.batches.push_back({lobe.kernel, {}});
      set.is_retro_patch.push_back(lobe.retro_patch_edge.has_value());
      batch_limits.emplace_back();
    }
    batch_limits.back().add(lobe);
    set.batches.back().coefficients.push_back(lobe.coefficients);
    if (lobe.kernel.curves > 0) set.batches.back().curves.push_back(lobe.curves);
    column.emplace(&key, set.names.size());
    set.names.push_back(lobe.name);
    set.has_mirror_edge.push_back(lobe.patch_edge.has_value());
    set.has_retro_edge.push_back(lobe.retro_patch_edge.has_value());
    if (lobe.is_infinite) set.infinite.push_back(lobe.name);
    set.narrowest = std::min(set.narrowest, lobe.width);
    set.narrowest_retro = std::min(set.narrowest_retro, lobe.retro_width);
    set.aspect = std::max(set.aspect, lobe.aspect);
    radii.insert(lobe.patch_radii.begin(), lobe.patch_radii.end());
    set.has_fractional_edge = set.has_fractional_edge || lobe.has_fractional_edge;
    if (lobe.retro_patch_radius) retro_radii.insert(*lobe.retro_patch_radius);
    kinks.insert(lobe.kinks.begin(), lobe.kinks.end());
    set.common = set.common | lobe.common;
    if (lobe.width < kNarrow && !lobe.curves.empty()) {
      const auto known = narrow_pumpings.try_emplace(lobe.curves, lobe.width).first;
      known->second = std::min(known->second, lobe.width);
    }
    if (lobe.width < kNarrow && !lobe.hides_jumps) {
      for (const Kink& kink : lobe.kinks) {
        const auto place = narrow_kinks.try_emplace(kink, lobe.width).first;
        place->second = std::min(place->second, lobe.width);
      }
    }
    if (lobe.patch_edge) patch_edges.insert(*lobe.patch_edge);
    if (lobe.retro_patch_edge) retro_patch_edges.insert(*lobe.retro_patch_edge);
    set.half_turn = set.half_turn && lobe.half_turn;
    set.both_sides = set.both_sides || lobe.both_sides;
    if (lobe.kernel.is_anisotropic) planes.add(lobe.mirror_plane);
  }
  // Mirror images have the same products.
  set.both_sides = set.both_sides && !planes.are_shared();
  set.mirror_plane = planes.shared();
  std::vector<LobeSet::Limits> limits_of_batches;
  for (const CollectedLimits& limits : batch_limits) limits_of_batches.push_back(limits.limits(found.pumpings));
  for (const auto& [curves, pumping] : found.pumpings) {
    set.pieces.push_back(divisor_pieces(pumping));
    if (set.piece_kinks.size() >= kMostKinks) continue;
    const auto of_cosines = cosine_pieces_kinks(pumping);
    const auto of_albedos = albedo_pieces_kinks(pumping);
    set.piece_kinks.insert(set.piece_kinks.end(), of_cosines.begin(), of_cosines.end());
    set.piece_kinks.insert(set.piece_kinks.end(), of_albedos.begin(), of_albedos.end());
    const auto narrow = narrow_pumpings.find(curves);
    if (narrow == narrow_pumpings.end()) continue;
    for (const Kink& kink : of_cosines) set.peak_kinks.push_back({kink, narrow->second});
  }
  std::map<const DeltaKey*, std::size_t> delta_column;
  for (const auto& [key, delta] : found.deltas) {
    delta_column.emplace(&key, set.names.size());
    set.names.push_back(describe(delta.term));
    set.deltas.push_back(delta);
    if (delta.kind != DeltaKind::mirror) continue;  // factors have kinks of L.H, which is 1 where V is L
    const std::vector<Kink> of_factors = lobe_of(without_delta(delta)).kinks;
    mirror_kinks.insert(of_factors.begin(), of_factors.end());
  }

  std::vector<std::vector<Eigen::Triplet<double>>> entries(channels);
  auto place = found.of_terms.begin();
  for (std::size_t i = 0; i < materials.size(); ++i) {
    set.both_orders = set.both_orders || !is_reciprocal(materials[i]);
    for (const auto& term : materials[i].terms) {
      if (term.weight.size() != 1 && term.weight.size() != channels) {
        throw ArgumentError("material '" + materials[i].name + "' has a term of " + std::to_string(term.weight.size()) +
                            " channels; expected 1 or " + std::to_string(channels) + ", as others have");
      }
      const bool is_delta = place->delta != nullptr;
      const std::size_t lobe = is_delta ? delta_column.at(place->delta) : column.at(place->smooth);
      const double share = is_delta ? term.values.front() : 1;
      ++place;
      for (std::size_t c = 0; c < channels; ++c) {
        const double weight = term.weight.size() == 1 ? term.weight.front() : term.weight[c];
        entries[c].emplace_back(static_cast<int>(i), static_cast<int>(lobe), share * weight);
      }
    }
  }
  set.patch_radii.assign(radii.begin(), radii.end());
  set.retro_patch_radii.assign(retro_radii.begin(), retro_radii.end());
  set.kinks = least_smooth(kinks);
  for (const Kink& kink : mirror_kinks) set.peak_kinks.push_back({kink, 0});
  set.given_peak_kinks = set.peak_kinks;
  for (const auto& [kink, width] : narrow_kinks) {
    if (!kink.is_anisotropic && has_kink(set.kinks, kink)) set.peak_kinks.push_back({kink, width});
  }
  set.hides_jumps = hiding_materials(materials, found, set.kinks);
  set.patch_edges.assign(patch_edges.begin(), patch_edges.end());
  set.retro_patch_edges.assign(retro_patch_edges.begin(), retro_patch_edges.end());
  for (const auto& list : entries) {
    Eigen::SparseMatrix<double, Eigen::RowMajor> mix(static_cast<Eigen::Index>(materials.size()),
                                                     static_cast<Eigen::Index>(set.lobes()));
    mix.setFromTriplets(list.begin(), list.end());
    set.mix.push_back(std::move(mix));
  }
  group(limits_of_batches, kinks, set);
  for (const auto& [kink, width] : narrow_kinks) {
    if (!kink.is_anisotropic && has_kink(set.given_kinks, kink)) set.given_peak_kinks.push_back({kink, width});
  }
  return set;
}

}  // namespace lobe
