#pragma once

namespace lobe::cli {

/// What the command's exit status says; listed in `lobe --help`.
enum class ExitCode : int {
  success = 0,
  negative = 1,  ///< a comparison asked for did not hold (distance --fail-above, bounds in info, check, published
                 ///< figures)
  usage = 2,     ///< a mistake on the command line or in a study file
  file = 3,      ///< a file cannot be read or written
  device = 4,    ///< no usable OpenCL device, or it failed
  numeric = 5,   ///< a quantity does not exist or cannot be computed
  interrupted = 130
};

}  // namespace lobe::cli
