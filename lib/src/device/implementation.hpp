#pragma once

#include <map>
#include <set>
#include <string>

#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

struct Device::Implementation {
  DeviceInfo info;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;
  /// Lanes of a pack (kernels/prelude.clh): 8 on CPU devices, 1 elsewhere; LOBE_PACK overrides, for tests.
  unsigned pack_width = 8;
  /// Built programs by everything that distinguishes them: file list and options.
  std::map<std::string, cl::Program> programs;
  /// Kernels that have passed their self-tests (device/self_test.hpp), and whether one is on.
  std::set<std::string> sound_kernels;
  bool is_testing = false;

  /// Work-groups for kernels that leave their size to the host: of one item on CPU devices, where PoCL chooses it by
  /// the size of a launch and compiles the kernel anew for each; else what the driver likes.
  [[nodiscard]] cl::NDRange work_group(unsigned dimensions) const {
    if (pack_width == 1) return cl::NullRange;
    return dimensions == 1 ? cl::NDRange(1) : cl::NDRange(1, 1);
  }

  Implementation() = default;
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  /// Waits for work that was left, or PoCL may fail at the end of the process.
  ~Implementation() {
    if (queue() != nullptr) ::clFinish(queue());
  }
};

}  // namespace lobe
