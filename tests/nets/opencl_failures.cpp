#include "nets/opencl_failures.hpp"

#include <algorithm>
#include <map>

#include "interface/exit_code.hpp"

namespace lobe::test {
namespace {

Ending run(const Job& job, Environment environment = {}) {
  return run_job(job, LOBE_OPENCL_SHIM, "LOBE_CL_LOG", std::move(environment));
}

/// A program may take no notice when something is only given back, or waited for before that.
bool may_be_ignored(const std::vector<std::string>& events, const std::string& name, long call) {
  if (name.starts_with("clRelease")) return true;
  auto at = events.begin();
  for (at = std::find(at, events.end(), name); --call > 0; at = std::find(at + 1, events.end(), name)) {
  }
  const bool ends = at + 1 == events.end() || (at + 1)->starts_with("clReleaseProgram") ||
                    (at + 1)->starts_with("clReleaseCommandQueue");
  return name == "clFinish" && ends;
}

std::string fault(const Ending& ending, const Ending& whole, const Job& job, bool may_succeed) {
  const Outcome& outcome = ending.outcome;
  if (outcome.status == 0 && may_succeed) {
    return (outcome.output == whole.outcome.output ? "" : " the answer has changed;") +
           difference(ending.files, whole.files);
  }
  if (outcome.status != static_cast<int>(cli::ExitCode::device)) {
    return " exit status " + std::to_string(outcome.status) + ": " + outcome.error;
  }
  return fault_of_refusal(outcome) + difference(ending.files, job.inputs);
}

}  // namespace

std::vector<std::string> opencl_complaints(const Job& job, Calls calls) {
  std::vector<std::string> complaints;
  // What is done once, on first use, has been done by then.
  (void)run(job);
  const Ending whole = run(job);
  if (whole.outcome.status != 0) complaints.push_back(job.name + " fails by itself: " + whole.outcome.error);
  if (whole.events.empty()) complaints.push_back(job.name + " makes no OpenCL call");
  std::map<std::string, long> counts;
  for (const auto& name : whole.events) ++counts[name];
  for (const auto& [name, count] : counts) {
    for (const long call : chosen_calls(count, calls)) {
      const std::string what = name + ":" + std::to_string(call);
      const Ending ending = run(job, {{"LOBE_CL_FAIL", what}});
      std::string text = fault(ending, whole, job, may_be_ignored(whole.events, name, call));
      if (std::ranges::count(ending.events, name) < call) text += " the call was not made;";
      if (!text.empty()) complaints.push_back(job.name + ", " + what + " of " + std::to_string(count) + ":" + text);
    }
  }
  return complaints;
}

}  // namespace lobe::test
