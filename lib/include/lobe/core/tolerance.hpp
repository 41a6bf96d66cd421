#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace [[gnu::visibility("default")]] lobe {

/// A value whose error stays above the tolerance that was asked for. Tolerances are wishes and errors are facts: the
/// value is returned all the same, with the error that it has.
struct MissedTolerance {
  std::string quantity;       ///< what it is: "albedo at 60 degrees of 'ward:m=0.2'"
  std::size_t index = 0;      ///< number of its direction, or pair of directions, in the call; else 0
  double relative_error = 0;  ///< what was reached; infinite for values of 0
  double tolerance = 0;       ///< what was asked for
};

/// Called for each value that misses its tolerance, of several channels once. May throw what ends the computation.
using MissedToleranceCallback = std::function<void(const MissedTolerance&)>;

/// "albedo at 60 degrees of 'ward:m=0.2' reaches a relative error of 2e-6 instead of 1e-6".
[[nodiscard]] std::string to_string(const MissedTolerance& missed);

/// A MissedToleranceCallback that takes no such value.
/// \throws NumericError always.
[[noreturn]] void refuse_missed_tolerance(const MissedTolerance& missed);

}  // namespace lobe
