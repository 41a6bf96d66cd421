#include "nets/opencl_failures.hpp"

#include <map>

#include "exit_code.hpp"

namespace lobe::test {
namespace {

Ending run(const Job& job, Environment environment = {}) {
  return run_job(job, LOBE_OPENCL_SHIM, "LOBE_CL_LOG", std::move(environment));
}

/// Of what is only given back a program may take no notice.
bool is_release(const std::string& name) {
  return name.starts_with("clRelease");
}

std::string fault(const Ending& ending, const Ending& whole, const Job& job, const std::string& name) {
  const Outcome& outcome = ending.outcome;
  if (outcome.status == 0 && is_release(name)) {
    return (outcome.output == whole.outcome.output ? "" : " the answer has changed;") +
           difference(ending.files, whole.files);
  }
  if (outcome.status != static_cast<int>(cli::ExitCode::device)) {
    return " exit status " + std::to_string(outcome.status) + ": " + outcome.error;
  }
  return fault_of_refusal(outcome) + difference(ending.files, job.inputs);
}

}  // namespace

std::vector<std::string> opencl_complaints(const Job& job, long inner) {
  std::vector<std::string> complaints;
  // What is done once, on first use, has been done by then.
  (void)run(job);
  const Ending whole = run(job);
  if (whole.outcome.status != 0) complaints.push_back(job.name + " fails by itself: " + whole.outcome.error);
  if (whole.events.empty()) complaints.push_back(job.name + " makes no OpenCL call");
  std::map<std::string, long> counts;
  for (const auto& name : whole.events) ++counts[name];
  for (const auto& [name, count] : counts) {
    for (const long call : chosen_calls(count, inner)) {
      const std::string what = name + ":" + std::to_string(call);
      const Ending ending = run(job, {{"LOBE_CL_FAIL", what}});
      std::string text = fault(ending, whole, job, name);
      if (std::ranges::count(ending.events, name) < call) text += " the call was not made;";
      if (!text.empty()) complaints.push_back(job.name + ", " + what + " of " + std::to_string(count) + ":" + text);
    }
  }
  return complaints;
}

}  // namespace lobe::test
