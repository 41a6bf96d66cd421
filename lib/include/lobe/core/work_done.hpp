#pragma once

#include <cstdint>

namespace [[gnu::visibility("default")]] lobe {

/// Work done, for stage tables and benches.
struct WorkDone {
  std::uint64_t nodes = 0;        ///< quadrature nodes visited
  std::uint64_t evaluations = 0;  ///< lobes evaluated at nodes
  double seconds_nodes = 0;       ///< placing nodes on the host
  double seconds_samples = 0;     ///< evaluating models on the device
  double seconds_gram = 0;        ///< accumulating products on the device
  double seconds_host = 0;        ///< combining lobes into materials, errors, distances
};

}  // namespace lobe
