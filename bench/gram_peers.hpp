#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "hemisphere/half_difference_rule.hpp"
#include "model/lobes.hpp"
#include "peers/eigen_host.hpp"

namespace bench {

/// Nodes of a quadrature by columns; rows as in NodeBlock, which is what peers::Nodes wants.
using NodeRows = Eigen::Matrix<double, 8, Eigen::Dynamic, Eigen::RowMajor>;

/// The nodes of all slabs of a rule at a level of refinement.
[[nodiscard]] NodeRows collect_nodes(const lobe::HalfDifferenceRule& rule, int level);

/// The lobes in their order, for the peers.
[[nodiscard]] std::vector<peers::HostLobe> host_lobes(const lobe::LobeSet& lobes);

/// Seconds of peers/gram.py, and its Gram matrix's trace and sum.
struct NumpyStudy {
  double evaluate = 0;
  double products = 0;
  double distances = 0;
  double trace = 0;
  double sum = 0;

  [[nodiscard]] double seconds() const { return evaluate + products + distances; }
};

/// Runs the NumPy peer; no value where python() has no NumPy.
[[nodiscard]] std::optional<NumpyStudy> run_numpy(const NodeRows& nodes, std::span<const peers::HostLobe> lobes);

}  // namespace bench
