#include "table/isotropic_mean.hpp"

#include <algorithm>
#include <vector>

#include "core/parallel.hpp"

namespace lobe {
namespace {

/// Means over the nodes of each ring, channels x rings.
std::vector<double> ring_means(const std::vector<double>& by_node, const HemisphereGrid& grid) {
  if (by_node.empty()) return {};
  const std::size_t azimuths = grid.n_phi();
  std::vector<double> means(by_node.size() / azimuths);
  for (std::size_t i = 0; i < by_node.size(); ++i) means[i / azimuths] += by_node[i] / static_cast<double>(azimuths);
  return means;
}

}  // namespace

BrdfTable isotropic_mean(const BrdfTable& table) {
  if (table.form == TableForm::isotropic) return table;
  BrdfTable mean;
  mean.grid = table.grid;
  mean.form = TableForm::isotropic;
  mean.channels = table.channels;
  mean.channel_names = table.channel_names;
  mean.error = table.error;
  mean.mirror = ring_means(table.mirror, table.grid);
  mean.retro = ring_means(table.retro, table.grid);
  mean.expression = table.expression;
  mean.resolution_error = table.resolution_error;
  mean.is_unresolved = table.is_unresolved;
  mean.values.resize(mean.channels * mean.size());
  std::ranges::fill(mean.values, 0.0);
  const std::size_t rings = mean.rows();
  const std::size_t azimuths = table.grid.n_phi();
  const std::size_t half = table.grid.half_azimuths();
  const std::size_t nodes = table.grid.nodes();
  for (std::size_t c = 0; c < table.channels; ++c) {
    parallel_for(rings, [&](std::size_t i) {
      for (std::size_t in = i * azimuths; in < (i + 1) * azimuths; ++in) {
        for (std::size_t out = 0; out < nodes; ++out) {
          const std::size_t turn = (out % azimuths + azimuths - in % azimuths) % azimuths;
          const std::size_t k = std::min(turn, azimuths - turn);
          const double count = static_cast<double>(k == 0 || 2 * k == azimuths ? azimuths : 2 * azimuths);
          mean.channel(c)[(i * rings + out / azimuths) * half + k] += table.channel(c)[in * nodes + out] / count;
        }
      }
    });
  }
  return mean;
}

}  // namespace lobe
