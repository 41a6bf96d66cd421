#include "algebra/inner_factors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/parallel.hpp"
#include "lobe/core/error.hpp"
#include "model/traits.hpp"
#include "table/lobe_tabulator.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kPairsAtOnce = 4096;  // of a call of a function

/// The angle between L and V over which a function falls to a half of its value in the mirror direction, of the
/// channel that does so soonest, as a half-vector width; 1 where it does not.
double width_of(const BrdfFunction& brdf) {
  constexpr double kNarrowest = 0.004;
  constexpr double kGrowth = 1.4;
  double width = 1;
  for (const double theta : {0.2, 0.7, 1.2}) {
    std::vector<Directions> pairs{{theta, theta, pi}};
    for (double step = 2 * kNarrowest; theta + step < pi / 2; step *= kGrowth) {
      pairs.push_back({theta, theta + step, pi});
    }
    const Eigen::MatrixXd values = brdf.at(pairs).value;
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
      for (Eigen::Index k = 1; k < values.rows(); ++k) {
        if (values(k, c) > values(0, c) / 2) continue;
        width = std::min(width, (pairs[static_cast<std::size_t>(k)].theta_out - theta) / 2);
        break;
      }
    }
  }
  return width;
}

}  // namespace

bool can_be_factor(const Material& material) {
  return !material.terms.empty() && is_isotropic(material) && is_reciprocal(material);
}

InnerFactor formula_factor(const Device& device, const Material& material, const HemisphereGrid& grid,
                           Precision precision) {
  const auto tabulator = std::make_shared<const LobeTabulator>(device, material, precision);
  const std::size_t channels = tabulator->lobes().channels();
  const auto nodes = std::make_shared<const NodeSet>(ring_nodes(grid, 1));
  return {tabulator->lobes().extent(), channels, true, true,
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

InnerFactor function_factor(const BrdfFunction& brdf, const HemisphereGrid& grid, FactorPlace place) {
  std::vector<double> thetas;
  for (const Ring& ring : grid.rings()) thetas.push_back(ring.theta);
  const std::size_t channels = brdf.channels.size();
  LobeExtent extent;
  extent.width = width_of(brdf);
  return {extent, channels, brdf.is_bilateral, false,
          [brdf, thetas, place, channels](std::span<const std::size_t> rings, std::span<const Direction> inner,
                                          std::span<double> values) {
            const std::size_t parts = (inner.size() + kPairsAtOnce - 1) / kPairsAtOnce;
            const auto fill = [&](std::size_t part) {
              const double theta = thetas[rings[part / parts]];
              const std::size_t first = part % parts * kPairsAtOnce;
              const auto some = inner.subspan(first, std::min(kPairsAtOnce, inner.size() - first));
              std::vector<Directions> pairs;
              for (const Direction& x : some) {
                pairs.push_back(place == FactorPlace::first ? Directions{theta, x.theta, x.phi}
                                                            : Directions{x.theta, theta, -x.phi});
              }
              const Eigen::MatrixXd found = brdf.at(pairs).value;
              if (!found.allFinite()) throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
              for (std::size_t c = 0; c < channels; ++c) {
                double* const out = values.data() + (c * rings.size() + part / parts) * inner.size() + first;
                std::copy_n(found.col(static_cast<Eigen::Index>(c)).data(), some.size(), out);
              }
            };
            if (brdf.is_concurrent) {
              parallel_for(rings.size() * parts, fill);
            } else {
              for (std::size_t part = 0; part < rings.size() * parts; ++part) fill(part);
            }
          }};
}

}  // namespace lobe
