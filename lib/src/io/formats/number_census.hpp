#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

namespace lobe {

/// What there is among numbers that a reader has to refuse or to report.
struct NumberCensus {
  std::size_t negative = 0;
  std::size_t not_finite = 0;
};

/// Of numbers that lie at any place, aligned or not; about as fast as they come from memory.
/// \param bytes at least `count` numbers from `offset` on
template <typename Number>
[[nodiscard]] NumberCensus census(std::string_view bytes, std::size_t offset, std::size_t count) {
  // Loops of a fixed length over counters as wide as the numbers, which compilers make vectors of.
  constexpr std::size_t kBlock = 256;
  using Counter = std::conditional_t<sizeof(Number) == sizeof(std::int64_t), std::int64_t, std::int32_t>;
  NumberCensus found;
  const auto add = [&](const char* block) {
    Counter negative = 0;
    Counter finite = 0;
    for (std::size_t k = 0; k < kBlock; ++k) {
      Number number{};
      std::memcpy(&number, block + k * sizeof(Number), sizeof(Number));
      negative += number < 0 ? 1 : 0;
      finite += std::abs(number) <= std::numeric_limits<Number>::max() ? 1 : 0;
    }
    found.negative += static_cast<std::size_t>(negative);
    found.not_finite += kBlock - static_cast<std::size_t>(finite);
  };
  const char* const numbers = bytes.data() + offset;
  const std::size_t whole = count / kBlock * kBlock;
  for (std::size_t first = 0; first < whole; first += kBlock) add(numbers + first * sizeof(Number));
  std::array<char, kBlock * sizeof(Number)> rest{};
  std::memcpy(rest.data(), numbers + whole * sizeof(Number), (count - whole) * sizeof(Number));
  add(rest.data());
  return found;
}

}  // namespace lobe
