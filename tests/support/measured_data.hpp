#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace lobe::test {

/// A file or folder below LOBE_DATA_DIR; empty where it is not there, for a test to be skipped, which is a failure
/// where LOBE_REQUIRE_DATA is set.
inline std::filesystem::path measured_data(const std::filesystem::path& below) {
  const char* data = std::getenv("LOBE_DATA_DIR");
  if (data != nullptr && std::filesystem::exists(data / below)) return data / below;
  if (std::getenv("LOBE_REQUIRE_DATA") != nullptr) {
    ADD_FAILURE() << below << " is not below LOBE_DATA_DIR, and LOBE_REQUIRE_DATA is set";
  }
  return {};
}

inline constexpr const char* kNoData = "the measured data is not there; set LOBE_DATA_DIR";

/// Tests of files in a folder below LOBE_DATA_DIR; skipped where it is not there.
class MeasuredData : public ::testing::Test {
 protected:
  explicit MeasuredData(std::string folder) : folder_(std::move(folder)) {}

  void SetUp() override {
    data_ = measured_data(folder_);
    if (data_.empty()) GTEST_SKIP() << kNoData;
  }

  std::filesystem::path data_;  ///< the folder

 private:
  std::string folder_;
};

/// The numbers that lines begin with, apart by blanks or commas; lines without are left out, '#' begins a comment.
inline std::vector<std::vector<double>> number_rows(const std::filesystem::path& path) {
  std::vector<std::vector<double>> rows;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    line.resize(std::min(line.find('#'), line.size()));
    std::ranges::replace(line, ',', ' ');
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0; words >> value;) row.push_back(value);
    if (!row.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace lobe::test
