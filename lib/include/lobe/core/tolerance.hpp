#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace [[gnu::visibility("default")]] lobe {

/// A value whose error stays above the requested tolerance. Tolerances are wishes and errors are facts: the value is
/// returned anyway, with the error that it has.
struct MissedTolerance {
  std::string quantity;       ///< the quantity: "albedo at 60 degrees of 'ward:m=0.2'"
  std::size_t index = 0;      ///< index of its direction, or pair of directions, in the call; else 0
  double relative_error = 0;  ///< error that was reached; infinite for values of 0
  double tolerance = 0;       ///< tolerance that was requested
};

/// Callback for values that miss their tolerance, called once for all channels of a value. It may throw to end the
/// computation.
using MissedToleranceCallback = std::function<void(const MissedTolerance&)>;

/// Describes a missed tolerance: "albedo at 60 degrees of 'ward:m=0.2' reaches a relative error of 2e-6 instead of
/// 1e-6".
[[nodiscard]] std::string to_string(const MissedTolerance& missed);

/// MissedToleranceCallback that refuses such values.
/// \throws NumericError always
[[noreturn]] void refuse_missed_tolerance(const MissedTolerance& missed);

}  // namespace lobe
