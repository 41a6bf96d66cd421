// Repairs of tables written by hand, whose answers are known in closed form.
#include "energy/repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "energy/albedo.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "metric/routes.hpp"
#include "metric/table_metric.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

constexpr double kRepairRounding = 1e-13;  // of sums over a grid
constexpr auto kCorrections = {Correction::g1, Correction::g2, Correction::controlled};

BrdfTable empty_table(TableForm form, std::size_t channels = 1) {
  BrdfTable table;
  table.grid = HemisphereGrid::gauss(6, 8);
  table.form = form;
  table.channels = channels;
  table.expression = "by hand";
  table.values.assign(channels * table.size(), 0.0);
  table.error.assign(channels * table.grid.rings().size() * table.grid.rings().size(), 0.0);
  return table;
}

BrdfTable lambert(double albedo, TableForm form = TableForm::isotropic) {
  BrdfTable table = empty_table(form);
  std::ranges::fill(table.values, albedo / pi);
  return table;
}

/// u(L) u(V), u by row.
BrdfTable separable(const std::vector<double>& u) {
  BrdfTable table = empty_table(TableForm::isotropic);
  const std::size_t half = table.grid.half_azimuths();
  for (std::size_t i = 0; i < u.size(); ++i) {
    for (std::size_t j = 0; j < u.size(); ++j) {
      for (std::size_t k = 0; k < half; ++k) table.values[(i * u.size() + j) * half + k] = u[i] * u[j];
    }
  }
  return table;
}

/// Reciprocal, of any azimuths, some albedos above 1.
BrdfTable random_table(unsigned seed, std::size_t channels = 1) {
  BrdfTable table = empty_table(TableForm::general, channels);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> value(0, 0.7);
  const std::size_t rows = table.rows();
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        table.channel(c)[i * rows + j] = table.channel(c)[j * rows + i] = value(engine);
      }
    }
  }
  return table;
}

double largest_albedo(const BrdfTable& table, std::size_t channel = 0) {
  return std::ranges::max(row_albedos(table).in[channel], {}, &Estimate::value).value;
}

double largest_asymmetry(const BrdfTable& table) {
  const BrdfTable exchanged = transpose(table);
  double largest = 0;
  for (std::size_t at = 0; at < table.values.size(); ++at) {
    largest = std::max(largest, std::abs(table.values[at] - exchanged.values[at]));
  }
  return largest;
}

TEST(PumpedTable, OfAlbedoAboveOneIsWhite) {
  for (const Correction correction : kCorrections) {
    for (const TableForm form : {TableForm::isotropic, TableForm::general}) {
      SCOPED_TRACE(std::string(to_string(correction)) + (form == TableForm::general ? ", general" : ", isotropic"));
      const PumpedTable pumped = pump(lambert(1.2, form), correction);
      for (const double value : pumped.table.values) EXPECT_NEAR(value, 1 / pi, kRepairRounding);
      EXPECT_NEAR(largest_albedo(pumped.table), 1, kRepairRounding);
    }
  }
}

TEST(PumpedTable, OfADarkDiffuserIsWhiteByG1AndKeepsBelowTheCosinesWhenControlled) {
  EXPECT_NEAR(largest_albedo(pump(lambert(0.3), Correction::g1).table), 1, kRepairRounding);
  // The divisor is never below N.L.
  const PumpedTable controlled = pump(lambert(0.3), Correction::controlled, {.times = 50});
  const auto rings = controlled.table.grid.rings();
  const std::size_t half = controlled.table.grid.half_azimuths();
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const double bound = 0.3 / pi / std::cos(rings[i].theta);
    EXPECT_LE(controlled.table.values[(i * rings.size() + i) * half], bound + kRepairRounding) << i;
  }
}

TEST(PumpedTable, DividesDeltaPartsByWhatBelongsToTheirDirections) {
  BrdfTable table = lambert(0.5);
  const auto rows = table.rows();
  table.mirror.assign(rows, 0.4);
  table.retro.assign(rows, 0.1);
  table.mirror[2] = 0.7;  // albedo 1.3
  const BrdfTable pumped = pump(table, Correction::g1).table;
  for (std::size_t row = 0; row < rows; ++row) {
    EXPECT_NEAR(pumped.mirror[row], row == 2 ? 0.7 / 1.3 : 0.4, kRepairRounding) << row;
    EXPECT_NEAR(pumped.retro[row], row == 2 ? 0.1 / 1.3 : 0.1, kRepairRounding) << row;
  }
  EXPECT_NEAR(largest_albedo(pumped), 1, kRepairRounding);
}

TEST(PumpedTable, OfAMirrorThatDependsOnTheAzimuthDividesByTheLargerOfBothDirections) {
  BrdfTable table = empty_table(TableForm::general);
  table.mirror.assign(table.rows(), 0.5);
  table.mirror[1] = 0.8;  // irreciprocal: the direction opposite has 0.5
  const BrdfTable pumped = pump(table, Correction::g1).table;
  const std::size_t opposite = table.grid.opposite(1);
  EXPECT_NEAR(pumped.mirror[1], 1, kRepairRounding);
  EXPECT_NEAR(pumped.mirror[opposite], 1, kRepairRounding);  // light into node 1 is 0.5, too
}

TEST(PumpedTable, LeavesRowsWithoutLightAlone) {
  BrdfTable table = separable({0.2, 0.2, 0, 0.2, 0.2, 0.2});
  for (const Correction correction : kCorrections) {
    SCOPED_TRACE(to_string(correction));
    const PumpedTable pumped = pump(table, correction, {.times = 3});
    EXPECT_EQ(pumped.steps.back().albedo[0][2].value, 0);
    EXPECT_TRUE(std::ranges::all_of(pumped.table.values, [](double value) { return std::isfinite(value); }));
  }
}

TEST(PumpedTable, HasTheAlbedosThatItsStepsTell) {
  const PumpedTable pumped = pump(random_table(3), Correction::g1, {.times = 2});
  const auto before = row_albedos(random_table(3)).in[0];
  const auto after = row_albedos(pumped.table).in[0];
  ASSERT_EQ(pumped.steps.size(), 3U);
  for (std::size_t row = 0; row < before.size(); ++row) {
    EXPECT_NEAR(pumped.steps[0].albedo[0][row].value, before[row].value, kRepairRounding) << row;
    EXPECT_NEAR(pumped.steps[0].albedo[0][row].error, before[row].error, kRepairRounding) << row;
    EXPECT_NEAR(pumped.steps[2].albedo[0][row].value, after[row].value, kRepairRounding) << row;
  }
}

TEST(PumpedTable, StopsWhereAlbedosStay) {
  const PumpedTable pumped = pump(random_table(1), Correction::g1, {.times = {}, .tolerance = 1e-3});
  EXPECT_TRUE(pumped.is_converged);
  EXPECT_LE(pumped.change, 1e-3);
  EXPECT_GT(pumped.steps.size(), 3U);
  EXPECT_FALSE(pump(random_table(1), Correction::g1, {.times = {}, .tolerance = 1e-9, .limit = 2}).is_converged);
}

TEST(PumpedTable, KnowsNoErrorWhereTheTableKnowsNone) {
  BrdfTable table = lambert(0.5);
  std::ranges::fill(table.error, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(pump(table, Correction::g1).table.error[0]));
}

TEST(Pumping, OfTablesRefusesWhatItCannotDo) {
  BrdfTable negative = lambert(0.5);
  negative.values[3] = -0.1;
  EXPECT_THROW((void)pump(negative, Correction::g1), NumericError);
  EXPECT_THROW((void)pump(lambert(0.5), Correction::g1, {.times = 0}), ArgumentError);
  EXPECT_THROW((void)pump(lambert(0.5), Correction::g1, {.tolerance = 0}), ArgumentError);
}

TEST(NormalisedTable, HasALargestAlbedoOfOne) {
  const BrdfTable table = random_table(2, 2);
  const BrdfTable normalised = normalise(table);
  EXPECT_NEAR(std::max(largest_albedo(normalised, 0), largest_albedo(normalised, 1)), 1, kRepairRounding);
  EXPECT_NEAR(normalised.values[5] / table.values[5], normalised.values[99] / table.values[99], kRepairRounding);
  EXPECT_THROW((void)normalise(empty_table(TableForm::isotropic)), NumericError);
}

TEST(SymmetrisedTable, IsTheMeanOfBothDirections) {
  BrdfTable table = lambert(0.5, TableForm::general);
  const std::size_t rows = table.rows();
  table.values[1] = 0.3;
  table.values[rows] = 0.1;
  const BrdfTable symmetric = symmetrise(table);
  EXPECT_EQ(symmetric.values[1], 0.2);
  EXPECT_EQ(symmetric.values[rows], 0.2);
  EXPECT_EQ(largest_asymmetry(symmetric), 0);
  EXPECT_EQ(symmetrise(symmetric).values, symmetric.values);
  EXPECT_EQ(symmetrise(symmetric).expression, symmetric.expression);
  // Two values moved by 0.1 each.
  const double weights = table.grid.weights()[0] * table.grid.weights()[1];
  EXPECT_NEAR(table_displacement(table, symmetric).absolute.value, 0.1 * std::sqrt(2 * weights), kRepairRounding);
}

TEST(SymmetrisedTable, TakesTheMeanOfOppositeMirrors) {
  BrdfTable table = empty_table(TableForm::general);
  table.mirror.assign(table.rows(), 0.5);
  table.mirror[1] = 0.8;
  const BrdfTable symmetric = symmetrise(table);
  EXPECT_EQ(symmetric.mirror[1], 0.65);
  EXPECT_EQ(symmetric.mirror[table.grid.opposite(1)], 0.65);
}

TEST(BalancedTable, OfADiffuserAndOfAMirrorHasTheRootOfTheAlbedo) {
  const BalancedTable diffuse = scale_symmetrically(lambert(1.44));
  for (const double s : diffuse.factors[0]) EXPECT_NEAR(s, 1 / 1.2, 1e-12);
  BrdfTable table = empty_table(TableForm::isotropic);
  table.mirror.assign(table.rows(), 0.9);
  table.mirror[1] = 4;
  const BalancedTable mirror = scale_symmetrically(table);
  EXPECT_NEAR(mirror.factors[0][1], 0.5, 1e-12);
  EXPECT_EQ(mirror.factors[0][2], 1);
  EXPECT_NEAR(mirror.table.mirror[1], 1, 1e-12);
}

TEST(BalancedTable, OfASeparableReflectanceIsThatOfOneEquation) {
  // s_i = min(1, 1 / (u_i U)), U = sum w u s: the root of a falling function of U, found here by bisection.
  const std::vector<double> u{0.4, 0.4, 0.5, 0.6, 1.1, 1.4};
  const BrdfTable table = separable(u);
  const auto factor = [&](std::size_t i, double total) { return std::min(1.0, 1 / (u[i] * total)); };
  double low = 0;
  double high = 10;
  for (int step = 0; step < 100; ++step) {
    const double total = (low + high) / 2;
    double sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const Ring& ring = table.grid.rings()[i];
      sum += ring.weight * static_cast<double>(ring.count) * u[i] * factor(i, total);
    }
    (sum > total ? low : high) = total;
  }
  const BalancedTable balanced = scale_symmetrically(table);
  ASSERT_LT(balanced.factors[0][5], 1);
  ASSERT_EQ(balanced.factors[0][0], 1);
  for (std::size_t i = 0; i < u.size(); ++i) EXPECT_NEAR(balanced.factors[0][i], factor(i, low), 1e-12) << i;
}

TEST(BalancedTable, ToWhiteOfASeparableReflectanceIsTheWhiteDiffuser) {
  const BalancedTable white = scale_symmetrically(separable({0.4, 0.4, 0.5, 0.6, 1.1, 1.4}), {.to_white = true});
  for (const double value : white.table.values) EXPECT_NEAR(value, 1 / pi, 1e-11);
}

TEST(BalancedTable, DarkensNoRowMoreThanItsBalanceAsks) {
  const BrdfTable table = random_table(4);
  const BalancedTable balanced = scale_symmetrically(table);
  const auto albedos = row_albedos(balanced.table).in[0];
  EXPECT_LT(std::ranges::min(balanced.factors[0]), 0.99);
  for (std::size_t row = 0; row < albedos.size(); ++row) {
    EXPECT_LE(albedos[row].value, 1 + 2e-12) << row;
    if (balanced.factors[0][row] < 1) {
      EXPECT_NEAR(albedos[row].value, 1, 2e-12) << row;
    }
  }
  EXPECT_LE(largest_asymmetry(balanced.table), 1e-15);
}

TEST(BalancedTable, OfOneThatIsBalancedIsItself) {
  const BalancedTable dark = scale_symmetrically(lambert(0.9));
  EXPECT_EQ(dark.sweeps, 0U);
  EXPECT_EQ(dark.table.values, lambert(0.9).values);
  const BalancedTable once = scale_symmetrically(random_table(5));
  const BalancedTable twice = scale_symmetrically(once.table, {.tolerance = 2e-12});  // the first one's and rounding
  EXPECT_EQ(twice.sweeps, 0U);
  EXPECT_EQ(twice.table.values, once.table.values);
}

TEST(BalancedTable, HasFactorsByChannelOrTheSameForAll) {
  BrdfTable table = random_table(6, 2);
  for (double& value : table.channel(1)) value *= 0.1;
  const BalancedTable apart = scale_symmetrically(table);
  EXPECT_LT(std::ranges::min(apart.factors[0]), 1);
  EXPECT_EQ(std::ranges::min(apart.factors[1]), 1);
  const BalancedTable together = scale_symmetrically(table, {.channels_together = true});
  EXPECT_EQ(together.factors[0], together.factors[1]);
  EXPECT_LE(largest_albedo(together.table, 0), 1 + 2e-12);
  for (const std::size_t at : {3U, 700U}) {
    SCOPED_TRACE(at);
    EXPECT_NEAR(together.table.channel(0)[at] * table.channel(1)[at],
                together.table.channel(1)[at] * table.channel(0)[at], 1e-15);
  }
}

TEST(BalancedTable, RefusesWhatCannotBeBalanced) {
  BrdfTable irreciprocal = lambert(1.5, TableForm::general);
  irreciprocal.values[1] = 0.9;
  EXPECT_THROW((void)scale_symmetrically(irreciprocal), NumericError);
  BrdfTable negative = lambert(1.5);
  negative.values[0] = -1;
  EXPECT_THROW((void)scale_symmetrically(negative), NumericError);
  EXPECT_THROW((void)scale_symmetrically(empty_table(TableForm::isotropic), {.to_white = true}), NumericError);
  EXPECT_THROW((void)scale_symmetrically(lambert(1.5), {.tolerance = 0}), ArgumentError);
  std::vector<MissedTolerance> missed;
  const BalancedTable once = scale_symmetrically(
      random_table(4), {.limit = 1, .missed = [&](const MissedTolerance& one) { missed.push_back(one); }});
  EXPECT_EQ(once.sweeps, 1U);
  EXPECT_GT(once.departure, BalanceOptions{}.tolerance);
  ASSERT_EQ(missed.size(), 1U);
  EXPECT_EQ(missed.front().relative_error, once.departure);
  EXPECT_THROW((void)scale_symmetrically(random_table(4), {.limit = 1, .missed = refuse_missed_tolerance}),
               NumericError);
}

TEST(Displacement, OfWhatStaysIsZeroAndOfMirrorsIsThatOfAlbedos) {
  EXPECT_EQ(table_displacement(lambert(0.5), lambert(0.5)).absolute.value, 0);
  BrdfTable before = empty_table(TableForm::isotropic);
  before.mirror.assign(before.rows(), 0.8);
  BrdfTable after = before;
  after.mirror.assign(after.rows(), 0.6);
  const Displacement moved = table_displacement(before, after);
  EXPECT_EQ(moved.lighting.name(), "daylight");
  EXPECT_NEAR(moved.absolute.value, 0.2 * std::sqrt(pi), kRepairRounding);
  EXPECT_NEAR(moved.relative.value, 0.25, kRepairRounding);
}

}  // namespace
}  // namespace lobe::test
