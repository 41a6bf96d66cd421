#include "plot/dendrogram_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/text.hpp"
#include "study/write/drawn_materials.hpp"
#include "synthetic_study.hpp"

namespace lobe::test {
namespace {

gnuplot::Picture picture_of(const StudyResult& result) {
  return dendrogram_picture("stem", "Title", "", drawn_materials(result.study), result.metrics[0].combined.distance,
                            result.clusterings[0]);
}

/// Lines of a text that begin so.
std::size_t lines_with(const std::string& text, std::string_view start) {
  const auto lines = split(text, '\n');
  return static_cast<std::size_t>(std::ranges::count_if(lines, [&](auto line) { return line.starts_with(start); }));
}

TEST(DendrogramPicture, NamesEveryMaterialWhereThereIsRoom) {
  const StudyResult result = synthetic_study();
  const std::string script = picture_of(result).script;
  for (const auto& material : result.study.materials) {
    EXPECT_NE(script.find(gnuplot::string_literal(material.name())), std::string::npos) << material.name();
  }
}

TEST(DendrogramPicture, NamesTheMedoidsInBoldAmongSomeOfMany) {
  const StudyResult result = synthetic_study(120);
  const std::string script = picture_of(result).script;
  for (const auto medoid : result.clusterings[0].medoids.medoid) {
    const std::string name = gnuplot::string_literal(result.study.materials[medoid].name());
    const std::size_t at = script.find("set label " + name);
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_NE(script.substr(at, script.find('\n', at) - at).find("DejaVu Sans Bold"), std::string::npos) << name;
  }
  // A line of 13 pixels with its gap for each, on 4 * 240 pixels; and the title, two notes and two families.
  EXPECT_LE(lines_with(script, "set label"), static_cast<std::size_t>(4 * 240 / (1.35 * 13)) + 1 + 5);
}

TEST(DendrogramPicture, HasTheMatrixInTheOrderOfTheLeaves) {
  const StudyResult result = synthetic_study();
  const std::string data = picture_of(result).data;
  for (std::size_t place = 0; place < result.study.materials.size(); ++place) {
    const std::string& name = result.study.materials[result.clusterings[0].leaf_order[place]].name();
    EXPECT_NE(data.find("# " + std::to_string(place) + ": " + name + "\n"), std::string::npos) << place;
  }
}

TEST(DendrogramPicture, DrawsThreeLinesPerMerge) {
  const std::string data = picture_of(synthetic_study()).data;
  const std::string tree = data.substr(data.find("# tree"));
  EXPECT_EQ(lines_with(tree, "# tree"), 1U);
  // Two ends each; five merges.
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(tree, 'x')), 5U * 3 * 2);
}

}  // namespace
}  // namespace lobe::test
