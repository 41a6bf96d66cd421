#include "lobe/core/tolerance.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {

std::string to_string(const MissedTolerance& missed) {
  const std::string reached =
      std::isfinite(missed.relative_error) ? fmt::format("{:.2g}", missed.relative_error) : "infinity";
  return fmt::format("{} reaches a relative error of {} instead of {}", missed.quantity, reached,
                     shortest(missed.tolerance));
}

void refuse_missed_tolerance(const MissedTolerance& missed) {
  throw NumericError(to_string(missed) + "; give a larger tolerance");
}

}  // namespace lobe
