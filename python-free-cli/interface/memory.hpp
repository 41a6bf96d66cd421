#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lobe::cli {

/// Bytes of memory that this process occupies now.
[[nodiscard]] std::uint64_t resident_bytes();

/// The most that it has occupied so far.
[[nodiscard]] std::uint64_t peak_resident_bytes();

/// Memory of the machine, or of the share of it that this process may use; 0 where unknown.
struct MachineMemory {
  std::uint64_t total_bytes = 0;
  std::uint64_t available_bytes = 0;
};
[[nodiscard]] MachineMemory machine_memory();

/// Memory that the limit on this process's addresses (ulimit -v) leaves; none without a limit.
[[nodiscard]] std::optional<std::uint64_t> bytes_within_limit();

/// "3.2 GiB", "640 KiB".
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);

}  // namespace lobe::cli
