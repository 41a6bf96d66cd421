#pragma once

#include <cstddef>
#include <string>

#include "lobe/lut/lut_fit.hpp"
#include "lut/lut_powers.hpp"

namespace lobe {

/// Variable of the powers that belongs to an axis.
[[nodiscard]] FitVariable fit_variable(const LutAxis& axis, bool is_centred);

/// Text of an argument: "sqrt(alpha)".
[[nodiscard]] std::string fit_argument_text(const LutAxis& axis);

}  // namespace lobe
