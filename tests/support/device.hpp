#pragma once

#include "lobe/device/device.hpp"

namespace lobe::test {

/// The device of the test run. Throws, and so fails the test, where there is none: tests never skip for lack of one.
inline const Device& device() {
  // Never destroyed: OpenCL runtimes may be gone by the time that static objects go.
  static const Device& chosen = *new Device(Device::choose());
  return chosen;
}

}  // namespace lobe::test
