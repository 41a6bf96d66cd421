#pragma once

#include <cstddef>
#include <exception>
#include <span>
#include <vector>

#include "device/implementation.hpp"
#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// The least multiple of `step` that is not below a value.
[[nodiscard]] inline std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

/// A number as kernels take it.
[[nodiscard]] inline cl_uint uint_of(std::size_t value) {
  return static_cast<cl_uint>(value);
}

/// Sets all arguments of a kernel. Buffers are named objects of the caller: OpenCL keeps no reference to them.
template <typename... Values>
void set_arguments(cl::Kernel& kernel, const Values&... values) {
  cl_uint index = 0;
  (kernel.setArg(index++, values), ...);
}

/// A buffer of `bytes`, of one byte where there are none.
[[nodiscard]] inline cl::Buffer make_buffer(const Device& device, std::size_t bytes) {
  return {device.implementation().context, CL_MEM_READ_WRITE, bytes > 0 ? bytes : 1};
}

/// Maps a buffer and unmaps it again, in the sequence of the queue: for CL_MAP_READ, host memory then shows what the
/// device wrote.
inline void map_once(const Device& device, const cl::Buffer& buffer, std::size_t bytes, cl_map_flags access) {
  auto& queue = device.implementation().queue;
  queue.enqueueUnmapMemObject(buffer, queue.enqueueMapBuffer(buffer, CL_FALSE, access, 0, bytes));
}

/// Lets the device finish when something throws: what it still works with, host memory or a buffer that is being
/// mapped, must not go before. To be declared after that.
class FinishOnFailure {
 public:
  explicit FinishOnFailure(const Device& device) : device_(device) {}
  FinishOnFailure(const FinishOnFailure&) = delete;
  FinishOnFailure& operator=(const FinishOnFailure&) = delete;
  ~FinishOnFailure() {
    if (std::uncaught_exceptions() > before_) ::clFinish(device_.implementation().queue());
  }

 private:
  const Device& device_;
  int before_ = std::uncaught_exceptions();
};

/// A buffer of `bytes` that kernels fill before they read it. It is mapped once for oclgrind, which else takes a new
/// buffer to be as large as a released one, and what lies behind for uninitialised.
[[nodiscard]] inline cl::Buffer make_workspace(const Device& device, std::size_t bytes) {
  cl::Buffer buffer = make_buffer(device, bytes);
  const FinishOnFailure finish(device);
  map_once(device, buffer, bytes, CL_MAP_WRITE_INVALIDATE_REGION);
  device.implementation().queue.finish();
  return buffer;
}

/// A buffer of values where they lie, copied only where device and host do not share memory. It is mapped once, or
/// oclgrind takes the values for uninitialised.
template <typename Value>
[[nodiscard]] cl::Buffer host_buffer(const Device& device, std::span<Value> values, cl_mem_flags access) {
  cl::Buffer buffer(device.implementation().context, access | CL_MEM_USE_HOST_PTR, values.size_bytes(), values.data());
  map_once(device, buffer, values.size_bytes(), CL_MAP_WRITE);
  return buffer;
}

/// A buffer with a copy of some values.
template <typename Value>
[[nodiscard]] cl::Buffer constant_buffer(const Device& device, std::span<const Value> values) {
  auto* data = const_cast<Value*>(values.data());  // read only, as OpenCL is told
  return {device.implementation().context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, values.size_bytes(), data};
}

template <typename Value>
[[nodiscard]] cl::Buffer constant_buffer(const Device& device, const std::vector<Value>& values) {
  return constant_buffer(device, std::span<const Value>(values));
}

/// Sets a whole buffer of doubles to zero, by writing: oclgrind does not see what enqueueFillBuffer initialises.
inline void clear(const Device& device, const cl::Buffer& buffer, std::size_t count) {
  const std::vector<double> zeros(count);
  device.implementation().queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, count * sizeof(double), zeros.data());
}

/// Doubles as the device computes with them: double or float.
[[nodiscard]] inline cl::Buffer constant_numbers(const Device& device, std::span<const double> values,
                                                 Precision precision) {
  if (precision == Precision::double_precision) return constant_buffer(device, values);
  const std::vector<float> rounded(values.begin(), values.end());
  return constant_buffer(device, std::span<const float>(rounded));
}

}  // namespace lobe
