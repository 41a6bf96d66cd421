#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

namespace lobe {

/// Counts of numbers that a reader must refuse or report.
struct NumberCensus {
  std::size_t negative = 0;
  std::size_t not_finite = 0;
};

/// Counts numbers at any place, aligned or not; about as fast as memory delivers them if there is nothing to report.
/// \param bytes at least `count` numbers from `offset` on
template <typename Number>
[[nodiscard]] NumberCensus census(std::string_view bytes, std::size_t offset, std::size_t count) {
  static_assert(std::numeric_limits<Number>::is_iec559);
  using Bits = std::conditional_t<sizeof(Number) == sizeof(std::uint64_t), std::uint64_t, std::uint32_t>;
  constexpr Bits kSign = Bits{1} << (8 * sizeof(Bits) - 1);
  constexpr auto kLargest = std::bit_cast<Bits>(std::numeric_limits<Number>::max());
  constexpr std::size_t kBlock = 1024;
  NumberCensus found;
  const char* const numbers = bytes.data() + offset;
  const auto count_one_by_one = [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      Number number{};
      std::memcpy(&number, numbers + k * sizeof(Number), sizeof(Number));
      if (number < 0) ++found.negative;
      if (!std::isfinite(number)) ++found.not_finite;
    }
  };
  const std::size_t whole = count / kBlock * kBlock;
  for (std::size_t first = 0; first < whole; first += kBlock) {
    // Bits with a sign, or above those of the largest number: a loop of a fixed length, which compilers make vectors
    // of.
    const char* const block = numbers + first * sizeof(Number);
    Bits odd = 0;
    for (std::size_t k = 0; k < kBlock; ++k) {
      Bits bits{};
      std::memcpy(&bits, block + k * sizeof(Bits), sizeof(Bits));
      odd |= bits | (kLargest - bits);
    }
    if ((odd & kSign) != 0) count_one_by_one(first, first + kBlock);
  }
  count_one_by_one(whole, count);
  return found;
}

}  // namespace lobe
