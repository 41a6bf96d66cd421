#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"

namespace lobe::test {

/// Geometries in general position: light and viewer change places in steepness, on both sides of the plane of
/// incidence.
inline std::vector<Directions> twenty_geometries() {
  std::vector<Directions> pairs;
  for (int i = 0; i < 20; ++i) pairs.push_back({0.02 + 0.071 * i, 1.45 - 0.069 * i, 0.31 * i - 3, 0.7 * i - 5});
  return pairs;
}

/// The bytes of numbers as they lie in memory.
template <typename Number>
void append_bytes(std::string& bytes, const std::vector<Number>& numbers) {
  static_assert(std::is_arithmetic_v<Number>);
  const std::size_t before = bytes.size();
  bytes.resize(before + numbers.size() * sizeof(Number));
  std::memcpy(bytes.data() + before, numbers.data(), numbers.size() * sizeof(Number));
}

/// Numbers put over a part of a content.
template <typename Number>
[[nodiscard]] std::string with_number(std::string bytes, std::size_t offset, Number number) {
  std::memcpy(bytes.data() + offset, &number, sizeof(Number));  // callers stay within
  return bytes;
}

inline void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

[[nodiscard]] inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// One line that says what is wrong.
inline void expect_complaint(const std::function<void()>& call, const std::string& complaint) {
  try {
    call();
    FAIL() << "not refused; expected '" << complaint << "'";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(complaint));
    EXPECT_THAT(error.what(), ::testing::Not(::testing::HasSubstr("\n")));
  }
}

inline void expect_unreadable(const std::filesystem::path& path, const std::string& bytes,
                              const std::string& complaint) {
  write_file(path, bytes);
  expect_complaint([&] { (void)load_measured(path); }, complaint);
}

}  // namespace lobe::test
