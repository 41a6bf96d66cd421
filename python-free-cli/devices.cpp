#include <fmt/core.h>

#include "command.hpp"
#include "lobe/error.hpp"
#include "session.hpp"

namespace lobe::cli {
namespace {

constexpr double kBytesPerGibibyte = 1024.0 * 1024.0 * 1024.0;

std::string gibibytes(std::uint64_t bytes) {
  return fmt::format("{:.1f}", static_cast<double>(bytes) / kBytesPerGibibyte);
}

ExitCode execute(Session& session) {
  const auto devices = list_devices();
  if (devices.empty()) {
    throw DeviceError(
        "no OpenCL device found; install a driver, on Debian for example pocl-opencl-icd, or, if there is one, make "
        "its "
        "kernel cache (POCL_CACHE_DIR) writable");
  }
  if (session.wants_json()) {
    Json answer = json_answer("devices");
    answer["devices"] = Json::array();
    for (const auto& device : devices) answer["devices"].push_back(to_json(device));
    session.print_json(answer);
    return ExitCode::success;
  }
  std::vector<std::vector<std::string>> rows{
      {"selector", "device", "platform", "type", "double", "units", "memory/GiB", "driver"}};
  for (const auto& device : devices) {
    rows.push_back({device.selector, device.name, device.platform, device.is_cpu ? "CPU" : "other",
                    device.has_double ? "yes" : "no", std::to_string(device.compute_units),
                    gibibytes(device.global_memory_bytes), device.driver});
  }
  session.print(format_table(rows, rows.front().size(), session.colors_output()));
  return ExitCode::success;
}

}  // namespace

Command devices_command() {
  return {.name = "devices",
          .group = "Reference",
          .summary = "list the OpenCL devices",
          .description =
              "Lists the OpenCL devices of this machine. What stands under 'selector' can be given to --device "
              "or put into the environment variable LOBE_DEVICE.",
          .positionals = {},
          .options = {json_option()},
          .examples = {{"what there is", "lobe devices"}, {"the same for a program to read", "lobe devices --json"}},
          .execute = execute};
}

}  // namespace lobe::cli
