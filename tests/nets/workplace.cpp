#include "nets/workplace.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

Files files_in(const fs::path& directory) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(directory)) {
    const std::string name = fs::relative(entry.path(), directory).string();
    if (entry.is_regular_file()) files[name] = content_of(entry.path());
    // Folders that are seen may be left behind, empty.
    if (entry.is_directory() && entry.path().filename().string().starts_with('.')) files[name] = "a folder";
  }
  return files;
}

}  // namespace

Ending run_job(const Job& job, const fs::path& library, const std::string& log, Environment environment) {
  const TemporaryDirectory directory;
  const fs::path place = directory.path() / "place";
  const fs::path other = directory.path() / "other";
  fs::create_directories(place);
  fs::create_directories(other);
  for (const auto& [name, text] : job.inputs) {
    fs::create_directories((place / name).parent_path());
    std::ofstream(place / name, std::ios::binary) << text;
  }
  const char* preloaded = std::getenv("LD_PRELOAD");
  environment.emplace_back("LD_PRELOAD", preloaded == nullptr ? library.string() : library.string() + ":" + preloaded);
  environment.emplace_back("TMPDIR", other.string());
  environment.emplace_back(log, (other / "events").string());
  environment.emplace_back("LOBE_IO_BELOW", place.string());
  environment.emplace_back("SOURCE_DATE_EPOCH", "0");  // the same files in every run
  // The runtime of the address sanitizer else insists on being the first library.
  const char* asan = std::getenv("ASAN_OPTIONS");
  environment.emplace_back("ASAN_OPTIONS", std::string(asan == nullptr ? "" : asan) + ":verify_asan_link_order=0");
  Ending ending{run_program(job.words, {.directory = place, .environment = environment}), files_in(place), {}};
  for (const auto& [name, content] : ending.files)
    ending.was_repeated = ending.was_repeated || name.ends_with("/journal");
  if (ending.was_repeated) {
    std::erase_if(environment, [](const auto& one) { return one.first.ends_with("_FAIL"); });
    const Outcome again = run_program(job.words, {.directory = place, .environment = environment});
    if (again.status != 0) ending.outcome.error += again.error;
    ending.files = files_in(place);
  }
  std::istringstream events(content_of(other / "events"));
  for (std::string line; std::getline(events, line);) ending.events.push_back(line);
  return ending;
}

std::vector<long> chosen_calls(long count, Calls calls) {
  const char* extent = std::getenv("LOBE_NETS");
  const long many = extent == nullptr ? 0 : std::strtol(extent, nullptr, 10);
  std::set<long> chosen;
  if (calls == Calls::ends || many > 0) chosen.insert({1, count});
  if (calls == Calls::inside || many > 0) chosen.insert({2, (count + 1) / 2});
  for (long k = 1; k < many; ++k) chosen.insert(1 + (count - 1) * k / many);
  std::erase_if(chosen, [&](long call) { return call < 1 || call > count; });
  return {chosen.begin(), chosen.end()};
}

std::string difference(const Files& found, const Files& expected) {
  std::string text;
  for (const auto& [name, content] : found) {
    const auto other = expected.find(name);
    if (other == expected.end()) {
      text += " " + name + " is left;";
    } else if (other->second != content) {
      text += " " + name + " has changed;";
    }
  }
  for (const auto& [name, content] : expected) {
    if (!found.contains(name)) text += " " + name + " is missing;";
  }
  return text;
}

std::string fault_of_refusal(const Outcome& outcome) {
  const std::string& error = outcome.error;
  std::string text;
  if (!error.starts_with("lobe: error: ") || std::ranges::count(error, '\n') != 1 || !error.ends_with('\n')) {
    text += " is not refused by one line;";
  }
  if (error.find("; ") == error.npos) text += " nothing says what to do;";
  if (error.find("internal error") != error.npos) text += " is an internal error;";
  if (!outcome.output.empty()) text += " something was printed;";
  return text;
}

}  // namespace lobe::test
