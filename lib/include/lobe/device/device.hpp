#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace [[gnu::visibility("default")]] lobe {

/// Arithmetic of the model kernels. Sums over nodes are in double precision in either case.
enum class Precision { double_precision, single_precision };

/// Description of an OpenCL device, as users need it to tell devices apart.
struct DeviceInfo {
  std::string selector;          ///< "platform:device", the shortest text that Device::choose takes for this device
  std::string platform;          ///< name of the platform
  std::string platform_version;  ///< "OpenCL 3.0 PoCL 3.1"
  std::string name;              ///< name of the device
  std::string vendor;            ///< vendor of the device
  std::string driver;            ///< version of the driver
  std::string version;           ///< OpenCL version that the device offers
  bool is_cpu = false;           ///< whether the device is a CPU
  bool has_double = false;       ///< whether it computes in double precision, as Device::choose() requires
  unsigned compute_units = 0;    ///< processors, or the device's equivalent
  std::uint64_t global_memory_bytes = 0;   ///< global memory of the device
  std::uint64_t largest_buffer_bytes = 0;  ///< largest size of a single buffer
};

/// Lists every OpenCL device of every platform, in the order the loader reports them; empty if there is none.
[[nodiscard]] std::vector<DeviceInfo> list_devices();

/// An OpenCL device with its context, queue and built programs. A shared handle: copies are cheap and refer to the same
/// device. It must not be used by several threads at once.
class Device {
 public:
  /// Chooses a device.
  /// \param selector "platform[:device]", each part a number or a case-insensitive part of the name ("portable:0");
  ///   empty: the environment variable LOBE_DEVICE, else the first device with double precision
  /// \throws DeviceError if no device matches (the message lists the available ones) or it lacks double precision
  [[nodiscard]] static Device choose(std::string_view selector = {});
  /// Makes a handle whose device is chosen when something is first computed on it; tables and measured files need none.
  /// \throws nothing; the errors of choose() are thrown at the first use
  [[nodiscard]] static Device on_demand(std::string_view selector = {});

  /// Whether the device has been chosen.
  [[nodiscard]] bool is_chosen() const;
  /// Description of the device.
  /// \throws as choose(), of one on demand
  [[nodiscard]] const DeviceInfo& info() const;

  struct Implementation;
  /// Access for the rooms of the library.
  /// \throws as choose(), of one on demand
  [[nodiscard]] Implementation& implementation() const;

 private:
  struct Choice;
  explicit Device(std::shared_ptr<Choice> choice) : choice_(std::move(choice)) {}
  std::shared_ptr<Choice> choice_;
};

}  // namespace lobe
