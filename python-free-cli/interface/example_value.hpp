#pragma once

#include "lobe/model/model.hpp"

namespace lobe::cli {

/// A value that makes sense in an example: the default, else something usual of its kind.
[[nodiscard]] double example_value(const Parameter& parameter);

}  // namespace lobe::cli
