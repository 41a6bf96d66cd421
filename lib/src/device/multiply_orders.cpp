#include "device/multiply_orders.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "device/buffers.hpp"
#include "device/program.hpp"

namespace lobe {
namespace {

static_assert(sizeof(CosinePlan::Strip) == 4 * sizeof(cl_uint), "laid out as in kernels/products/isotropic.clh");

std::size_t divided_up(std::size_t count, std::size_t size) {
  return (count + size - 1) / size;
}

std::size_t rounded_up(std::size_t count, std::size_t size) {
  return divided_up(count, size) * size;
}

template <typename Value>
std::size_t bytes_of(const std::vector<Value>& values) {
  return values.size() * sizeof(Value);
}

std::size_t reported_vector_bytes(const Device& device) {
  const auto lanes = device.implementation().device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_DOUBLE>();
  return lanes >= 8 ? 64 : 32;
}

/// Whole strips to each block, as many as `capacity` orders hold, but at least one.
std::vector<OrderRange> make_blocks(const CosinePlan& plan, std::size_t capacity) {
  std::vector<OrderRange> blocks;
  for (std::size_t strip = 0; strip < plan.forward.strips.size(); ++strip) {
    const std::size_t first = plan.forward.strips[strip].output;
    const std::size_t end = plan.end_order(strip);
    if (blocks.empty() || end - blocks.back().first > capacity) blocks.push_back({first, first});
    blocks.back().end = end;
  }
  return blocks;
}

cl::NDRange items(std::size_t x, std::size_t y) {
  return {x, y};
}

}  // namespace

IsotropicPacks::Layout::Layout(const Device& device, const IsotropicShape& wanted, Precision wanted_precision,
                               const IsotropicLimits& limits)
    : shape(wanted),
      precision(wanted_precision),
      plan(make_cosine_plan(wanted.azimuths)),
      number_bytes(precision == Precision::double_precision ? sizeof(double) : sizeof(float)),
      vector_bytes(limits.vector_bytes != 0 ? limits.vector_bytes : reported_vector_bytes(device)),
      panel_bytes(2 * vector_bytes) {
  const std::size_t panel = panel_bytes / number_bytes;
  const std::size_t tile_rows = vector_bytes == 64 ? 8 : 6;  // TILE_ROWS of kernels/products/multiply_orders.cl
  padded_rows = rounded_up(shape.rows, tile_rows);
  padded_inner = rounded_up(shape.inner, tile_rows);
  inner_panels = divided_up(shape.inner, panel);
  column_panels = divided_up(shape.columns, panel);
  // One row more per order: at a power of two of bytes, all orders of a panel would compete for one set of the cache.
  workspace.left = (inner_panels * padded_rows + 1) * panel_bytes;
  workspace.right = (column_panels * padded_inner + 1) * panel_bytes;
  workspace.product = (column_panels * padded_rows + 1) * panel_bytes;
  workspace.fixed = bytes_of(plan.forward.strips) + bytes_of(plan.inverse.strips) +
                    (plan.forward.coefficients.size() + plan.inverse.coefficients.size()) * number_bytes +
                    inner_panels * panel_bytes;
  blocks = make_blocks(plan, workspace.orders_within(limits.workspace_bytes, device.info().largest_buffer_bytes));
  for (const auto& block : blocks) orders = std::max(orders, block.count());
}

std::uint64_t IsotropicPacks::Layout::local_bytes() const {
  return (plan.points + orders + CosinePlan::kStrip) * panel_bytes;
}

IsotropicPacks::Direction::Direction(const Device& device, const CosinePlan::Direction& direction, Precision precision)
    : count(direction.strips.size()),
      strips(constant_buffer(device, std::span(direction.strips))),
      coefficients(constant_numbers(device, direction.coefficients, precision)) {}

IsotropicPacks::IsotropicPacks(const Device& device, Layout layout)
    : device_(device),
      layout_(std::move(layout)),
      forward_(device, layout_.plan.forward, layout_.precision),
      inverse_(device, layout_.plan.inverse, layout_.precision),
      scale_(make_buffer(device, layout_.inner_panels * layout_.panel_bytes)),
      left_(make_workspace(device, layout_.orders * layout_.workspace.left)),
      right_(make_workspace(device, layout_.orders * layout_.workspace.right)),
      product_(make_workspace(device, layout_.orders * layout_.workspace.product)) {
  const auto kernel = [&](const char* file, const char* name, unsigned arguments) {
    return make_kernel(build_program(device, {"prelude.clh", "products/isotropic.clh", file}, layout_.precision,
                                     "-D VECTOR_BYTES=" + std::to_string(layout_.vector_bytes)),
                       name, arguments);
  };
  transform_ = kernel("products/transform_isotropic.cl", "transform_isotropic", 18);
  multiply_ = kernel("products/multiply_orders.cl", "multiply_orders", 9);
  restore_ = kernel("products/restore_isotropic.cl", "restore_isotropic", 15);
}

void IsotropicPacks::set_scale(std::span<const double> scale) {
  auto& queue = device_.implementation().queue;
  const auto write = [&]<typename Number>(Number zero) {
    std::vector<Number> padded(layout_.inner_panels * layout_.panel_bytes / sizeof(Number), zero);
    std::transform(scale.begin(), scale.end(), padded.begin(), [](double s) { return static_cast<Number>(s); });
    queue.enqueueWriteBuffer(scale_, CL_TRUE, 0, bytes_of(padded), padded.data());
  };
  layout_.precision == Precision::double_precision ? write(0.0) : write(0.0F);
}

void IsotropicPacks::transform(OrderRange orders, const cl::Buffer& table, Sides sides) {
  const bool is_right = sides == Sides::right;
  const std::size_t rows = is_right ? layout_.shape.inner : layout_.shape.rows;
  const std::size_t columns = is_right ? layout_.shape.columns : layout_.shape.inner;
  const std::size_t stride = is_right ? layout_.workspace.right : layout_.workspace.left;
  const auto& strips = layout_.plan.forward.strips;
  const auto strip_of = [&](std::size_t order) {
    const auto found = std::find_if(strips.begin(), strips.end(), [&](const auto& s) { return s.output >= order; });
    return uint_of(static_cast<std::size_t>(found - strips.begin()));
  };
  set_arguments(transform_, table, uint_of(rows), uint_of(columns), uint_of(layout_.plan.points),
                uint_of(layout_.plan.levels), forward_.strips, strip_of(orders.first), strip_of(orders.end),
                uint_of(orders.first), uint_of(orders.end), forward_.coefficients, scale_, static_cast<cl_uint>(sides),
                left_, right_, static_cast<cl_ulong>(stride / layout_.number_bytes),
                cl::Local(layout_.plan.points * layout_.panel_bytes),
                cl::Local(CosinePlan::kStrip * layout_.panel_bytes));
  const std::size_t panels = is_right ? layout_.column_panels : layout_.inner_panels;
  const std::size_t padded = is_right ? layout_.padded_inner : layout_.padded_rows;
  device_.implementation().queue.enqueueNDRangeKernel(transform_, cl::NullRange, items(panels, padded), items(1, 1));
}

void IsotropicPacks::multiply(OrderRange orders) {
  const auto numbers = [&](std::size_t bytes) { return static_cast<cl_ulong>(bytes / layout_.number_bytes); };
  set_arguments(multiply_, left_, right_, product_, uint_of(layout_.padded_rows), uint_of(layout_.shape.inner),
                uint_of(layout_.padded_inner), numbers(layout_.workspace.left), numbers(layout_.workspace.right),
                numbers(layout_.workspace.product));
  device_.implementation().queue.enqueueNDRangeKernel(multiply_, cl::NullRange,
                                                      items(layout_.column_panels, orders.count()), items(1, 1));
}

void IsotropicPacks::restore(OrderRange orders, const cl::Buffer& table, bool accumulate) {
  set_arguments(restore_, product_, uint_of(layout_.padded_rows),
                static_cast<cl_ulong>(layout_.workspace.product / layout_.number_bytes), uint_of(orders.first),
                uint_of(orders.end), inverse_.strips, uint_of(inverse_.count), inverse_.coefficients,
                uint_of(layout_.plan.levels), static_cast<cl_uint>(accumulate), table, uint_of(layout_.shape.columns),
                uint_of(layout_.plan.points), cl::Local(orders.count() * layout_.panel_bytes),
                cl::Local((layout_.plan.points + CosinePlan::kStrip) * layout_.panel_bytes));
  device_.implementation().queue.enqueueNDRangeKernel(restore_, cl::NullRange,
                                                      items(layout_.column_panels, layout_.shape.rows), items(1, 1));
}

}  // namespace lobe
