#include "algebra/inner_factors.hpp"

#include <memory>

#include "model/traits.hpp"
#include "table/lobe_tabulator.hpp"

namespace lobe {

bool can_be_factor(const Material& material) {
  return !material.terms.empty() && is_isotropic(material) && is_reciprocal(material);
}

InnerFactor formula_factor(const Device& device, const Material& material, const HemisphereGrid& grid,
                           Precision precision) {
  const auto tabulator = std::make_shared<const LobeTabulator>(device, material, precision);
  const std::size_t channels = tabulator->lobes().channels();
  const auto nodes = std::make_shared<const NodeSet>(ring_nodes(grid, 1));
  return {tabulator->lobes().extent(), channels,
          [tabulator, nodes, channels](std::span<const std::size_t> rings, std::span<const Direction> inner,
                                       std::span<double> values) {
            DirectionSet rows{rings.size(), 1, {}};
            for (const std::size_t ring : rings) rows.directions.push_back(nodes->directions.directions[ring]);
            const DirectionSet columns{inner.size(), 1, {inner.begin(), inner.end()}};
            const std::size_t size = rings.size() * inner.size();
            for (std::size_t c = 0; c < channels; ++c) {
              tabulator->channel(c, rows, columns, {}, values.subspan(c * size, size));
            }
          }};
}

}  // namespace lobe
