#include "energy/albedo_integrator.hpp"

#include <functional>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "device/sum_segments.hpp"
#include "model/rule_groups.hpp"

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

LobeExtent seen_from(const LobeSet& lobes, Given given, LobeExtent extent) {
  return lobes.both_orders && given == Given::viewer ? exchanged(std::move(extent)) : extent;
}

}  // namespace

LobeExtent extent_for(const LobeSet& lobes, Given given) {
  return seen_from(lobes, given, lobes.extent());
}

LobeExtent given_extent(const LobeSet& lobes, Given given) {
  return seen_from(lobes, given, lobes.given_extent());
}

LobeExtent extent_of_group(const LobeSet& lobes, std::size_t group, Given given) {
  return seen_from(lobes, given, lobes.extent_of_group(group));
}

AlbedoIntegrator::AlbedoIntegrator(const Device& device, const LobeSet& lobes, Precision precision, Given given,
                                   double tolerance, SharedRule shared)
    : rule_(shared == SharedRule::by_limits ? given_extent(lobes, given) : extent_for(lobes, given), tolerance),
      deltas_(device, lobes.deltas),
      given_(given),
      smooth_lobes_(static_cast<Eigen::Index>(lobes.smooth_lobes())),
      lobes_(static_cast<Eigen::Index>(lobes.lobes())) {
  const auto add = [&](std::span<const std::size_t> chosen, const LobeExtent& extent) {
    if (chosen.empty()) return;
    std::vector<LobeBatch> batches;
    for (const std::size_t b : chosen) batches.push_back(lobes.batches[b]);
    std::vector<Eigen::Index> columns = columns_of(lobes, chosen);
    LobeEvaluator evaluator(device, batches, precision, LobeEvaluator::suggested_capacity(columns.size()));
    NodeBlock block(evaluator.node_stride(), evaluator.needs_tangents());
    parts_.push_back({rays_of(lobes, chosen.front()), AlbedoRule(extent, tolerance), HalfVectorRule(extent),
                      std::move(columns), std::move(evaluator), std::move(block)});
  };
  if (shared == SharedRule::by_limits) {
    for (const RuleGroup& group : rule_groups(lobes)) add(group.batches, extent_of_group(lobes, group.number, given));
    return;
  }
  for (const Rays rays : {Rays::none, Rays::mirror, Rays::retro}) {
    std::vector<std::size_t> batches;
    for (std::size_t b = 0; b < lobes.batches.size(); ++b) {
      if (rays_of(lobes, b) == rays) batches.push_back(b);
    }
    add(batches, extent_for(lobes, given));
  }
}

AlbedoIntegrator::Rays AlbedoIntegrator::rays_of(const LobeSet& lobes, std::size_t batch) {
  if (!lobes.batches[batch].kernel.is_anisotropic) return Rays::none;
  return lobes.is_retro_patch[batch] ? Rays::retro : Rays::mirror;
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
    part.half_vectors.place(incident.elevation, incident.azimuth, part.rays == Rays::retro,
                            rule_.nodes_per_panel(level), part.block, flush);
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
