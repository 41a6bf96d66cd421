#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace lobe::cli {

/// The folder for files that live no longer than the process and may be large: TMPDIR, else /var/tmp.
[[nodiscard]] std::filesystem::path scratch_folder();

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

/// Bytes of "2G", "1.5GiB" or "800M": K, M, G and T are powers of 1024.
/// \throws ArgumentError for anything else
[[nodiscard]] std::uint64_t parse_bytes(const std::string& text);

/// "3.2 GiB", "640 KiB".
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);

}  // namespace lobe::cli
