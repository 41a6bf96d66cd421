#include <fmt/core.h>

#include <algorithm>

#include "interface/command.hpp"
#include "interface/session.hpp"
#include "lobe/core/error.hpp"
#include "lobe/device/device.hpp"
#include "lobe/device/self_test.hpp"

namespace lobe::cli {
namespace {

constexpr Flag kSelfTest{"self-test"};

constexpr double kBytesPerGibibyte = 1024.0 * 1024.0 * 1024.0;

std::string gibibytes(std::uint64_t bytes) {
  return fmt::format("{:.1f}", static_cast<double>(bytes) / kBytesPerGibibyte);
}

std::string verdict(const SelfTestResult& result) {
  if (!result.error.empty()) return "failed";
  return result.is_sound ? "right" : "wrong";
}

Json result_json(const SelfTestResult& result) {
  return {{"kernel", result.kernel},
          {"deviation", to_json(result.deviation)},
          {"allowed", result.allowed},
          {"is_sound", result.is_sound},
          {"error", result.error}};
}

ExitCode test(Session& session) {
  const Device device = session.choose_device();
  const auto results = self_test(device);
  const auto wrong = std::ranges::count(results, false, &SelfTestResult::is_sound);
  if (session.wants_json()) {
    Json answer = json_answer("devices");
    answer["device"] = to_json(device.info());
    answer["self_test"] = Json::array();
    for (const auto& result : results) answer["self_test"].push_back(result_json(result));
    answer["wrong"] = wrong;
    session.print_json(answer);
  } else {
    std::vector<std::vector<std::string>> rows{{"kernel", "deviation", "allowed", "result"}};
    for (const auto& result : results) {
      // Among some hundred kernels only the wrong ones are news.
      if (!result.is_sound || session.is_verbose()) {
        rows.push_back({result.kernel, fmt::format("{:.1e}", result.deviation), fmt::format("{:.0e}", result.allowed),
                        verdict(result)});
      }
    }
    if (rows.size() > 1) session.print(format_table(rows, 0, session.colors_output()));
    session.print(fmt::format("{}, {}: {} of {} kernels compute what is known of them\n", device.info().name,
                              device.info().driver, results.size() - static_cast<std::size_t>(wrong), results.size()));
    for (const auto& result : results) {
      if (!result.error.empty()) session.warn(result.kernel + ": " + result.error);
    }
  }
  return wrong == 0 ? ExitCode::success : ExitCode::device;
}

ExitCode execute_devices(Session& session) {
  if (session.arguments().has(kSelfTest)) return test(session);
  const auto devices = list_devices();
  if (devices.empty()) {
    (void)Device::choose();  // says why there is none
    throw DeviceError("OpenCL answered at the second attempt only");
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
  return {
      .name = "devices",
      .group = "Reference",
      .summary = "list the OpenCL devices",
      .description =
          "Lists the OpenCL devices of this machine. The column 'selector' shows what to pass to --device or to set in "
          "the environment variable LOBE_DEVICE.\n\n"
          "With --self-test the chosen device computes results that are known: each model, factor and correction at "
          "some pairs of directions, sums, products, samples and pictures of a few numbers. Kernels that deviate by "
          "more than rounding are listed, or all with --verbose; if there are any, the exit status is 4. Commands test "
          "the kernels that they use anyway, before they use them.",
      .positionals = {},
      .options = {{.handle = kSelfTest, .help = "test all kernels on results that are known"}, json_option()},
      .examples = {{"all devices", "lobe devices"},
                   {"the same as JSON", "lobe devices --json"},
                   {"whether the device computes correctly", "lobe devices --self-test"}},
      .execute = execute_devices};
}

}  // namespace lobe::cli
