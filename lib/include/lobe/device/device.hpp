#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

/// Arithmetic of the model kernels. Sums over nodes are in double precision either way.
enum class Precision { double_precision, single_precision };

/// What a user needs to tell OpenCL devices apart.
struct DeviceInfo {
  std::string selector;          ///< "platform:device", the shortest text that Device::choose takes for this device
  std::string platform;          ///< name of the platform
  std::string platform_version;  ///< "OpenCL 3.0 PoCL 3.1"
  std::string name;              ///< of the device
  std::string vendor;            ///< of the device
  std::string driver;            ///< version of the driver
  std::string version;           ///< of OpenCL that the device offers
  bool is_cpu = false;           ///< a device of type CPU
  bool has_double = false;       ///< computes in double precision, as Device::choose() asks for
  unsigned compute_units = 0;    ///< processors, or what the device counts as such
  std::uint64_t global_memory_bytes = 0;   ///< global memory of the device
  std::uint64_t largest_buffer_bytes = 0;  ///< most that a single buffer may hold
};

/// Every OpenCL device of every platform, in the order the loader reports them; empty when there is none.
[[nodiscard]] std::vector<DeviceInfo> list_devices();

/// One OpenCL device with its context, queue and built programs. A shared handle: copies are cheap and refer to the
/// same device. Not for concurrent use from several threads.
class Device {
 public:
  /// Chooses a device.
  /// \param selector "platform[:device]", each part a number or a case-insensitive piece of the name ("portable:0");
  ///   empty: the environment variable LOBE_DEVICE, else the first device with double precision.
  /// \throws DeviceError when no device matches (the message lists what there is) or it lacks double precision.
  [[nodiscard]] static Device choose(std::string_view selector = {});
  /// A device that is chosen when something is first computed on it: tables and measured files ask for none.
  /// \throws nothing; what choose() would throw is thrown then
  [[nodiscard]] static Device on_demand(std::string_view selector = {});

  /// Whether the device has been chosen.
  [[nodiscard]] bool is_chosen() const;
  /// What is known of the device.
  /// \throws as choose(), of one on demand
  [[nodiscard]] const DeviceInfo& info() const;

  struct Implementation;
  /// For the rooms of the library.
  /// \throws as choose(), of one on demand
  [[nodiscard]] Implementation& implementation() const;

 private:
  struct Choice;
  explicit Device(std::shared_ptr<Choice> choice) : choice_(std::move(choice)) {}
  std::shared_ptr<Choice> choice_;
};

}  // namespace lobe
