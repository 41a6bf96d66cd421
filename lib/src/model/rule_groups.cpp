#include "model/rule_groups.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <type_traits>
#include <utility>

namespace lobe {
namespace {

bool are_same(std::span<const Kink> a, std::span<const Kink> b) {
  return std::ranges::equal(a, b, [](const Kink& x, const Kink& y) { return !(x < y) && !(y < x); });
}

/// Divisors of pumped lobes cannot be compared.
bool are_same(const LobeSet::Limits& one, const LobeSet::Limits& other) {
  if (&one == &other) return true;
  return one.pieces.empty() && other.pieces.empty() && one.patch_radii == other.patch_radii &&
         one.retro_patch_radii == other.retro_patch_radii && one.patch_edges == other.patch_edges &&
         one.retro_patch_edges == other.retro_patch_edges && are_same(one.kinks, other.kinks);
}

/// By batch, whether a material mixes its lobes with some of other limits, directly or by way of others.
std::vector<bool> mixed_batches(std::span<const LobeSet::Limits> limits, const LobeSet& lobes) {
  std::vector<std::size_t> batch_of;  // by lobe
  for (std::size_t b = 0; b < lobes.batches.size(); ++b) {
    batch_of.resize(batch_of.size() + lobes.batches[b].coefficients.size(), b);
  }
  std::vector<bool> is_mixed(lobes.batches.size(), false);
  for (bool has_changed = true; std::exchange(has_changed, false);) {
    for (const auto& mix : lobes.mix) {
      for (Eigen::Index material = 0; material < mix.outerSize(); ++material) {
        std::set<std::size_t> batches;
        for (std::remove_cvref_t<decltype(mix)>::InnerIterator term(mix, material); term; ++term) {
          const auto lobe = static_cast<std::size_t>(term.col());
          if (lobe < batch_of.size()) batches.insert(batch_of[lobe]);
        }
        const bool mixes = std::ranges::any_of(
            batches, [&](std::size_t b) { return is_mixed[b] || !are_same(limits[b], limits[*batches.begin()]); });
        if (!mixes) continue;
        for (const std::size_t b : batches) {
          has_changed = has_changed || !is_mixed[b];
          is_mixed[b] = true;
        }
      }
    }
  }
  return is_mixed;
}

/// Isotropic lobes, anisotropic ones about the mirror direction, and those about the retro direction have rules of
/// different kinds.
enum class RuleKind { isotropic, mirror, retro };

RuleKind kind_of(const LobeSet& lobes, std::size_t batch) {
  if (!lobes.batches[batch].kernel.is_anisotropic) return RuleKind::isotropic;
  return lobes.is_retro_patch[batch] ? RuleKind::retro : RuleKind::mirror;
}

template <typename Value>
void unite(std::vector<Value>& all, const std::vector<Value>& more) {
  std::set<Value> once(all.begin(), all.end());
  once.insert(more.begin(), more.end());
  all.assign(once.begin(), once.end());
}

void unite(LobeSet::Limits& all, const LobeSet::Limits& more) {
  all.narrowest = std::min(all.narrowest, more.narrowest);
  all.narrowest_retro = std::min(all.narrowest_retro, more.narrowest_retro);
  all.aspect = std::max(all.aspect, more.aspect);
  unite(all.patch_radii, more.patch_radii);
  unite(all.retro_patch_radii, more.retro_patch_radii);
  unite(all.patch_edges, more.patch_edges);
  unite(all.retro_patch_edges, more.retro_patch_edges);
  unite(all.kinks, more.kinks);
  all.pieces.insert(all.pieces.end(), more.pieces.begin(), more.pieces.end());
}

}  // namespace

void group_by_limits(std::span<const LobeSet::Limits> limits, bool are_apart, LobeSet& lobes) {
  constexpr std::size_t kMostOfAKind = 32;  // each makes nodes of its own on the host; the last takes what is left
  lobes.group_of_batch.clear();
  lobes.group_limits.clear();
  const std::vector<bool> is_mixed =
      are_apart ? mixed_batches(limits, lobes) : std::vector<bool>(lobes.batches.size(), true);
  std::map<RuleKind, std::vector<std::size_t>> groups_of_kind;
  std::vector<std::size_t> first_batch;  // by group
  for (std::size_t b = 0; b < limits.size(); ++b) {
    auto& known = groups_of_kind[kind_of(lobes, b)];
    auto group = std::ranges::find_if(known, [&](std::size_t number) {
      const std::size_t first = first_batch[number];
      return is_mixed[b] ? is_mixed[first] : !is_mixed[first] && are_same(limits[first], limits[b]);
    });
    if (group == known.end() && known.size() == kMostOfAKind) --group;
    if (group == known.end()) {
      group = known.insert(known.end(), first_batch.size());
      first_batch.push_back(b);
      lobes.group_limits.push_back(limits[b]);
    } else {
      unite(lobes.group_limits[*group], limits[b]);
    }
    lobes.group_of_batch.push_back(*group);
  }
}

std::vector<RuleGroup> rule_groups(const LobeSet& lobes) {
  std::map<std::size_t, std::vector<std::size_t>> batches;
  for (std::size_t b = 0; b < lobes.group_of_batch.size(); ++b) batches[lobes.group_of_batch[b]].push_back(b);
  std::vector<RuleGroup> groups;
  for (const auto& [number, of_group] : batches) groups.push_back({number, of_group, columns_of(lobes, of_group)});
  return groups;
}

std::vector<Eigen::Index> columns_of(const LobeSet& lobes, std::span<const std::size_t> batches) {
  std::vector<Eigen::Index> columns;
  Eigen::Index column = 0;
  for (std::size_t b = 0; b < lobes.batches.size(); ++b) {
    const bool is_wanted = std::ranges::find(batches, b) != batches.end();
    for (std::size_t k = 0; k < lobes.batches[b].coefficients.size(); ++k, ++column) {
      if (is_wanted) columns.push_back(column);
    }
  }
  return columns;
}

}  // namespace lobe
