#pragma once

#include <array>
#include <string_view>

namespace lobe::cli {

/// Exit statuses of the command.
enum class ExitCode : int {
  success = 0,
  negative = 1,
  usage = 2,
  file = 3,
  device = 4,
  numeric = 5,
  interrupted = 130  ///< 128 + the number of SIGINT, as shells have it; 143 after SIGTERM
};

struct ExitMeaning {
  ExitCode code;
  std::string_view meaning;
};

/// Table of `lobe help exit-codes`.
inline constexpr std::array kExitMeanings{
    ExitMeaning{ExitCode::success, "done"},
    ExitMeaning{ExitCode::negative,
                "the comparison asked for does not hold (distance --fail-above, check, bounds in info, published "
                "figures in run); the results are printed all the same"},
    ExitMeaning{ExitCode::usage, "mistake on the command line, in a material or in a study file"},
    ExitMeaning{ExitCode::file, "a file cannot be read or written"},
    ExitMeaning{ExitCode::device, "no usable OpenCL device, or it failed"},
    ExitMeaning{ExitCode::numeric, "a quantity does not exist or cannot be computed"},
    ExitMeaning{ExitCode::interrupted, "interrupted by Ctrl-C; 143 by SIGTERM"}};

}  // namespace lobe::cli
