#pragma once

#include "nets/workplace.hpp"

namespace lobe::test {

/// Disturbs the calls by which a job writes files, one disturbance a run: everything is written in parts and every
/// other call is interrupted, which a job has to survive with the same files; chosen calls of each kind fail, once or
/// from then on, which has to end with exit status 3, one line, and the files that were there before.
/// \return a line for every run that does otherwise
[[nodiscard]] std::vector<std::string> file_complaints(const Job& job, Calls calls);

}  // namespace lobe::test
