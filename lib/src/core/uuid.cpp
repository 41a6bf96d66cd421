#include "core/uuid.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "core/checksum.hpp"

namespace lobe {

std::string uuid_of(std::string_view text) {
  std::array<std::uint64_t, 2> halves{};
  for (std::size_t k = 0; k < halves.size(); ++k) {
    Checksum sum;
    sum.add(k == 0 ? "first" : "second");
    sum.add(text);
    halves[k] = sum.value();
  }
  constexpr std::uint64_t kVersion = 8;
  halves[0] = (halves[0] & ~std::uint64_t{0xf000}) | kVersion << 12U;
  halves[1] = (halves[1] & ~(std::uint64_t{3} << 62U)) | std::uint64_t{2} << 62U;
  return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", halves[0] >> 32U, halves[0] >> 16U & 0xffffU,
                     halves[0] & 0xffffU, halves[1] >> 48U, halves[1] & 0xffff'ffff'ffffU);
}

}  // namespace lobe
