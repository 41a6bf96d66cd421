#pragma once

#include <functional>

#include "lobe/model/material.hpp"

namespace lobe {

/// Which of its arguments each maximum of a divisor of pumping-up takes at two cosines, as a number: where it changes,
/// the divisor has a kink. Differences of curves below their own error do not count.
[[nodiscard]] std::function<unsigned(double cos_i, double cos_o)> divisor_pieces(const Pumping& pumping);

}  // namespace lobe
