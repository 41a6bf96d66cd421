#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/process.hpp"
#include "interface/exit_code.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

/// Runs commands in a directory of the test's own.
class CommandTest : public ::testing::Test {
 protected:
  [[nodiscard]] Outcome run(const Words& words, Surroundings surroundings = {}) const {
    surroundings.directory = directory_.path();
    return run_lobe(words, surroundings);
  }
  /// Runs what has to succeed.
  Outcome make(const Words& words) const {
    auto outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return outcome;
  }
  [[nodiscard]] Json json(Words words) const {
    words.emplace_back("--json");
    return Json::parse(make(words).output);
  }
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return directory_.path() / name; }
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory_.path())) {
      names.push_back(entry.path().filename());
    }
    return names;
  }
  /// Nothing on standard output, one line of error.
  void expect_refusal(const Words& words, cli::ExitCode code, const std::string& message) const {
    const auto outcome = run(words);
    EXPECT_EQ(outcome.status, static_cast<int>(code)) << outcome.error;
    EXPECT_THAT(outcome.output, ::testing::IsEmpty());
    EXPECT_THAT(outcome.error, ::testing::StartsWith("lobe: error: "));
    EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
    EXPECT_THAT(outcome.error, ::testing::HasSubstr(message));
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace lobe::test
