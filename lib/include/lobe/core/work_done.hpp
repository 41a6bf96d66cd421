#pragma once

#include <cstdint>

namespace [[gnu::visibility("default")]] lobe {

/// Work done by a computation, for stage tables and benches. Where host and device work at the same time, as under
/// patch lights, times are those that the host spends or waits.
struct WorkDone {
  std::uint64_t nodes = 0;        ///< quadrature nodes visited
  std::uint64_t evaluations = 0;  ///< lobes evaluated at nodes
  double seconds_nodes = 0;       ///< time for placing nodes on the host
  double seconds_values = 0;      ///< time for evaluating models on the device
  double seconds_gram = 0;        ///< time for accumulating products on the device
  double seconds_host = 0;        ///< time for combining lobes into materials, errors and distances
};

}  // namespace lobe
