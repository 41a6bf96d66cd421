#pragma once

#include <cstdint>
#include <string_view>

namespace lobe {

/// FNV-1a of 64 bits. Bytes may come in pieces. It finds damage, not forgery: any single byte that changes changes it.
class Checksum {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      value_ ^= static_cast<unsigned char>(byte);
      value_ *= 0x100000001b3U;
    }
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace lobe
