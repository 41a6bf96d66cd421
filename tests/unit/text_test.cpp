#include "core/text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "support/names.hpp"

namespace lobe::test {
namespace {

constexpr std::array<std::string_view, 4> kWords{"lambert", "metal_phong", "phong", "ward"};

struct Spelling {
  std::string name;
  std::string word;
  std::string nearest;
};
std::ostream& operator<<(std::ostream& out, const Spelling& spelling) {
  return out << spelling.name;
}

class NearestWord : public ::testing::TestWithParam<Spelling> {};

TEST_P(NearestWord, FindsTypingMistakesOnly) {
  EXPECT_EQ(nearest_word(GetParam().word, kWords), GetParam().nearest);
}

INSTANTIATE_TEST_SUITE_P(text, NearestWord,
                         ::testing::Values(Spelling{"exact", "ward", "ward"}, Spelling{"letter_missing", "wrd", "ward"},
                                           Spelling{"letters_swapped", "lambret", "lambert"},
                                           Spelling{"letter_too_many", "phongg", "phong"},
                                           Spelling{"prefix", "metal", "metal_phong"},
                                           Spelling{"far_away", "glossy_car_paint", ""}, Spelling{"empty", "", ""}),
                         ByName{});

TEST(DidYouMean, SuggestsTheNearWord) {
  EXPECT_EQ(did_you_mean("wrad", kWords), "; did you mean 'ward'?");
}

TEST(DidYouMean, ListsAllWordsWhenNoneIsNear) {
  EXPECT_EQ(did_you_mean("glossy_car_paint", kWords), "; known: lambert, metal_phong, phong, ward");
}

struct NumberText {
  std::string name;
  std::string text;
  bool is_number;
  double value;
};
std::ostream& operator<<(std::ostream& out, const NumberText& number) {
  return out << number.name;
}

class ParseNumber : public ::testing::TestWithParam<NumberText> {};

TEST_P(ParseNumber, TakesWholeFiniteNumbersOnly) {
  double value = 0;

  const bool is_number = parse_number(GetParam().text, value);

  EXPECT_EQ(is_number, GetParam().is_number);
  EXPECT_EQ(is_number ? value : 0, GetParam().value);
}

INSTANTIATE_TEST_SUITE_P(
    text, ParseNumber,
    ::testing::Values(NumberText{"integer", "20", true, 20}, NumberText{"fraction", "0.00781", true, 0.00781},
                      NumberText{"negative", "-1.5", true, -1.5}, NumberText{"plus_sign", "+3", true, 3},
                      NumberText{"exponent", "1e+5", true, 1e5}, NumberText{"empty", "", false, 0},
                      NumberText{"plus_alone", "+", false, 0}, NumberText{"two_signs", "+-3", false, 0},
                      NumberText{"trailing_letter", "20x", false, 0}, NumberText{"leading_blank", " 20", false, 0},
                      NumberText{"comma", "0,5", false, 0}, NumberText{"infinity", "inf", false, 0},
                      NumberText{"not_a_number", "nan", false, 0}, NumberText{"overflow", "1e999", false, 0}),
    ByName{});

class Shortest : public ::testing::TestWithParam<double> {};

TEST_P(Shortest, ReadsBackAsTheSameNumber) {
  double value = 0;

  ASSERT_TRUE(parse_number(shortest(GetParam()), value));

  EXPECT_EQ(value, GetParam());
}

INSTANTIATE_TEST_SUITE_P(text, Shortest,
                         ::testing::Values(0.0, 0.1, 1.0 / 3, 2049.186361, -1e-300, 1e300,
                                           std::numeric_limits<double>::denorm_min()));

TEST(ShortestText, HasNoSuperfluousDigits) {
  EXPECT_EQ(shortest(0.1), "0.1");
}

TEST(Split, KeepsEmptyParts) {
  EXPECT_EQ(split("a,,b,", ','), (std::vector<std::string_view>{"a", "", "b", ""}));
}

TEST(Split, GivesOnePartForAnEmptyText) {
  EXPECT_EQ(split("", ','), (std::vector<std::string_view>{""}));
}

TEST(Trim, RemovesBlanksAtBothEnds) {
  EXPECT_EQ(trim(" \t ward : m \r\n"), "ward : m");
}

TEST(Trim, LeavesNothingOfBlanks) {
  EXPECT_EQ(trim(" \n\t "), "");
}

TEST(ControlCharacters, AreThoseThatTerminalsObey) {
  for (const std::string text : {"\n", "a\tb", "\x1b[2J", "\x7f", "\xc2\x9b", "\xc2\x80", "\x9b", "a\x85", "√\r"}) {
    EXPECT_TRUE(has_control_characters(text)) << printable(text);
  }
  EXPECT_TRUE(has_control_characters(std::string(1, '\0')));
  // Letters whose bytes are such, and bytes that are no UTF-8.
  for (const std::string text : {"", "plain", "Größe √sr⁻¹ 反射 😀", "\xff", "\xe9", "\xc3", "\u00a0", "\xc3\x9b"}) {
    EXPECT_FALSE(has_control_characters(text)) << text;
  }
}

TEST(Printable, ShowsControlCharactersByTheirNumbers) {
  EXPECT_EQ(printable("a\nb\x1b[2J\x7f√"), "a\\x0ab\\x1b[2J\\x7f√");
  EXPECT_EQ(printable("\xc2\x9b|\x9b|\xe2\x9b"), "\\x9b|\\x9b|\xe2\\x9b");
  EXPECT_EQ(printable(std::string(1, '\0')), "\\x00");
  EXPECT_EQ(printable("\\n stays"), "\\n stays");
}

TEST(Excerpt, IsTheBeginningOfALongTextInWholeCharacters) {
  EXPECT_EQ(excerpt("short\n"), "short\\x0a");
  EXPECT_EQ(excerpt(std::string(40, 'a')), std::string(40, 'a'));
  EXPECT_EQ(excerpt(std::string(41, 'a')), std::string(40, 'a') + "...");
  EXPECT_EQ(excerpt(std::string(39, 'a') + "\xc3\xa4" + "b"), std::string(39, 'a') + "...");
  EXPECT_EQ(excerpt(std::string(41, '\x80')).substr(0, 4), "\\x80");
}

}  // namespace
}  // namespace lobe::test
