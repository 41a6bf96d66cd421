#pragma once

#include <span>
#include <vector>

#include "metric/products.hpp"

namespace lobe {

/// Products that are sums over a grid: those of each channel, then their weighted sum.
struct GridProducts {
  std::vector<ChannelProducts> products;  ///< with all errors
  std::vector<ChannelProducts> sums;      ///< with the errors of the sums alone, by the grid's embedded rules
};

/// The products on the last of successive grids, from coarse to fine. The error of their sums is, where there are three
/// grids or more, what the change from the grid before leaves to expect, if that is less than the embedded rules say;
/// to it come the errors of the values that are summed.
/// \param caution factor of the errors of sums, for what may converge more slowly
[[nodiscard]] std::vector<ChannelProducts> with_grid_errors(std::span<const GridProducts> levels, double caution = 1);

/// The largest error of products, relative to the norms of both factors.
[[nodiscard]] double worst_error(const ChannelProducts& products);

}  // namespace lobe
