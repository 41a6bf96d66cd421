#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/process.hpp"

namespace lobe::test {

/// Texts by the names of files, relative to a folder.
using Files = std::map<std::string, std::string>;

/// A command that a net runs again and again, each time in a folder of its own.
struct Job {
  std::string name;
  std::vector<std::string> words;  ///< the program and its arguments
  Files inputs = {};               ///< what lies in the folder before
};

/// How a job ended.
struct Ending {
  Outcome outcome;
  Files files;                      ///< in its folder afterwards
  std::vector<std::string> events;  ///< lines of the log
  bool was_repeated = false;        ///< it left a journal of what is to be moved: files are those after doing it again
};

using Environment = std::vector<std::pair<std::string, std::string>>;

/// Runs a job with a library preloaded, which `environment` tells what to do and whose log is the file that the
/// variable `log` names. Temporary files go elsewhere.
[[nodiscard]] Ending run_job(const Job& job, const std::filesystem::path& library, const std::string& log,
                             Environment environment = {});

/// Which of many calls are disturbed.
enum class Calls { ends, inside };

/// Numbers from 1 to `count`: the first and the last, or the second and the one in the middle; where the variable
/// LOBE_NETS is a number, as many of all as that, evenly spread, with these four.
[[nodiscard]] std::vector<long> chosen_calls(long count, Calls calls);

/// "NAME left out" and the like for files that are not as they should be; `expected` without those that
/// `may_be_missing`.
[[nodiscard]] std::string difference(const Files& found, const Files& expected);

/// Empty where a refusal is one line "lobe: error: what; advice".
[[nodiscard]] std::string fault_of_refusal(const Outcome& outcome);

}  // namespace lobe::test
