#pragma once

#include <span>
#include <string>

#include "lobe/cluster/clustering.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/label.hpp"

namespace lobe {

/// NAME.<lighting>.medoids.csv: every material with its medoid, by medoid, then by rising distance from it: the medoid
/// comes first.
[[nodiscard]] std::string medoids_csv(std::span<const MaterialLabel> materials, const Metric& metric,
                                      const Clustering& clustering);

/// NAME.<lighting>.neighbours.csv: for every material its nearest ones.
[[nodiscard]] std::string neighbours_csv(std::span<const MaterialLabel> materials, const Clustering& clustering);

}  // namespace lobe
