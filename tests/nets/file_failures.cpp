#include "nets/file_failures.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "interface/exit_code.hpp"

namespace lobe::test {
namespace {

Ending run(const Job& job, const std::string& failure = {}) {
  // Not in gnuplot, which writes into a file that is looked at afterwards.
  Environment environment{{"LOBE_IO_PROGRAM", std::filesystem::path(job.words.front()).filename()}};
  if (!failure.empty()) environment.emplace_back("LOBE_IO_FAIL", failure);
  return run_job(job, LOBE_FILE_SHIM, "LOBE_IO_LOG", std::move(environment));
}

/// A call of the undisturbed run.
struct Call {
  std::string name, path;
  long number = 0;  ///< among those of its name
};

std::vector<Call> calls_of(const Ending& ending) {
  std::vector<Call> calls;
  std::map<std::string, long> counts;
  for (const auto& line : ending.events) {
    const std::size_t space = line.find(' ');
    const std::string name = line.substr(0, space);
    calls.push_back({name, line.substr(space + 1), ++counts[name]});
  }
  return calls;
}

/// Without what nobody sees: locks, and what is taken away by the next run.
Files visible(const Files& files) {
  Files rest;
  for (const auto& [name, content] : files) {
    const bool is_hidden = name.starts_with('.') || name.find("/.") != name.npos || name.find(".tmp-") != name.npos;
    if (!is_hidden) rest[name] = content;
  }
  return rest;
}

std::string fault_of_success(const Ending& ending, const Ending& whole) {
  const Outcome& outcome = ending.outcome;
  std::string text;
  if (outcome.status != 0) text += " exit status " + std::to_string(outcome.status) + ": " + outcome.error;
  if (outcome.output != whole.outcome.output) text += " the answer has changed;";
  return text + difference(ending.files, whole.files);
}

std::string fault(const Ending& ending, const Ending& whole, const Job& job, const Call& call) {
  const bool is_removal = call.name == "unlink";
  // Nothing depends on what a lock says, all is on the disk before something is closed, and what cannot be moved into a
  // temporary file is copied.
  const bool may_succeed = call.path.find(".lock") != call.path.npos || call.name == "close" || is_removal ||
                           (call.name == "rename" && call.path.find(".tmp-") != call.path.npos);
  const auto seen = [&](const Files& files) { return is_removal ? visible(files) : files; };
  // Pictures may be left out.
  if (ending.outcome.status == 0 && ending.outcome.error.find("pictures left out: ") != std::string::npos) {
    Files numbers = whole.files;
    std::erase_if(numbers, [&](const auto& file) { return file.first.ends_with(".png"); });
    Files found = ending.files;
    std::erase_if(found, [&](const auto& file) {
      const auto made = whole.files.find(file.first);
      return file.first.ends_with(".png") && made != whole.files.end() && made->second == file.second;
    });
    return difference(seen(found), seen(numbers));
  }
  if (ending.outcome.status == 0 && may_succeed) {
    return ending.outcome.output == whole.outcome.output ? difference(seen(ending.files), seen(whole.files))
                                                         : " the answer has changed;";
  }
  std::string text;
  if (ending.outcome.status != static_cast<int>(cli::ExitCode::file)) {
    text = " exit status " + std::to_string(ending.outcome.status) + ": " + ending.outcome.error;
  } else {
    text = fault_of_refusal(ending.outcome);
  }
  // Files that have their names may be lost when their folder cannot be written.
  const bool is_late = call.name == "fsync" && call.path.find(".tmp-") == call.path.npos;
  if ((is_late || ending.was_repeated) && difference(ending.files, whole.files).empty()) return text;
  return text + difference(seen(ending.files), seen(job.inputs));
}

}  // namespace

std::vector<std::string> file_complaints(const Job& job, Calls calls) {
  std::vector<std::string> complaints;
  const Ending whole = run(job);
  if (whole.outcome.status != 0) complaints.push_back(job.name + " fails by itself: " + whole.outcome.error);
  const auto complain = [&](const std::string& failure, const std::string& text) {
    if (!text.empty()) complaints.push_back(job.name + ", " + failure + ":" + text);
  };
  for (const std::string failure : {"*:1+:SHORT", "*:1+:EINTR"}) {
    complain(failure, fault_of_success(run(job, failure), whole));
  }
  const std::vector<Call> all = calls_of(whole);
  if (all.empty()) complaints.push_back(job.name + " writes no file");
  std::set<std::string> names;
  for (const Call& call : all) names.insert(call.name);
  for (const std::string& name : names) {
    const long count = std::ranges::count(all, name, &Call::name);
    for (const long number : chosen_calls(count, calls)) {
      const auto call =
          *std::ranges::find_if(all, [&](const Call& one) { return one.name == name && one.number == number; });
      // A disk that is full stays full; one that is broken may work the next time. What is half moved is harder to put
      // back where nothing can be moved any more.
      const bool lasts = number % 2 == 1 || name == "rename";
      const std::string failure = name + ":" + std::to_string(number) + (lasts ? "+:ENOSPC" : ":EIO");
      complain(failure + " of " + std::to_string(count) + " (" + call.path + ")",
               fault(run(job, failure), whole, job, call));
    }
  }
  return complaints;
}

}  // namespace lobe::test
