// The printed numbers of studies/published-tables.toml against numbers computed apart from this library
// (tests/golden/README.md), and the page of the documentation that they make.
#include "lobe/study/published.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/files.hpp"
#include "lobe/study/study.hpp"
#include "study/write/published_text.hpp"
#include "support/device.hpp"
#include "support/oracle.hpp"

namespace lobe::test {
namespace {

const StudyResult& result() {
  static const StudyResult computed = run_study(device(), load_study(LOBE_STUDIES_DIR "/published-tables.toml"));
  return computed;
}

/// Places of the figures that a record of the oracle is about.
std::vector<std::size_t> figures_of(PublishedQuantity quantity, const OracleRecord& record) {
  const Term term = parse_material(record.materials.at(0)).terms.at(0);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < result().published.size(); ++i) {
    const PublishedFigure& figure = result().study.published[i];
    const Term& other = figure.material.terms.at(0);
    if (figure.quantity == quantity && other.model == term.model && other.values == term.values) found.push_back(i);
  }
  return found;
}

const std::map<std::string, PublishedQuantity>& quantities() {
  static const std::map<std::string, PublishedQuantity> names{{"C_max", PublishedQuantity::constant},
                                                              {"mean_albedo", PublishedQuantity::mean_albedo}};
  return names;
}

TEST(PublishedTables, AreAsExpected) {
  ASSERT_EQ(result().published.size(), result().study.published.size());
  for (std::size_t i = 0; i < result().published.size(); ++i) {
    const PublishedFigure& figure = result().study.published[i];
    EXPECT_TRUE(result().published[i].is_as_expected) << figure.table << ", " << figure.label;
  }
}

TEST(PublishedTables, AgreeWithTheOracle) {
  constexpr double kPublishedTolerance = 1e-6;
  std::size_t compared = 0;
  for (const auto& [name, quantity] : quantities()) {
    for (const auto& record : oracle_records(name)) {
      for (const auto i : figures_of(quantity, record)) {
        const Estimate& value = result().published[i].value;
        const double expected = record.values.at(0);
        EXPECT_NEAR(value.value, expected, kPublishedTolerance * expected + record.uncertainty) << record.name;
        EXPECT_LE(std::abs(value.value - expected), value.error + record.uncertainty + 1e-15) << record.name;
        ++compared;
      }
    }
  }
  EXPECT_GE(compared, 75U);
}

TEST(PublishedTables, ArePrintedSo) {
  for (const auto& [name, quantity] : quantities()) {
    for (const auto& record : oracle_records(name)) {
      if (record.printed.empty()) continue;
      for (const auto i : figures_of(quantity, record)) {
        EXPECT_EQ(result().study.published[i].printed, record.printed) << record.name;
      }
    }
  }
}

TEST(PublishedTables, MakeThePageOfTheDocumentation) {
  EXPECT_EQ(published_page(result()), read_text(LOBE_DOCS_DIR "/published-tables.md"))
      << "write it anew: lobe run studies/published-tables.toml -o out; "
         "cp out/published-tables.published.md docs/published-tables.md";
}

}  // namespace
}  // namespace lobe::test
