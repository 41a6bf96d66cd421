#pragma once

#include "lobe/compare/literature_metric.hpp"
#include "metric/routed_set.hpp"

namespace lobe {

/// compare() of a set, by the route of `options`, whatever the set's own are.
[[nodiscard]] LiteratureResult compare(RoutedSet& set, LiteratureMetric comparison, const LiteratureOptions& options);

}  // namespace lobe
