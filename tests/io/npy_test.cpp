// Arrays of NumPy: against bytes that numpy.save writes, and damaged.
#include "formats/npy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/measured_files.hpp"
#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// An .npy by hand: the layout of numpy.lib.format, whose header ends at a multiple of 64.
std::string npy(const std::string& dictionary, const std::string& numbers, int version = 1) {
  std::string content = "\x93NUMPY";
  content += {static_cast<char>(version), '\0'};
  const std::size_t before = version == 1 ? 10 : 12;
  std::string header = dictionary;
  while ((before + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  if (version == 1)
    append_bytes<std::uint16_t>(content, {static_cast<std::uint16_t>(header.size())});
  else
    append_bytes<std::uint32_t>(content, {static_cast<std::uint32_t>(header.size())});
  return content + header + numbers;
}

std::string dictionary(const std::string& descr, const std::string& order, const std::string& shape) {
  return "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
}

template <typename Number>
std::string bytes(const std::vector<Number>& numbers) {
  std::string content;
  append_bytes(content, numbers);
  return content;
}

NpyArray read(const std::string& content) {
  return read_npy(FileBytes::copy("a.npy", content));
}

void expect_refusal(const std::string& content, const std::string& complaint) {
  expect_complaint([&] { (void)read(content); }, complaint);
  expect_complaint([&] { (void)read(content); }, "cannot read a.npy: byte ");
}

TEST(Npy, OfAllTypesAreRead) {
  const auto values = [](const std::string& descr, const std::string& numbers) {
    const NpyArray array = read(npy(dictionary(descr, "False", "(3,)"), numbers));
    EXPECT_THAT(array.shape, ElementsAre(3U)) << descr;
    return array.values;
  };
  EXPECT_THAT(values("<f8", bytes<double>({0.1, -2, 1e300})), ElementsAre(0.1, -2, 1e300));
  EXPECT_THAT(values("<f4", bytes<float>({0.5F, -2, 3})), ElementsAre(0.5, -2, 3));
  EXPECT_THAT(values("<i8", bytes<std::int64_t>({-1, 0, 1LL << 40})), ElementsAre(-1, 0, std::exp2(40)));
  EXPECT_THAT(values("<i4", bytes<std::int32_t>({-1, 0, 7})), ElementsAre(-1, 0, 7));
  EXPECT_THAT(values("<u2", bytes<std::uint16_t>({0, 1, 65535})), ElementsAre(0, 1, 65535));
  EXPECT_THAT(values("|u1", bytes<std::uint8_t>({0, 1, 255})), ElementsAre(0, 1, 255));
  EXPECT_THAT(values("|i1", bytes<std::int8_t>({0, 1, -1})), ElementsAre(0, 1, -1));
}

TEST(Npy, OfBothOrdersAreTheSameArray) {
  // a[i][j][k] = 100 i + 10 j + k, of shape 2 x 3 x 2.
  std::vector<double> rows;
  std::vector<double> columns;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 2; ++k) rows.push_back(100 * i + 10 * j + k);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 2; ++i) columns.push_back(100 * i + 10 * j + k);
  EXPECT_EQ(read(npy(dictionary("<f8", "False", "(2, 3, 2)"), bytes(rows))).values, rows);
  EXPECT_EQ(read(npy(dictionary("<f8", "True", "(2, 3, 2)"), bytes(columns))).values, rows);
}

TEST(Npy, OfAllVersionsAreRead) {
  for (const int version : {1, 2, 3}) {
    SCOPED_TRACE(version);
    EXPECT_THAT(read(npy(dictionary("<f8", "False", "(1, 1)"), bytes<double>({4}), version)).values, ElementsAre(4));
  }
  // A single number, no number, keys in another order and other quotes.
  EXPECT_THAT(read(npy(dictionary("<f8", "False", "()"), bytes<double>({4}))).values, ElementsAre(4));
  EXPECT_THAT(read(npy(dictionary("<f8", "False", "(3, 0)"), "")).shape, ElementsAre(3U, 0U));
  const auto other = read(npy(R"({"shape":(2,),"fortran_order":True,"descr":"<f8"})", bytes<double>({4, 5})));
  EXPECT_THAT(other.values, ElementsAre(4, 5));
}

TEST(Npy, ThatAreWrittenAreReadBackToTheLastBit) {
  const std::vector<double> values{0.1, std::nextafter(1.0, 2.0), -0.0, 5e-324, 1e308, 3};
  const std::vector<std::size_t> shape{3, 2};
  const std::string content = npy_content(shape, values);
  EXPECT_EQ(content, npy("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }", bytes(values)));
  const NpyArray back = read(content);
  EXPECT_EQ(back.shape, shape);
  EXPECT_EQ(back.values, values);
  EXPECT_THAT(read(npy_content(std::vector<std::size_t>{6}, values)).shape, ElementsAre(6U));
  EXPECT_THROW((void)npy_content(std::vector<std::size_t>{7}, values), ArgumentError);
}

TEST(Npy, ThatAreDamagedAreRefused) {
  const std::string one = bytes<double>({1});
  expect_refusal("", "the file ends within the mark of an array of NumPy");
  expect_refusal("PK\3\4 and so on", "it is no array of NumPy");
  expect_refusal(npy(dictionary("<f8", "False", "(1,)"), one, 4), "version 4.0 of .npy; expected 1.0, 2.0 or 3.0");
  expect_refusal(npy(dictionary("<f8", "False", "(1,)"), one).substr(0, 40), "the file ends within the header");
  expect_refusal(npy(dictionary(">f8", "False", "(1,)"), one), "numbers of type '>f8'; expected '<f8', '<f4' or ");
  expect_refusal(npy(dictionary("<c16", "False", "(1,)"), one), "numbers of type '<c16'");
  expect_refusal(npy(dictionary("|O", "False", "(1,)"), one), "numbers of type '|O'");
  expect_refusal(npy(dictionary("<f2", "False", "(4,)"), one), "numbers of type '<f2'");
  expect_refusal(npy("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (1,), }", one), "a structured array");
  expect_refusal(npy(dictionary("<f8", "False", "(2,)"), one), "the shape 2 asks for more than the 1 numbers");
  expect_refusal(npy(dictionary("<f8", "False", "(1,)"), one + "x"), "goes on after the last number");
  expect_refusal(npy(dictionary("<f8", "False", "(0,)"), one), "goes on after the last number");
  expect_refusal(npy(dictionary("<f8", "False", "(4294967296, 4294967296)"), one), "asks for more than the 1 numbers");
  expect_refusal(npy(dictionary("<f8", "False", "(99999999999999999999,)"), one), "shape is no tuple of lengths");
  expect_refusal(npy(dictionary("<f8", "False", "(-1,)"), one), "shape is no tuple of lengths");
  expect_refusal(npy(dictionary("<f8", "False", "(1)"), one), "a comma is missing");
  expect_refusal(npy(dictionary("<f8", "Maybe", "(1,)"), one), "neither True nor False");
  expect_refusal(npy("{'descr': '<f8', 'shape': (1,), }", one), "descr, fortran_order or shape is missing");
  expect_refusal(npy("{'shape': (1,), 'shape': (1,)}", one), "a second shape");
  expect_refusal(npy("{'pickle': '<f8'}", one), "unknown key 'pickle'");
  expect_refusal(npy("{'descr': '<f8", one), "a quote that does not end");
  expect_refusal(npy("{} + x", one), "something after the dictionary");
}

TEST(Npy, OfTextsAreReadAndOthersRefused) {
  const auto texts = [](const std::string& descr, std::size_t width) {
    std::string letters = bytes<std::uint32_t>({'a', 'b', 0, 'c'});
    letters.resize(2 * width, '\0');
    return read_npy_texts(FileBytes::copy("a.npy", npy(dictionary(descr, "False", "(2,)"), letters)));
  };
  EXPECT_THAT(texts("<U2", 8), ElementsAre("ab", ""));
  EXPECT_THAT(texts("<U3", 12), ElementsAre("ab", "c"));
  for (const std::string descr : {"|S2", ">U2", "<U2x", "<U", "<U0", "<U1001"}) {
    expect_complaint([&] { (void)texts(descr, 8); }, "elements of type '" + descr + "'; expected texts ('<U...')");
  }
}

}  // namespace
}  // namespace lobe::test
