#include "lobe/device/device.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <mutex>

#include "device/error.hpp"
#include "device/implementation.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

std::string without_trailing_space(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

struct Found {
  DeviceInfo info;
  cl::Device device;
};

/// PoCL ends the process where the variable is empty.
void require_cache_directory() {
  const char* cache = std::getenv("POCL_CACHE_DIR");
  if (cache == nullptr || *cache != '\0') return;
  throw DeviceError(
      "environment variable POCL_CACHE_DIR is empty; expected a directory for compiled kernels, or unset");
}

std::vector<Found> find_devices() {
  require_cache_directory();
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return {};  // CL_PLATFORM_NOT_FOUND_KHR: a loader without drivers
  }
  std::vector<Found> found;
  for (std::size_t p = 0; p < platforms.size(); ++p) {
    std::vector<cl::Device> devices;
    try {
      platforms[p].getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {
      continue;  // CL_DEVICE_NOT_FOUND: a driver without hardware
    }
    for (std::size_t d = 0; d < devices.size(); ++d) {
      const cl::Device& device = devices[d];
      DeviceInfo info;
      info.selector = std::to_string(p) + ":" + std::to_string(d);
      info.platform = without_trailing_space(platforms[p].getInfo<CL_PLATFORM_NAME>());
      info.platform_version = without_trailing_space(platforms[p].getInfo<CL_PLATFORM_VERSION>());
      info.name = without_trailing_space(device.getInfo<CL_DEVICE_NAME>());
      info.vendor = without_trailing_space(device.getInfo<CL_DEVICE_VENDOR>());
      info.driver = without_trailing_space(device.getInfo<CL_DRIVER_VERSION>());
      info.version = without_trailing_space(device.getInfo<CL_DEVICE_VERSION>());
      info.is_cpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
      info.has_double = device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() != 0;
      info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
      info.global_memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
      info.largest_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
      found.push_back({std::move(info), device});
    }
  }
  return found;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// A part of a selector matches its number, or a piece of the name.
bool matches(std::string_view part, std::string_view number, std::string_view name) {
  if (part.empty() || part == number) return true;
  const bool is_number = std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return !is_number && lower(name).find(lower(part)) != std::string::npos;
}

bool matches(std::string_view selector, const DeviceInfo& info) {
  const std::string_view own = info.selector;
  const std::size_t own_colon = own.find(':');
  const std::size_t colon = selector.find(':');
  const std::string_view device = colon == std::string_view::npos ? std::string_view{} : selector.substr(colon + 1);
  return matches(selector.substr(0, colon), own.substr(0, own_colon), info.platform) &&
         matches(device, own.substr(own_colon + 1), info.name);
}

std::string no_device() {
  rlimit addresses{};
  if (::getrlimit(RLIMIT_AS, &addresses) == 0 && addresses.rlim_cur != RLIM_INFINITY) {
    // The loader leaves out silently any driver that it cannot map.
    return "no OpenCL device found; the process may use " + std::to_string(addresses.rlim_cur >> 20) +
           " MiB of addresses (ulimit -v), which may be too little to load a driver; raise the limit, or install a "
           "driver such as pocl-opencl-icd";
  }
  return "no OpenCL device found; install a driver such as pocl-opencl-icd, or, if there is one, make its kernel "
         "cache directory (POCL_CACHE_DIR) writable";
}

std::string describe(const std::vector<Found>& devices) {
  if (devices.empty()) return no_device();
  std::string text = "there is:";
  for (const auto& found : devices) {
    text += " " + found.info.selector + " (" + found.info.platform + ", " + found.info.name +
            (found.info.has_double ? ")" : ", no double precision)");
  }
  return text;
}

unsigned pack_width(const DeviceInfo& info) {
  const char* forced = std::getenv("LOBE_PACK");
  if (forced != nullptr && *forced != '\0') {
    const std::string_view text = forced;
    if (text == "1") return 1;
    if (text == "8") return 8;
    throw ArgumentError("environment variable LOBE_PACK is '" + std::string(text) + "'; expected 1 or 8");
  }
  return info.is_cpu ? 8 : 1;
}

std::shared_ptr<Device::Implementation> chosen(std::string_view selector) {
  std::string origin = "device selector";
  if (selector.empty()) {
    const char* variable = std::getenv("LOBE_DEVICE");
    if (variable != nullptr) selector = variable;
    origin = "environment variable LOBE_DEVICE";
  }
  if (selector.find(',') != std::string_view::npos) {
    throw DeviceError(origin + " '" + std::string(selector) +
                      "' names several devices, which only the runs of studies take; expected one");
  }
  const auto devices = checked("cannot list the OpenCL devices", find_devices);
  if (devices.empty()) throw DeviceError(describe(devices));

  const auto wanted = std::find_if(devices.begin(), devices.end(), [&](const Found& found) {
    return selector.empty() ? found.info.has_double : matches(selector, found.info);
  });
  if (wanted == devices.end()) {
    throw DeviceError(selector.empty()
                          ? "no OpenCL device has double precision; " + describe(devices)
                          : origin + " '" + std::string(selector) + "' matches no OpenCL device; " + describe(devices));
  }
  if (!wanted->info.has_double) {
    throw DeviceError("OpenCL device " + wanted->info.name + " has no double precision, which sums need; " +
                      describe(devices));
  }

  auto implementation = std::make_shared<Device::Implementation>();
  implementation->info = wanted->info;
  implementation->device = checked("cannot use OpenCL device " + wanted->info.name, [&] { return wanted->device; });
  implementation->pack_width = pack_width(wanted->info);
  try {
    implementation->context = cl::Context(wanted->device);
    implementation->queue = cl::CommandQueue(implementation->context, wanted->device);
  } catch (const cl::Error& error) {
    // PoCL answers so when it cannot create its kernel cache.
    const char* cache = std::getenv("POCL_CACHE_DIR");
    throw DeviceError("cannot use OpenCL device " + wanted->info.name + ": " + error.what() + " failed with " +
                      error_name(error.err()) + "; check that the kernel cache directory (POCL_CACHE_DIR, here '" +
                      (cache != nullptr ? cache : "~/.cache/pocl") + "') is writable");
  }
  return implementation;
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
  return checked("cannot list the OpenCL devices", [] {
    std::vector<DeviceInfo> infos;
    for (auto& found : find_devices()) infos.push_back(std::move(found.info));
    return infos;
  });
}

/// A choice made or to be made.
struct Device::Choice {
  std::string selector;
  std::mutex turn;
  std::shared_ptr<Implementation> implementation;

  Implementation& made() {
    const std::scoped_lock lock(turn);
    if (!implementation) implementation = chosen(selector);
    return *implementation;
  }
};

Device Device::on_demand(std::string_view selector) {
  auto choice = std::make_shared<Choice>();
  choice->selector = selector;
  return Device(std::move(choice));
}

Device Device::choose(std::string_view selector) {
  Device device = on_demand(selector);
  (void)device.implementation();
  return device;
}

bool Device::is_chosen() const {
  const std::scoped_lock lock(choice_->turn);
  return choice_->implementation != nullptr;
}

const DeviceInfo& Device::info() const {
  return implementation().info;
}

Device::Implementation& Device::implementation() const {
  return choice_->made();
}

}  // namespace lobe
