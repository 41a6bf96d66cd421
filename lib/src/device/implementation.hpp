#pragma once

#include <map>
#include <string>

#include "device/opencl.hpp"
#include "lobe/device.hpp"

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

  Implementation() = default;
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  /// Waits for work that was left, or PoCL may fail at the end of the process.
  ~Implementation() {
    if (queue() != nullptr) ::clFinish(queue());
  }
};

}  // namespace lobe
