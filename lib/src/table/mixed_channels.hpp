#pragma once

#include <Eigen/Core>

#include "lobe/table/table.hpp"

namespace lobe {

/// The table whose channels are linear combinations of the given one's; errors by the absolute values of the weights.
/// Source, factors and names of channels, which hold for the old ones, are dropped.
/// \param weights new channels x old channels
[[nodiscard]] BrdfTable mixed_channels(BrdfTable table, const Eigen::MatrixXd& weights);

}  // namespace lobe
