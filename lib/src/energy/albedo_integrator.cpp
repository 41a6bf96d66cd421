#include "energy/albedo_integrator.hpp"

#include <vector>

#include "core/stopwatch.hpp"

namespace lobe {

AlbedoIntegrator::AlbedoIntegrator(const Device& device, const LobeSet& lobes, Precision precision)
    : rule_(lobes.extent()),
      sampler_(device, lobes.batches, precision, Sampler::suggested_capacity(lobes.lobes())),
      block_(sampler_.node_stride()) {}

Eigen::MatrixXd AlbedoIntegrator::integrate(std::span<const IncidentNode> incident, int level, Work& work) {
  SegmentAccumulator sums(sampler_, incident.size());
  std::vector<unsigned> starts;
  std::size_t first_segment = 0;
  std::size_t current = 0;
  Stopwatch watch;
  const auto flush = [&] {
    work.seconds_nodes += watch.lap();
    work.nodes += block_.size();
    work.evaluations += block_.size() * sampler_.rows().size();
    starts.push_back(static_cast<unsigned>(block_.size()));
    sampler_.sample(block_);
    sums.add(starts, first_segment);
    finish(sampler_.device());
    work.seconds_samples += watch.lap();
    // The rest of the segment in progress comes with the next block.
    first_segment = current;
    starts.assign(1, 0);
    block_.clear();
  };
  for (current = 0; current < incident.size(); ++current) {
    starts.push_back(static_cast<unsigned>(block_.size()));
    if (starts.size() == 1) first_segment = current;
    rule_.place(incident[current].elevation, level, block_, flush);
  }
  --current;
  if (block_.size() > 0) flush();

  const Eigen::MatrixXd padded = sums.take();
  const auto& rows = sampler_.rows();
  Eigen::MatrixXd albedos(static_cast<Eigen::Index>(rows.size()), padded.cols());
  for (std::size_t lobe = 0; lobe < rows.size(); ++lobe) {
    albedos.row(static_cast<Eigen::Index>(lobe)) = padded.row(static_cast<Eigen::Index>(rows[lobe]));
  }
  work.seconds_host += watch.lap();
  return albedos;
}

}  // namespace lobe
