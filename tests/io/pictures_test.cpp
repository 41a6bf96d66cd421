#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "plot/families.hpp"
#include "plot/gnuplot.hpp"
#include "plot/label_placement.hpp"
#include "study/write/drawn_materials.hpp"
#include "synthetic_study.hpp"

namespace lobe::test {
namespace {

DrawnMaterial named(const std::string& name, const std::string& family) {
  return {{name, family}, make_material("lambert").terms};
}

TEST(OrderByFamily, PutsMaterialsOfAFamilyTogether) {
  const std::vector<DrawnMaterial> materials = {named("A 1", "A"), named("B 1", "B"), named("A 2", "A")};
  const FamilyOrder order = order_by_family(materials);
  EXPECT_EQ(order.material, (std::vector<std::size_t>{0, 2, 1}));
  ASSERT_EQ(order.blocks.size(), 2U);
  EXPECT_EQ(order.blocks[0].name, "A");
  EXPECT_EQ(order.blocks[0].end, 2U);
}

TEST(OrderByFamily, ShortensLabelsByTheFamilyInFront) {
  const std::vector<DrawnMaterial> materials = {named("A 1", "A"), named("A", "A"), named("AB 1", "A"),
                                                named("x A", "A")};
  EXPECT_EQ(order_by_family(materials).label, (std::vector<std::string>{"1", "A", "AB 1", "x A"}));
}

TEST(OrderByFamily, KnowsASweepOfOneParameter) {
  const FamilyOrder order = order_by_family(drawn_materials(synthetic_study().study));
  ASSERT_EQ(order.blocks.size(), 2U);
  EXPECT_TRUE(order.blocks[0].is_sweep);
}

TEST(OrderByFamily, TakesOneMaterialForNoSweep) {
  EXPECT_FALSE(order_by_family(drawn_materials(synthetic_study(1).study)).blocks[0].is_sweep);
}

TEST(StringLiteral, HasNumbersForWhatIsNoPlainCharacter) {
  EXPECT_EQ(gnuplot::string_literal("it's\n$(x) `y`"), R"("it\047s\012\044(x) \140y\140")");
}

TEST(CharacterCount, CountsCharactersNotBytes) {
  EXPECT_EQ(gnuplot::character_count("√sr"), 3U);
}

TEST(PlaceLabels, PutsALonelyLabelToTheRight) {
  const std::vector<PixelPoint> points = {{50, 50}};
  const std::vector<std::string> texts = {"a"};
  const auto places = place_labels(points, texts, {}, 10, {0, 0, 100, 100});
  ASSERT_TRUE(places[0]);
  EXPECT_GT(places[0]->x, 50);
  EXPECT_EQ(places[0]->y, 50);
}

TEST(PlaceLabels, TurnsToTheLeftAtTheRightEdge) {
  const std::vector<PixelPoint> points = {{95, 50}};
  const std::vector<std::string> texts = {"abc"};
  const auto places = place_labels(points, texts, {}, 10, {0, 0, 100, 100});
  ASSERT_TRUE(places[0]);
  EXPECT_LT(places[0]->x, 80);
}

TEST(PlaceLabels, LeavesOutWhatWouldCoverSomethingElse) {
  const std::vector<PixelPoint> points(40, {50, 50});
  const std::vector<std::string> texts(40, "label");
  const auto places = place_labels(points, texts, {}, 10, {0, 0, 100, 100});
  EXPECT_TRUE(places[0]);
  EXPECT_FALSE(places[39]);
}

TEST(PlaceLabels, KeepsOffLines) {
  const std::vector<PixelPoint> points = {{50, 50}};
  const std::vector<std::string> texts = {"a"};
  const std::vector<PixelPoint> line = {{60, 50}};
  const auto places = place_labels(points, texts, line, 10, {0, 0, 100, 100});
  ASSERT_TRUE(places[0]);
  EXPECT_LT(places[0]->x, 50);
}

TEST(PlacesKeptApart, AreTheWantedOnesWhereThereIsRoomAndElseShareTheShift) {
  const std::vector<double> wanted{0, 4, 5, 6, 20};

  const auto places = keep_apart(wanted, 3);

  // The first four stand together about the middle of what they want.
  const std::vector<double> expected{-0.75, 2.25, 5.25, 8.25, 20};
  ASSERT_EQ(places.size(), expected.size());
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(places[i], expected[i], 1e-12) << i;
}

}  // namespace
}  // namespace lobe::test
