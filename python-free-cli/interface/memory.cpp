#include "interface/memory.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>

#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// The number behind "KEY:" in a file of /proc, in bytes (such files count in kB); 0 where there is none.
std::uint64_t proc_bytes(const char* path, std::string_view key) {
  std::ifstream file(path);
  std::string word;
  for (std::uint64_t kilobytes = 0; file >> word;) {
    if (word == key && file >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

/// The limit of the control group, as containers have it; 0 where there is none.
std::uint64_t group_limit_bytes() {
  std::ifstream file("/sys/fs/cgroup/memory.max");
  std::uint64_t bytes = 0;
  return file >> bytes ? bytes : 0;
}

}  // namespace

std::uint64_t resident_bytes() {
  return proc_bytes("/proc/self/status", "VmRSS:");
}

std::uint64_t peak_resident_bytes() {
  return proc_bytes("/proc/self/status", "VmHWM:");
}

MachineMemory machine_memory() {
  MachineMemory memory{proc_bytes("/proc/meminfo", "MemTotal:"), proc_bytes("/proc/meminfo", "MemAvailable:")};
  if (const std::uint64_t limit = group_limit_bytes(); limit > 0) {
    memory.total_bytes = std::min(memory.total_bytes, limit);
    memory.available_bytes = std::min(memory.available_bytes, limit);
  }
  return memory;
}

std::optional<std::uint64_t> bytes_within_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  const std::uint64_t taken = proc_bytes("/proc/self/status", "VmSize:");
  return limit.rlim_cur > taken ? limit.rlim_cur - taken : 0;
}

std::filesystem::path scratch_folder() {
  const char* given = std::getenv("TMPDIR");
  return given != nullptr && *given != '\0' ? given : "/var/tmp";
}

std::uint64_t parse_bytes(const std::string& text) {
  constexpr std::string_view kUnits = "KMGT";
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, code] = std::from_chars(text.data(), end, value);
  const std::string_view unit(rest, end);
  const std::size_t power = unit.empty() ? std::string_view::npos : kUnits.find(unit.front());
  const bool is_unit = power != std::string_view::npos && (unit.size() == 1 || unit.substr(1) == "iB");
  const double bytes = is_unit ? std::ldexp(value, 10 * (static_cast<int>(power) + 1)) : 0;
  constexpr double kMost = 9e18;  // what counts of bytes hold
  if (code != std::errc() || !(bytes >= 1 && bytes < kMost)) {
    throw ArgumentError("'" + text + "' is no size of memory; expected a number with K, M, G or T, such as 2G");
  }
  return static_cast<std::uint64_t>(bytes);
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr std::array kUnits{"bytes", "KiB", "MiB", "GiB", "TiB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000 && unit + 1 < kUnits.size(); ++unit) value /= 1024;
  return fmt::format("{:.3g} {}", value, kUnits.at(unit));
}

}  // namespace lobe::cli
