#include "device/multiply_strided.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "device/buffers.hpp"
#include "device/cosine_plan.hpp"
#include "device/program.hpp"

namespace lobe {
namespace {

constexpr std::size_t kTile = 16;  // work-items of a group along either axis in kernels/products/multiply_strided.cl

/// The whole matrix of a transform, [order][point]: cosines times `factor`, ends of the summed index once and the rest
/// twice.
std::vector<double> cosine_matrix(std::size_t points, double factor, bool sum_over_orders) {
  const std::size_t half = points - 1;
  std::vector<double> matrix;
  for (std::size_t m = 0; m < points; ++m) {
    for (std::size_t k = 0; k < points; ++k) {
      const std::size_t summed = sum_over_orders ? m : k;
      const double weight = summed == 0 || summed == half ? 1 : 2;
      matrix.push_back(weight * factor * cosine_of(m, k, half));
    }
  }
  return matrix;
}

std::size_t rounded_up(std::size_t count) {
  return (count + kTile - 1) / kTile * kTile;
}

}  // namespace

IsotropicScalars::Layout::Layout(const Device& device, const IsotropicShape& wanted, Precision wanted_precision,
                                 const IsotropicLimits& limits)
    : shape(wanted), precision(wanted_precision) {
  const std::size_t points = shape.points();
  workspace.left = shape.rows * shape.inner * sizeof(double);
  workspace.right = shape.inner * shape.columns * sizeof(double);
  workspace.product = shape.rows * shape.columns * sizeof(double);
  workspace.fixed = (2 * points * points + shape.inner + 1) * sizeof(double);
  orders = std::clamp<std::size_t>(workspace.orders_within(limits.workspace_bytes, device.info().largest_buffer_bytes),
                                   1, points);
  for (std::size_t first = 0; first < points; first += orders) {
    blocks.push_back({first, std::min(first + orders, points)});
  }
}

IsotropicScalars::IsotropicScalars(const Device& device, Layout layout)
    : device_(device),
      layout_(std::move(layout)),
      forward_(constant_buffer(
          device, cosine_matrix(layout_.shape.points(),
                                2 * std::numbers::pi / static_cast<double>(layout_.shape.azimuths), false))),
      inverse_(constant_buffer(device, cosine_matrix(layout_.shape.points(), 1 / (2 * std::numbers::pi), true))),
      one_(constant_buffer(device, std::vector{1.0})),
      scale_(make_buffer(device, layout_.shape.inner * sizeof(double))),
      left_(make_workspace(device, layout_.orders * layout_.workspace.left)),
      right_(make_workspace(device, layout_.orders * layout_.workspace.right)),
      product_(make_workspace(device, layout_.orders * layout_.workspace.product)),
      kernel_(make_kernel(build_program(device, {"prelude.clh", "products/multiply_strided.cl"}, layout_.precision),
                          "multiply_strided", 12)) {}

void IsotropicScalars::set_scale(std::span<const double> scale) {
  device_.implementation().queue.enqueueWriteBuffer(scale_, CL_TRUE, 0, scale.size_bytes(), scale.data());
}

// One product per row of the table: [order][column] = [order][point] [point][column].
void IsotropicScalars::transform(OrderRange orders, const cl::Buffer& table, Sides sides) {
  const auto& shape = layout_.shape;
  const std::size_t points = shape.points();
  const auto side = [&](std::size_t rows, std::size_t columns, const cl::Buffer& out, const Strides& scale_strides) {
    launch({rows, orders.count(), points, columns}, {forward_, {orders.first * points, 0, points, 1}},
           {table, {0, columns * points, 1, points}}, {scale_, scale_strides}, {out, {0, columns, rows * columns, 1}},
           false);
  };
  if (sides != Sides::right) side(shape.rows, shape.inner, left_, {0, 0, 0, 1});
  if (sides != Sides::left) side(shape.inner, shape.columns, right_, {0, 1, 0, 0});
}

void IsotropicScalars::multiply(OrderRange orders) {
  const auto& shape = layout_.shape;
  launch({orders.count(), shape.rows, shape.inner, shape.columns},
         {left_, {0, shape.rows * shape.inner, shape.inner, 1}},
         {right_, {0, shape.inner * shape.columns, shape.columns, 1}}, {one_, {0, 0, 0, 0}},
         {product_, {0, shape.rows * shape.columns, shape.columns, 1}}, false);
}

// One product per row of the table: [column][point] = [column][order] [order][point].
void IsotropicScalars::restore(OrderRange orders, const cl::Buffer& table, bool accumulate) {
  const auto& shape = layout_.shape;
  const std::size_t points = shape.points();
  launch({shape.rows, shape.columns, orders.count(), points},
         {product_, {0, shape.columns, 1, shape.rows * shape.columns}},
         {inverse_, {orders.first * points, 0, points, 1}}, {one_, {0, 0, 0, 0}},
         {table, {0, shape.columns * points, points, 1}}, accumulate);
}

void IsotropicScalars::launch(const Sizes& sizes, const Matrices& a, const Matrices& b, const Matrices& factor,
                              const Matrices& out, bool accumulate) {
  set_arguments(kernel_, uint_of(sizes.rows), uint_of(sizes.inner), uint_of(sizes.columns), a.buffer, a.strides,
                b.buffer, b.strides, factor.buffer, factor.strides, static_cast<cl_uint>(accumulate), out.buffer,
                out.strides);
  device_.implementation().queue.enqueueNDRangeKernel(
      kernel_, cl::NullRange, cl::NDRange(rounded_up(sizes.columns), rounded_up(sizes.rows), sizes.batches),
      cl::NDRange(kTile, kTile, 1));
}

}  // namespace lobe
