#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "device/opencl.hpp"

namespace lobe {

/// "CL_OUT_OF_RESOURCES" for -5, and so on; "OpenCL error -9999" for a code not in the headers.
[[nodiscard]] std::string error_name(cl_int code);

[[noreturn]] void throw_device_error(std::string_view what, const cl::Error& error);

/// Runs a piece of OpenCL work and turns cl::Error into DeviceError: "<what>: <call> failed with <code name>".
template <typename Work>
decltype(auto) checked(std::string_view what, const Work& work) {
  try {
    return work();
  } catch (const cl::Error& error) {
    throw_device_error(what, error);
  }
}

}  // namespace lobe
