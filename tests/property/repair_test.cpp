// What repairs promise, of tables of every model and of published fits.
#include "energy/repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "energy/plausibility.hpp"
#include "energy/prepare.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/energy/plausibility.hpp"
#include "lobe/model/model.hpp"
#include "lobe/study/study.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/materials.hpp"
#include "support/names.hpp"
#include "support/tables.hpp"
#include "table/evaluate.hpp"

namespace lobe::test {
namespace {

constexpr double kRounding = 1e-12;  // of sums over a grid and of quotients
constexpr int kTimes = 3;

/// Materials whose tables are looked at: samples, every isotropic and reciprocal model without negative values at its
/// defaults, a brushed metal, and published fits, of which the narrowest lobes are not resolved: what is promised holds
/// in the measure of any grid.
std::vector<Material> materials() {
  std::vector<Material> list = parse_all(sample_specifications());
  for (const auto& model : catalogue()) {
    if (!model.traits.isotropic || !model.traits.reciprocal || !model.traits.non_negative) continue;
    list.push_back(checked_materials(model.name, 0).front());
  }
  list.push_back(parse_material("ward_anisotropic:m_x=0.2,m_y=0.5,rotation=0.3"));
  const Study fits = load_study(LOBE_STUDIES_DIR "/merl-fits.toml");
  for (std::size_t k = 0; k < fits.materials.size(); k += 6) list.push_back(*fits.materials[k].formula());
  return list;
}

const std::vector<BrdfTable>& tables() {
  static const std::vector<BrdfTable> list = [] {
    std::vector<BrdfTable> made;
    for (const Material& material : materials()) made.push_back(table_of(material, HemisphereGrid::gauss(12, 24)));
    return made;
  }();
  return list;
}

/// Calls look(table, pumped) for every table.
void for_steps(Correction correction, const std::function<void(const BrdfTable&, const PumpedTable&)>& look) {
  for (const BrdfTable& table : tables()) {
    SCOPED_TRACE(table.expression);
    look(table, pump(table, correction, {.times = kTimes}));
  }
}

class PumpedTables : public ::testing::TestWithParam<Correction> {};

TEST_P(PumpedTables, HaveAlbedosOfAtMostOneThatGrowFromStepToStep) {
  ASSERT_GE(tables().size(), 100U);
  for_steps(GetParam(), [](const BrdfTable&, const PumpedTable& pumped) {
    for (std::size_t k = 1; k < pumped.steps.size(); ++k) {
      for (std::size_t c = 0; c < pumped.table.channels; ++c) {
        const auto& before = pumped.steps[k - 1].albedo[c];
        const auto& after = pumped.steps[k].albedo[c];
        const bool was_balanced =
            std::ranges::all_of(before, [](const Estimate& albedo) { return albedo.value <= 1 + kRounding; });
        for (std::size_t row = 0; row < after.size(); ++row) {
          EXPECT_LE(after[row].value, 1 + kRounding) << k << ' ' << c << ' ' << row;
          if (was_balanced) {
            EXPECT_GE(after[row].value, before[row].value - kRounding) << k << ' ' << c << ' ' << row;
          }
        }
      }
    }
  });
}

TEST_P(PumpedTables, StayReciprocal) {
  for_steps(GetParam(), [](const BrdfTable& table, const PumpedTable& pumped) {
    const auto before = check_plausibility(table);
    const auto after = check_plausibility(pumped.table);
    for (std::size_t c = 0; c < table.channels; ++c) {
      EXPECT_LE(after.channels[c].reciprocity.relative, before.channels[c].reciprocity.relative + kRounding) << c;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(all, PumpedTables, ::testing::Values(Correction::g1, Correction::g2, Correction::controlled),
                         [](const auto& instance) { return std::string(to_string(instance.param)); });

TEST(ControlledPumpedTables, ReflectNoRadianceAboveThatOfTheLight) {
  // f*(L, R) N.L <= f(L, R): G is nowhere below N.L (2.22).
  for_steps(Correction::controlled, [](const BrdfTable& table, const PumpedTable& pumped) {
    for (const PumpStep& step : pumped.steps) {
      for (std::size_t c = 0; c < table.channels; ++c) {
        for (std::size_t row = 0; row < table.rows(); ++row) {
          const double theta =
              table.form == TableForm::isotropic ? table.grid.rings()[row].theta : table.grid.directions()[row].theta;
          const double light = pumped.steps[0].mirror_radiance[c][row].value / std::cos(theta);
          EXPECT_LE(step.mirror_radiance[c][row].value, light * (1 + kRounding)) << c << ' ' << row;
        }
      }
    }
  });
}

TEST(PumpedTable, TendsToWhiteByG1) {
  for (const char* text : {"phong:n=5", "ward:m=0.3", "lambert:scale=0.3+blinn:n=3,scale=0.5"}) {
    const PumpedTable pumped = pump(table_of(text), Correction::g1, {.times = {}, .tolerance = 1e-4});
    EXPECT_TRUE(pumped.is_converged) << text;
    for (const Estimate& albedo : pumped.steps.back().albedo[0]) EXPECT_NEAR(albedo.value, 1, 0.01) << text;
  }
}

struct Pumped {
  std::string specification;
  Correction correction;
  int times;
};

class PumpedAsMaterial : public ::testing::TestWithParam<Pumped> {};

TEST_P(PumpedAsMaterial, IsWithinTheErrorBars) {
  const auto& [text, correction, times] = GetParam();
  const auto grid = HemisphereGrid::gauss(32, 64);
  const PumpedMaterial material = pump(device(), parse_material(text), correction, {.times = times});
  const BrdfTable expected = table_of(material.steps.back(), grid);
  const BrdfTable found = pump(table_of(text, grid), correction, {.times = times}).table;
  const std::size_t half = grid.half_azimuths();
  double worst = 0;
  for (std::size_t at = 0; at < found.values.size(); ++at) {
    const double bound = found.error[at / half] + times * kAdjustmentError * std::abs(expected.values[at]);
    worst = std::max(worst, std::abs(found.values[at] - expected.values[at]) / bound);
  }
  EXPECT_LE(worst, 1);
}

INSTANTIATE_TEST_SUITE_P(all, PumpedAsMaterial,
                         ::testing::Values(Pumped{"phong:n=20", Correction::controlled, 2},
                                           Pumped{"phong:n=5,scale=0.5", Correction::g1, 3},
                                           Pumped{"blinn:n=20", Correction::g2, 1},
                                           Pumped{"ward:m=0.3", Correction::g1, 1},
                                           Pumped{"lambert:scale=0.3+phong:n=10,scale=0.4", Correction::g1, 2}));

/// Pairs of directions anywhere but at the horizon, where tables of few rings are continued.
std::vector<Directions> random_pairs(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> theta(0, 86 * kDegree);
  std::uniform_real_distribution<double> azimuth(-std::numbers::pi, std::numbers::pi);
  std::vector<Directions> pairs(count);
  for (Directions& pair : pairs) pair = {theta(random), theta(random), azimuth(random)};
  return pairs;
}

class TablesPumpedAcrossAKink : public ::testing::TestWithParam<const char*> {};

// g2 has a kink where both angles are the same, on which polynomials of any degree agree by accident.
TEST_P(TablesPumpedAcrossAKink, HoldTheirErrorsBetweenNodes) {
  constexpr std::size_t kPairs = 800;
  const auto pairs = random_pairs(kPairs, 20);
  const PumpedMaterial material = pump(device(), parse_material(GetParam()), Correction::g2, {.times = 1});
  const BrdfTable table = pump(table_of(GetParam(), HemisphereGrid::gauss(32, 64)), Correction::g2, {.times = 1}).table;
  const auto expected = evaluate(device(), material.steps.back(), pairs);
  const auto found = evaluate(table, pairs);
  std::size_t above = 0;
  double worst = 0;
  for (std::size_t k = 0; k < kPairs; ++k) {
    const double exact = expected(static_cast<Eigen::Index>(k), 0);
    const double stated = found[0][k].error + kAdjustmentError * std::abs(exact);
    const double ratio = std::abs(found[0][k].value - exact) / stated;
    above += ratio > 1 ? 1 : 0;
    worst = std::max(worst, ratio);
  }
  EXPECT_LE(above, kPairs / 200);  // without the share of fourth differences up to 7 %, by factors up to 11
  EXPECT_GE(worst, 0.1);
  // Up to 4 where the kink lies in a lobe as high. Of Lambert's it is alone: half of the share would be too little.
  EXPECT_LE(worst, std::string(GetParam()) == "lambert:scale=0.5" ? 1 : 4);
}

// The share was chosen on the first five.
INSTANTIATE_TEST_SUITE_P(all, TablesPumpedAcrossAKink,
                         ::testing::Values("lambert:scale=0.5", "phong:n=10,scale=0.6", "ward:m=0.4,scale=0.7",
                                           "oren_nayar:sigma=0.4", "minnaert:k=0.6",
                                           "lambert:scale=0.3+blinn:n=10,scale=0.3", "lommel_seeliger",
                                           "ward:m=0.6,scale=0.5", "ggx:alpha=0.5,scale=0.8"));

/// An anisotropic formula of equal widths is pumped up as a general table, its isotropic twin as a formula.
TEST(PumpedAnisotropicFormula, OfEqualWidthsHasTheAlbedosOfItsIsotropicTwin) {
  const auto grid = HemisphereGrid::gauss(12, 24);
  PumpOptions options;
  options.times = 2;
  options.table = {.grid = grid, .tabulation = {.allow_unresolved = true}};
  const auto found = pump(device(), Reflectance(parse_material("ward_anisotropic:m_x=0.5,m_y=0.5,rotation=0.4")),
                          Correction::g1, options);
  options.theta_in = {grid.rings()[1].theta, grid.rings()[6].theta, grid.rings()[10].theta};
  const auto twin = pump(device(), Reflectance(parse_material("ward:m=0.5")), Correction::g1, options);

  ASSERT_NE(found.result.table(), nullptr);
  ASSERT_EQ(found.steps.size(), 3U);
  ASSERT_EQ(twin.steps.size(), 3U);
  const std::size_t rings[] = {1, 6, 10};
  for (std::size_t step = 0; step < 3; ++step) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Estimate& expected = twin.steps[step].albedo[0][k];
      for (std::size_t turn = 0; turn < 24; turn += 5) {
        const Estimate& value = found.steps[step].albedo[0][grid.rings()[rings[k]].first_node + turn];
        EXPECT_NEAR(value.value, expected.value, value.error + expected.error) << step << " " << k << " " << turn;
        // Twelve rings do not resolve the lobe at the last of these, near the horizon.
        if (k < 2) {
          EXPECT_LT(value.error, 0.3 * value.value) << step << " " << k << " " << turn;
        }
      }
    }
  }
}

TEST(PumpedMaterial, StopsWhereAlbedosStay) {
  const PumpedMaterial found = pump(device(), parse_material("lambert:scale=0.4"), Correction::g1, {.times = {}});
  EXPECT_TRUE(found.is_converged);
  EXPECT_EQ(found.steps.size(), 3U);  // the second one changes nothing
  EXPECT_NEAR(mean_albedo(device(), found.steps.back()).at(0).value, 1, 1e-6);
}

TEST(PumpedMaterial, TellsWhatStoppedIt) {
  const Material material = parse_material("blinn:n=20");
  const PumpedMaterial found = pump(device(), material, Correction::g2, {.times = {}, .limit = 2});
  EXPECT_FALSE(found.is_converged);
  EXPECT_EQ(found.obstacle, "2 steps did not suffice");
  EXPECT_EQ(found.steps.size(), 3U);
}

// No curve holds an albedo that jumps.
TEST(PumpedMaterial, OfAnAlbedoThatJumpsIsRefused) {
  Material material{"steps", "custom", {{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}}}};
  material.terms.front().formula =
      Formula{.text = "where(cos_i > 0.4 && cos_o > 0.4, 0.2, 0.1)", .width = 1, .reciprocal = true};
  try {
    (void)pump(device(), material, Correction::g1, {.times = 1});
    FAIL() << "not refused";
  } catch (const NumericError& error) {
    EXPECT_NE(std::string(error.what()).find("not smooth"), std::string::npos) << error.what();
  }
}

TEST(BalancedTables, HaveAlbedosOfAtMostOneAndStayAsTheyAreWhenBalancedAgain) {
  std::size_t darkened = 0;
  for (const BrdfTable& table : tables()) {
    SCOPED_TRACE(table.expression);
    const BalancedTable balanced = scale_symmetrically(table);
    if (balanced.sweeps > 0) ++darkened;
    const auto before = check_plausibility(table);
    const auto after = check_plausibility(balanced.table);
    for (std::size_t c = 0; c < table.channels; ++c) {
      EXPECT_LE(after.channels[c].albedo.largest.value, 1 + kRounding) << c;
      EXPECT_LE(after.channels[c].reciprocity.relative, before.channels[c].reciprocity.relative + kRounding) << c;
      if (before.channels[c].albedo.largest.value <= 1) {
        EXPECT_EQ(std::ranges::min(balanced.factors[c]), 1) << c;
      }
    }
    EXPECT_EQ(scale_symmetrically(balanced.table, {.tolerance = 2 * kRounding}).sweeps, 0U);
  }
  EXPECT_GE(darkened, 20U);
}

TEST(BalancedTable, ConvergesWithTheGridWithinItsErrors) {
  // In between nodes that two grids do not share.
  const std::vector<Directions> pairs{
      {0.1, 0.2, 3.0}, {0.5, 0.5, 3.1}, {0.3, 0.9, 2.0}, {0.9, 1.2, 1.0}, {0.7, 0.1, 0.5}};
  const auto of = [&](std::size_t rings) {
    const auto table = table_of("lambert:scale=0.5+phong:n=20,scale=0.7", HemisphereGrid::gauss(rings, 2 * rings));
    const BalancedTable balanced = scale_symmetrically(table);
    EXPECT_LT(balanced.factors[0].front(), 0.95);
    EXPECT_EQ(balanced.factors[0].back(), 1);
    return evaluate(balanced.table, pairs)[0];
  };
  const auto coarse = of(24);
  const auto fine = of(96);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    EXPECT_NEAR(coarse[k].value, fine[k].value, coarse[k].error + fine[k].error) << k;
    EXPECT_NEAR(coarse[k].value, fine[k].value, 2e-3 * fine[k].value) << k;
  }
}

}  // namespace
}  // namespace lobe::test
