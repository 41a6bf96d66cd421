#include "device/tabulate_patch_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// acos of a cosine that may be out of range: 0 above 1, pi below -1.
double clipped_acos(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

PatchLight::PatchLight(const Device& device, std::vector<LightDisc> discs) : device_(device), discs_(std::move(discs)) {
  checked("cannot prepare patch lights", [&] {
    kernel_ = make_kernel(
        build_program(device_, {"prelude.clh", "products/tabulate_patch_light.cl"}, Precision::double_precision),
        "tabulate_patch_light", 10);
    std::vector<double> rows;
    for (const auto& [radius, factor] : discs_) rows.insert(rows.end(), {radius, factor});
    disc_buffer_ = constant_buffer(device_, std::span<const double>(rows));
    require_sound(device_, "tabulate_patch_light.cl", [&] { return test_patch_light(device_); });
  });
}

cl::Buffer PatchLight::coordinates(const DiscPoints& points, std::size_t stride) const {
  std::vector<double> rows(4 * stride);
  for (std::size_t i = 0; i < points.size(); ++i) {
    rows[i] = points.radius[i];
    rows[stride + i] = points.angle[i];
    rows[2 * stride + i] = std::cos(points.angle[i]);
    rows[3 * stride + i] = std::sin(points.angle[i]);
  }
  return constant_buffer(device_, std::span<const double>(rows));
}

cl::Buffer PatchLight::arcs(const DiscPoints& points, std::size_t stride) const {
  std::vector<double> rows(discs_.size() * 3 * stride);
  for (std::size_t k = 0; k < discs_.size(); ++k) {
    const double radius = discs_[k].radius;
    double* const at = rows.data() + 3 * k * stride;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double p = points.radius[i];
      // At the centre one circle contains the other.
      const double unit_arc = p > 0 ? clipped_acos((1 + p * p - radius * radius) / (2 * p)) : radius >= 1 ? pi : 0;
      const double cosine = p > 0 ? (p * p + radius * radius - 1) / (2 * p * radius) : radius <= 1 ? -1 : 1;
      const double arc = clipped_acos(cosine);
      at[i] = unit_arc;
      at[stride + i] = arc;
      at[2 * stride + i] = std::abs(cosine) < 1 ? std::sqrt((1 - cosine) * (1 + cosine)) : 0;
    }
  }
  return constant_buffer(device_, std::span<const double>(rows));
}

std::size_t PatchLight::stride_of(std::size_t points) const {
  const std::size_t width = device_.implementation().pack_width;
  return (points + width - 1) / width * width;
}

void PatchLight::place(const DiscPoints& p, const DiscPoints& q) {
  checked("cannot prepare patch lights", [&] {
    stride_ = stride_of(p.size());
    columns_ = q.size();
    p_ = coordinates(p, stride_);
    p_arcs_ = arcs(p, stride_);
    q_ = coordinates(q, columns_);
    q_arcs_ = arcs(q, columns_);
  });
}

void PatchLight::tabulate(std::size_t first, std::size_t count, std::span<double> values) {
  if (first + count > columns_ || values.size() != count * stride_) {
    throw ArgumentError("PatchLight::tabulate: sizes do not fit");
  }
  if (values.empty()) return;
  checked("cannot tabulate patch lights", [&] {
    auto& implementation = device_.implementation();
    const cl::Buffer target(implementation.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, values.size_bytes(),
                            values.data());
    const FinishOnFailure finish(device_);
    const std::size_t width = implementation.pack_width;
    set_arguments(kernel_, p_, p_arcs_, static_cast<cl_uint>(stride_), q_, q_arcs_, static_cast<cl_uint>(columns_),
                  static_cast<cl_uint>(first), disc_buffer_, static_cast<cl_uint>(discs_.size()), target);
    implementation.queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(stride_ / width, count),
                                              implementation.work_group(2));
    // Mapping is what makes the host see what the device wrote.
    void* mapped = implementation.queue.enqueueMapBuffer(target, CL_TRUE, CL_MAP_READ, 0, values.size_bytes());
    implementation.queue.enqueueUnmapMemObject(target, mapped);
    implementation.queue.finish();
  });
}

}  // namespace lobe
