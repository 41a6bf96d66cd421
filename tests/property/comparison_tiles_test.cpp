// Metrics of the literature of many materials, which are cut into tiles of the triangle of all pairs.
#include "compare/comparison_tiles.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/comparison_routes.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study.hpp"
#include "lobe/study/study_plan.hpp"
#include "study/run/study_computation.hpp"
#include "study/run/unit_records.hpp"
#include "support/device.hpp"
#include "support/materials.hpp"

namespace lobe::test {
namespace {

TEST(ComparisonTiles, HaveEachPairOnce) {
  for (const std::size_t materials : {1U, 2U, 5U, 8U, 9U, 100U, 128U, 129U, 257U}) {
    for (const std::size_t most : {std::size_t{1}, std::size_t{3}, std::size_t{4}, std::size_t{100}, kTileMaterials}) {
      std::set<std::pair<std::size_t, std::size_t>> pairs;
      std::size_t count = 0;
      for (const ComparisonTile& tile : comparison_tiles(materials, most)) {
        EXPECT_LE(tile.rows.size(), most);
        EXPECT_LE(tile.columns.size(), most);
        EXPECT_GE(2 * tile.rows.size(), std::min(most, materials)) << materials << ' ' << most;  // none is a scrap
        for (std::size_t i = tile.rows.first; i < tile.rows.end; ++i) {
          for (std::size_t j = tile.is_triangle() ? i + 1 : tile.columns.first; j < tile.columns.end; ++j) {
            EXPECT_LT(i, j);
            pairs.emplace(i, j);
          }
        }
        count += tile.pairs();
      }
      EXPECT_EQ(count, materials * (materials - 1) / 2) << materials << ' ' << most;
      EXPECT_EQ(pairs.size(), count) << materials << ' ' << most;
    }
  }
}

/// Grey ones among those with two channels, all grey ones in one range; one that is sharp; two that are the same.
std::vector<Material> mixed_materials() {
  auto materials = parse_all({"lambert:scale=0.3", "phong:n=20,scale=0.4", "ward:m=0.2", "oren_nayar:sigma=0.5",
                              "lambert+ward:m=0.3,scale=0.3", "lambert+ward:m=0.05,scale=0.1", "phong:n=20,scale=0.4",
                              "ggx:alpha=0.4"});
  materials[4].terms.front().weight = {0.2, 0.4};
  materials[5].terms.front().weight = {0.4, 0.1};
  materials[7].terms.front().weight = {0.5, 0.7};
  return materials;
}

class TiledComparison : public ::testing::TestWithParam<LiteratureMetric> {
 protected:
  static LiteratureResult compare(std::size_t most, const TileStore* store = nullptr) {
    return compare_formulas(device(), mixed_materials(), GetParam(), options(), store, most);
  }
  static LiteratureOptions options() {
    LiteratureOptions options;
    options.tolerance = 2e-3;
    options.channel_weights = {0.3, 0.9};
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(property, TiledComparison,
                         ::testing::Values(LiteratureMetric::bieron_l2, LiteratureMetric::cube_root,
                                           LiteratureMetric::log_relative, LiteratureMetric::albedo_of_difference),
                         [](const auto& instance) { return "metric" + std::to_string(instance.index); });

void expect_equal_within_errors(const LiteratureMatrix& one, const LiteratureMatrix& other) {
  for (Eigen::Index j = 0; j < one.distance.cols(); ++j) {
    EXPECT_NEAR(one.size(j), other.size(j), one.size_error(j) + other.size_error(j)) << j;
    for (Eigen::Index i = 0; i < one.distance.rows(); ++i) {
      EXPECT_NEAR(one.distance(i, j), other.distance(i, j), one.distance_error(i, j) + other.distance_error(i, j))
          << i << ' ' << j;
    }
  }
}

TEST_P(TiledComparison, IsThatOfAllPairsWithinItsErrors) {
  const LiteratureResult whole = compare(100);
  for (const std::size_t most : {3U, 4U}) {
    const LiteratureResult tiled = compare(most);
    expect_equal_within_errors(tiled.combined, whole.combined);
    ASSERT_EQ(tiled.channels.size(), 2U) << most;
    for (std::size_t c = 0; c < 2; ++c) expect_equal_within_errors(tiled.channels[c], whole.channels[c]);
    EXPECT_EQ(tiled.combined.distance, Eigen::MatrixXd(tiled.combined.distance.transpose())) << most;
    EXPECT_EQ(tiled.combined.distance(1, 6), 0) << most;  // of two tiles, the same material
    EXPECT_EQ(tiled.combined.distance_error(1, 6), 0) << most;
    EXPECT_TRUE(tiled.unresolved.empty()) << most;
  }
}

TEST_P(TiledComparison, TakesTilesThatAreKnown) {
  const LiteratureResult computed = compare(3);
  const auto tiles = comparison_tiles(mixed_materials().size(), 3);
  ASSERT_EQ(tiles.size(), 6U);
  const TileStore store{.has = [](std::size_t tile) { return tile % 2 == 1; },
                        .get =
                            [&](std::size_t tile) {
                              const TileIntegrals one =
                                  compare_tile(device(), mixed_materials(), tiles[tile], GetParam(), options());
                              TileIntegrals read;
                              EXPECT_TRUE(read_unit(written_unit(one), read)) << tile;
                              return read;
                            },
                        .keep = [](std::size_t tile, const TileIntegrals&, double) { EXPECT_EQ(tile % 2, 0U); }};
  const LiteratureResult taken = compare(3, &store);
  EXPECT_EQ(taken.combined.distance, computed.combined.distance);
  EXPECT_EQ(taken.combined.distance_error, computed.combined.distance_error);
  EXPECT_EQ(taken.channels[1].size_error, computed.channels[1].size_error);
  EXPECT_EQ(taken.work.nodes, computed.work.nodes);
  EXPECT_EQ(taken.work.evaluations, computed.work.evaluations);

  const TileStore foreign{
      .has = [](std::size_t tile) { return tile == 0; },
      .get = [&](std::size_t) { return compare_tile(device(), mixed_materials(), tiles[1], GetParam(), options()); },
      .keep = [](std::size_t, const TileIntegrals&, double) {}};
  EXPECT_THROW(static_cast<void>(compare(3, &foreign)), IoError);
}

/// More materials than a tile has, quick to compare.
Study wide_study() {
  Study study;
  study.name = "wide";
  study.title = "Wide";
  study.comparison_metrics = {LiteratureMetric::bieron_l2, LiteratureMetric::cube_root_log};
  study.comparison_tolerance = 0.1;
  for (std::size_t k = 0; k < kTileMaterials + 10; ++k) {
    study.materials.emplace_back(
        parse_material("lambert:scale=" + std::to_string(0.1 + 0.001 * static_cast<double>(k))));
  }
  return study;
}

TEST(StudyTiles, AreUnitsAndMakeUpTheWhole) {
  std::map<std::string, std::string> records;
  UnitStore store{.has = [&](const std::string& name) { return records.contains(name); },
                  .get = [&](const std::string& name) { return records.at(name); },
                  .is_worth_keeping = [](const std::string& name, double) { return name.starts_with("tile "); },
                  .keep = [&](const std::string& name, const std::string& text) { records[name] = text; }};
  const Study study = wide_study();
  StudyComputation apart(device(), study, store, {});
  const auto units = apart.units();
  std::vector<std::size_t> tiles;
  for (std::size_t u = 0; u < units.size(); ++u) {
    if (units[u].kind == StudyUnit::Kind::tile) tiles.push_back(u);
    EXPECT_NE(units[u].kind, StudyUnit::Kind::comparison) << u;
  }
  ASSERT_EQ(tiles.size(), 6U);
  EXPECT_EQ(units[tiles[1]].name, "tile 2 of comparison bieron-l2");
  EXPECT_GT(units[tiles[1]].cost, units[tiles[0]].cost);      // a rectangle has twice the pairs of a triangle
  EXPECT_GT(units[tiles[4]].cost, 3 * units[tiles[1]].cost);  // cube-root-log has kinks
  apart.compute(units, [&]() -> std::optional<std::size_t> {
    if (tiles.empty()) return {};
    const std::size_t last = tiles.back();
    tiles.pop_back();
    return last;
  });
  EXPECT_EQ(records.size(), 6U);

  StudyComputation whole(device(), study, UnitStore::none(), {});
  const LiteratureResult expected = whole.comparison(1);
  bool is_computing = false;
  StudyComputation merged(device(), study, store, [&](std::string_view, double share) {
    is_computing = is_computing || (share > 0 && share < 1);
    return true;
  });
  const LiteratureResult found = merged.comparison(1);
  EXPECT_FALSE(is_computing);
  EXPECT_EQ(found.combined.distance, expected.combined.distance);
  EXPECT_EQ(found.combined.distance_error, expected.combined.distance_error);
  records.begin()->second.pop_back();
  EXPECT_THROW(static_cast<void>(merged.comparison(0)), IoError);
}

TEST(StudyTiles, AreKeptOneByOneByAPlainRun) {
  std::map<std::string, std::string> records;
  std::size_t computed = 0;
  UnitStore store{.has = [&](const std::string& name) { return records.contains(name); },
                  .get = [&](const std::string& name) { return records.at(name); },
                  .is_worth_keeping = [](const std::string&, double) { return true; },
                  .keep =
                      [&](const std::string& name, const std::string& text) {
                        records[name] = text;
                        ++computed;
                      }};
  const Study study = wide_study();
  const auto cancelled_after_two = [&](std::string_view, double) { return computed < 2; };
  StudyComputation interrupted(device(), study, store, cancelled_after_two);
  EXPECT_THROW(static_cast<void>(interrupted.comparison(0)), Cancelled);
  EXPECT_EQ(computed, 2U);
  StudyComputation resumed(device(), study, store, {});
  const LiteratureResult found = resumed.comparison(0);
  EXPECT_EQ(computed, 4U);  // the third tile, and the whole
  StudyComputation whole(device(), study, UnitStore::none(), {});
  EXPECT_EQ(found.combined.distance_error, whole.comparison(0).combined.distance_error);
}

// Docs and dry runs state what travels.
TEST(StudyTiles, HaveTheBytesThatAPlanExpects) {
  const Study study = wide_study();
  Study without = study;
  without.comparison_metrics.clear();
  const StudyPlan plan;
  const auto all_bytes = [&](const Study& one) { return plan_ranks(device(), one, plan, 2).all_bytes; };
  std::size_t bytes = 0;
  for (const ComparisonTile& tile : comparison_tiles(study.materials.size())) {
    const std::size_t own = tile.is_triangle() ? 1 : 0;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(tile.rows.size() + own),
                                                   static_cast<Eigen::Index>(tile.columns.size() + own));
    if (!tile.is_triangle()) matrix(0, 1) = 1;  // not symmetric, as those of two ranges are
    bytes += written_unit(TileIntegrals{.channels = {{matrix, matrix}}, .nodes = 0, .evaluations = 0}).size();
  }
  const std::size_t expected = all_bytes(study) - all_bytes(without);
  EXPECT_NEAR(static_cast<double>(expected), 2.0 * static_cast<double>(bytes), 0.02 * static_cast<double>(bytes));
}

}  // namespace
}  // namespace lobe::test
