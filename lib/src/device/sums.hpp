#pragma once

#include <cstddef>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/packed_rows.hpp"

namespace lobe {

/// A buffer of sums, all 0.
inline cl::Buffer zeros(const Device& device, std::size_t count) {
  cl::Buffer buffer(device.implementation().context, CL_MEM_READ_WRITE, count * sizeof(double));
  clear(device, buffer, count);
  return buffer;
}

inline PackedRows shared(const PackedRows& values) {
  return checked("cannot share values", [&] { return values; });
}

/// Reads a buffer of sums and sets it to zero.
inline void read_and_clear(const Device& device, const cl::Buffer& buffer, double* target, std::size_t count) {
  auto& queue = device.implementation().queue;
  queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(double), target);
  clear(device, buffer, count);
}

}  // namespace lobe
