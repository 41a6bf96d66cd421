// Averages over cells with less effort.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "lobe/hemisphere/grid.hpp"
#include "table/cell_average.hpp"

namespace lobe::test {
namespace {

/// Averages over Klems' cells of a lobe that ends steeply, and how many pairs they took.
struct Averages {
  BrdfTable table;
  std::size_t pairs = 0;
};
Averages averages_with(const CellEffort& effort) {
  Averages result;
  result.table.grid = HemisphereGrid::parse("klems:145");
  result.table.form = TableForm::general;
  result.table.channels = 1;
  AveragedFunction function;
  function.name = "steep";
  function.is_bilateral = true;
  function.is_concurrent = false;
  function.at = [&](std::span<const Directions> pairs) {
    result.pairs += pairs.size();
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Directions& pair = pairs[i];
      const double cos_r = std::cos(pair.theta_in) * std::cos(pair.theta_out) -
                           std::sin(pair.theta_in) * std::sin(pair.theta_out) * std::cos(pair.delta_phi);
      values.value(static_cast<Eigen::Index>(i), 0) = std::pow(std::max(cos_r, 0.0), 0.3);
    }
    return values;
  };
  function.effort = effort;
  average_over_cells(function, result.table, 4, {});
  return result;
}

TEST(CellEffort, SavesPairsAndStatesWhatTheyWereWorth) {
  const Averages full = averages_with({});
  const Averages rough = averages_with({.tolerance = 1e-2});
  const Averages short_of = averages_with({.budget = std::size_t{1} << 20U});

  EXPECT_LT(rough.pairs, full.pairs / 4);
  EXPECT_LT(short_of.pairs, full.pairs / 2);
  EXPECT_LT(rough.pairs, short_of.pairs + (std::size_t{1} << 20U));
  for (const Averages* less : {&rough, &short_of}) {
    SCOPED_TRACE(less == &rough ? "tolerance" : "budget");
    double largest = 0;
    double largest_share = 0;
    std::size_t above = 0;
    for (std::size_t at = 0; at < full.table.size(); ++at) {
      const HemisphereGrid& grid = full.table.grid;
      const std::size_t rings = grid.rings().size();
      const std::size_t pair = grid.ring_of(at / grid.nodes()) * rings + grid.ring_of(at % grid.nodes());
      const double change = std::abs(less->table.values[at] - full.table.values[at]);
      const double share = change / (less->table.error[pair] + full.table.error[pair]);
      if (share > 1) ++above;
      largest_share = std::max(largest_share, share);
      largest = std::max(largest, change);
    }
    EXPECT_GT(largest, 1e-6);
    // Differences of levels bound what is left of a root but for some places of its end.
    EXPECT_LE(above, full.table.size() / 100);
    EXPECT_LE(largest_share, 2);
  }
}

}  // namespace
}  // namespace lobe::test
