#include "device/draw_each.hpp"

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"

namespace lobe {

std::size_t DrawOrders::add_density(std::span<const ProposalPart> parts) {
  rows_.add(parts);
  ends_.push_back(uint_of(rows_.size()));
  return ends_.size() - 1;
}

void DrawOrders::add(const UnitVector& light, std::size_t density, std::uint64_t number) {
  lights_.push_back(light);
  densities_.push_back(uint_of(density));
  numbers_.push_back(number);
}

void DrawOrders::clear() {
  *this = {};
}

EachDrawer::EachDrawer(const Device& device) : device_(device) {
  checked("cannot prepare the drawing of directions", [&] {
    kernel_ = make_kernel(
        build_program(device_, {"sampling/proposal.clh", "sampling/draw_each.cl"}, Precision::double_precision),
        "draw_each", 9);
    require_sound(device_, "draw_each.cl", [&] { return test_drawing_each(device_); });
  });
}

std::vector<DrawnDirection> EachDrawer::draw(const DrawOrders& orders, std::uint64_t seed) {
  constexpr std::size_t kRows = 5;
  const std::size_t count = orders.size();
  std::vector<DrawnDirection> result;
  if (count == 0) return result;
  std::vector<double> lights(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) lights[k * count + i] = orders.lights_[i][k];
  }
  std::vector<double> drawn(kRows * count);
  checked("cannot draw directions", [&] {
    const FinishOnFailure finish(device_);
    auto& queue = device_.implementation().queue;
    const cl::Buffer light_buffer = constant_buffer(device_, lights);
    const cl::Buffer densities = constant_buffer(device_, orders.densities_);
    const cl::Buffer parts = constant_buffer(device_, orders.rows_.parts());
    const cl::Buffer ends = constant_buffer(device_, orders.ends_);
    const cl::Buffer tables = constant_buffer(device_, orders.rows_.tables());
    const cl::Buffer numbers = constant_buffer(device_, orders.numbers_);
    const cl::Buffer drawn_buffer = make_workspace(device_, drawn.size() * sizeof(double));
    set_arguments(kernel_, light_buffer, densities, parts, ends, tables, static_cast<cl_ulong>(seed), numbers,
                  uint_of(count), drawn_buffer);
    constexpr std::size_t kGroup = 64;
    queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(round_up(count, kGroup)),
                               device_.implementation().work_group(1));
    queue.enqueueReadBuffer(drawn_buffer, CL_TRUE, 0, drawn.size() * sizeof(double), drawn.data());
  });
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = [&](std::size_t k) { return drawn[k * count + i]; };
    result.push_back({{row(0), row(1), row(2)}, row(3), static_cast<std::size_t>(row(4))});
  }
  return result;
}

}  // namespace lobe
