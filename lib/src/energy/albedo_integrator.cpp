#include "energy/albedo_integrator.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "device/sum_segments.hpp"

namespace lobe {
namespace {

/// The first of each run of nodes of one elevation.
std::vector<IncidentNode> elevations_of(std::span<const IncidentNode> incident) {
  std::vector<IncidentNode> elevations;
  for (const IncidentNode& node : incident) {
    if (elevations.empty() || elevations.back().elevation != node.elevation) elevations.push_back(node);
  }
  return elevations;
}

bool are_same(std::span<const Kink> a, std::span<const Kink> b) {
  return std::ranges::equal(a, b, [](const Kink& x, const Kink& y) { return !(x < y) && !(y < x); });
}

/// Whether limits of two batches are the same. Divisors of pumped lobes cannot be compared.
bool have_same_limits(const LobeSet& lobes, std::size_t a, std::size_t b) {
  if (a == b) return true;
  const LobeSet::Limits& one = lobes.batch_limits[a];
  const LobeSet::Limits& other = lobes.batch_limits[b];
  return one.pieces.empty() && other.pieces.empty() && one.patch_radii == other.patch_radii &&
         one.retro_patch_radii == other.retro_patch_radii && are_same(one.kinks, other.kinks);
}

/// By batch, whether a material mixes its lobes with some of other limits, directly or by way of others.
std::vector<bool> mixed_batches(const LobeSet& lobes) {
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
            batches, [&](std::size_t b) { return is_mixed[b] || !have_same_limits(lobes, b, *batches.begin()); });
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

/// Isotropic batches whose lobes take one rule, by SharedRule::by_limits. The last group takes what would be too many:
/// each makes nodes of its own on the host.
std::vector<std::vector<std::size_t>> groups_by_limits(const LobeSet& lobes) {
  constexpr std::size_t kMostGroups = 32;
  std::vector<std::vector<std::size_t>> groups;
  // Where panels of the given direction do not end on all kinks, what levels of the other one miss covers for it.
  std::set<Kink> kinks;
  for (const auto& limits : lobes.batch_limits) kinks.insert(limits.kinks.begin(), limits.kinks.end());
  const bool has_all_kinks = kinks.size() <= lobes.kinks.size();
  const std::vector<bool> is_mixed =
      has_all_kinks ? mixed_batches(lobes) : std::vector<bool>(lobes.batches.size(), true);
  for (std::size_t b = 0; b < lobes.batches.size(); ++b) {
    if (lobes.batches[b].kernel.is_anisotropic) continue;
    const auto group = std::ranges::find_if(groups, [&](const auto& one) {
      return is_mixed[b] ? is_mixed[one.front()] : !is_mixed[one.front()] && have_same_limits(lobes, one.front(), b);
    });
    if (group == groups.end()) {
      groups.push_back({b});
    } else {
      group->push_back(b);
    }
  }
  for (; groups.size() > kMostGroups; groups.pop_back()) {
    groups[kMostGroups - 1].insert(groups[kMostGroups - 1].end(), groups.back().begin(), groups.back().end());
  }
  return groups;
}

/// Columns of the lobes of batches.
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

}  // namespace

LobeExtent extent_for(const LobeSet& lobes, Given given) {
  return lobes.both_orders && given == Given::viewer ? exchanged(lobes.extent()) : lobes.extent();
}

AlbedoIntegrator::AlbedoIntegrator(const Device& device, const LobeSet& lobes, Precision precision, Given given,
                                   double tolerance, SharedRule shared)
    : rule_(extent_for(lobes, given), tolerance),
      half_vectors_(extent_for(lobes, given)),
      deltas_(device, lobes.deltas),
      given_(given),
      smooth_lobes_(static_cast<Eigen::Index>(lobes.smooth_lobes())),
      lobes_(static_cast<Eigen::Index>(lobes.lobes())) {
  const auto add = [&](Rays rays, std::span<const std::size_t> chosen, AlbedoRule rule) {
    std::vector<LobeBatch> batches;
    for (const std::size_t b : chosen) batches.push_back(lobes.batches[b]);
    std::vector<Eigen::Index> columns = columns_of(lobes, chosen);
    LobeEvaluator evaluator(device, batches, precision, LobeEvaluator::suggested_capacity(columns.size()));
    NodeBlock block(evaluator.node_stride(), rays != Rays::none);
    parts_.push_back({rays, std::move(rule), std::move(columns), std::move(evaluator), std::move(block)});
  };
  if (shared == SharedRule::by_limits) {
    for (const auto& group : groups_by_limits(lobes)) {
      const LobeExtent extent = lobes.extent_of(group);
      const bool is_exchanged = lobes.both_orders && given == Given::viewer;
      add(Rays::none, group, AlbedoRule(is_exchanged ? exchanged(extent) : extent, tolerance));
    }
  } else {
    std::vector<std::size_t> batches;
    for (std::size_t b = 0; b < lobes.batches.size(); ++b) {
      if (!lobes.batches[b].kernel.is_anisotropic) batches.push_back(b);
    }
    if (!batches.empty()) add(Rays::none, batches, rule_);
  }
  for (const bool is_retro : {false, true}) {
    std::vector<std::size_t> batches;
    for (std::size_t b = 0; b < lobes.batches.size(); ++b) {
      if (lobes.batches[b].kernel.is_anisotropic && lobes.is_retro_patch[b] == is_retro) batches.push_back(b);
    }
    if (!batches.empty()) add(is_retro ? Rays::retro : Rays::mirror, batches, rule_);
  }
}

Eigen::MatrixXd AlbedoIntegrator::integrate(std::span<const IncidentNode> incident, int level, WorkDone& work) {
  Eigen::MatrixXd albedos(lobes_, static_cast<Eigen::Index>(incident.size()));
  for (Part& part : parts_) {
    const bool is_anisotropic = part.rays != Rays::none;
    const auto elevations = is_anisotropic ? std::vector<IncidentNode>() : elevations_of(incident);
    const Eigen::MatrixXd found = integrate(part, is_anisotropic ? incident : elevations, level, work);
    Eigen::Index place = 0;
    for (std::size_t k = 0; k < incident.size(); ++k) {
      const bool is_next = k > 0 && (is_anisotropic || incident[k].elevation != incident[k - 1].elevation);
      if (is_next) ++place;
      for (std::size_t lobe = 0; lobe < part.lobes.size(); ++lobe) {
        albedos(part.lobes[lobe], static_cast<Eigen::Index>(k)) = found(static_cast<Eigen::Index>(lobe), place);
      }
    }
  }
  if (lobes_ > smooth_lobes_) {
    std::vector<double> elevations;
    for (const IncidentNode& node : incident) elevations.push_back(node.elevation);
    albedos.bottomRows(lobes_ - smooth_lobes_) = deltas_.at(elevations);
  }
  return albedos;
}

void AlbedoIntegrator::place(Part& part, const IncidentNode& incident, int level,
                             const std::function<void()>& flush) const {
  if (part.rays == Rays::none) {
    part.rule.place(incident.elevation, level, part.block, flush);
  } else {
    half_vectors_.place(incident.elevation, incident.azimuth, part.rays == Rays::retro, rule_.nodes_per_panel(level),
                        part.block, flush);
  }
}

Eigen::MatrixXd AlbedoIntegrator::integrate(Part& part, std::span<const IncidentNode> incident, int level,
                                            WorkDone& work) {
  SegmentAccumulator sums(part.evaluator, incident.size());
  std::vector<unsigned> starts;
  std::size_t first_segment = 0;
  std::size_t current = 0;
  Stopwatch watch;
  const auto flush = [&] {
    work.seconds_nodes += watch.lap();
    work.nodes += part.block.size();
    work.evaluations += part.block.size() * part.lobes.size();
    starts.push_back(static_cast<unsigned>(part.block.size()));
    if (given_ == Given::viewer) part.block.exchange_directions();
    part.evaluator.evaluate(part.block);
    sums.add(starts, first_segment);
    finish(part.evaluator.device());
    work.seconds_values += watch.lap();
    // The rest of the segment in progress comes with the next block.
    first_segment = current;
    starts.assign(1, 0);
    part.block.clear();
  };
  for (current = 0; current < incident.size(); ++current) {
    starts.push_back(static_cast<unsigned>(part.block.size()));
    if (starts.size() == 1) first_segment = current;
    place(part, incident[current], level, flush);
  }
  --current;
  if (part.block.size() > 0) flush();

  const Eigen::MatrixXd padded = sums.take();
  const auto& rows = part.evaluator.rows();
  Eigen::MatrixXd albedos(static_cast<Eigen::Index>(rows.size()), padded.cols());
  for (std::size_t lobe = 0; lobe < rows.size(); ++lobe) {
    albedos.row(static_cast<Eigen::Index>(lobe)) = padded.row(static_cast<Eigen::Index>(rows[lobe]));
  }
  work.seconds_host += watch.lap();
  return albedos;
}

}  // namespace lobe
