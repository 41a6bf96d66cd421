#pragma once

#include "nets/workplace.hpp"

namespace lobe::test {

/// Answers chosen calls of every OpenCL entry point that a job uses by an error, one call a run.
/// \return a line for every run that neither refuses with exit status 4, one line on standard error and nothing else,
///   nor, where what failed was only to give something back, does all that it should
/// \param inner  how many calls between the first two and the last one
[[nodiscard]] std::vector<std::string> opencl_complaints(const Job& job, Calls calls);

}  // namespace lobe::test
