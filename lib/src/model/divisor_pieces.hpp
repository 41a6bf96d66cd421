#pragma once

#include <functional>
#include <vector>

#include "hemisphere/kink.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// Which of its arguments each maximum of a divisor of pumping-up takes at two cosines, as a number: where it changes,
/// the divisor has a kink. Differences of curves below their own error do not count.
[[nodiscard]] std::function<unsigned(double cos_i, double cos_o)> divisor_pieces(const Pumping& pumping);

/// Where a divisor goes over from an albedo to a cosine.
[[nodiscard]] std::vector<Kink> cosine_pieces_kinks(const Pumping& pumping);
/// Where it goes over from one albedo to the other, beside N.L = N.V: of curves that rise and fall.
[[nodiscard]] std::vector<Kink> albedo_pieces_kinks(const Pumping& pumping);

}  // namespace lobe
