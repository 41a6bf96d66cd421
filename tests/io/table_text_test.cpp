#include "plot/table_text.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "core/text.hpp"

namespace lobe::test {
namespace {

/// Reads a table as RFC 4180 says.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_quoted) {
      if (text[i] != '"') {
        row.back() += text[i];
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        row.back() += text[i++];
      } else {
        is_quoted = false;
      }
    } else if (text[i] == '"') {
      is_quoted = true;
    } else if (text[i] == ',') {
      row.emplace_back();
    } else if (text[i] == '\n') {
      rows.push_back(row);
      row.assign(1, "");
    } else {
      row.back() += text[i];
    }
  }
  return rows;
}

TEST(CsvField, StaysAsItIsWithoutSpecialCharacters) {
  EXPECT_EQ(csv_field("Phong n=2"), "Phong n=2");
}

TEST(CsvField, IsQuotedWithACommaAQuoteOrALineBreak) {
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"a\""), "\"say \"\"a\"\"\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
}

TEST(CsvMatrix, HasLabelsInTheFirstRowAndColumn) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << 0, 1.5, 1.5, 0;
  const std::vector<std::string> labels = {"one", "two, more"};
  EXPECT_EQ(csv_matrix("material", labels, matrix), "material,one,\"two, more\"\none,0,1.5\n\"two, more\",1.5,0\n");
}

TEST(CsvMatrix, ReadsBackBitForBit) {
  Eigen::MatrixXd matrix(3, 3);
  matrix << 0, 1.0 / 3, 1e-300, 0.1, -0.0, 2049.186361, 5e-324, 1.7976931348623157e308, 1e22;
  const std::vector<std::string> labels = {"a", "b \"c\"", "d\ne"};
  const auto rows = parse_csv(csv_matrix("material", labels, matrix));
  ASSERT_EQ(rows.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(rows[0][i + 1], labels[i]);
    EXPECT_EQ(rows[i + 1][0], labels[i]);
    for (std::size_t j = 0; j < 3; ++j) {
      SCOPED_TRACE(j);
      EXPECT_EQ(std::strtod(rows[i + 1][j + 1].c_str(), nullptr),
                matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    }
  }
}

}  // namespace
}  // namespace lobe::test
