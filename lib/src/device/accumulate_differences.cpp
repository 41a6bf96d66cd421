#include "device/accumulate_differences.hpp"

#include <span>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"
#include "device/sums.hpp"

namespace lobe {

DifferenceAccumulator::DifferenceAccumulator(const LobeEvaluator& evaluator,
                                             const std::vector<Combination>& combinations)
    : DifferenceAccumulator(evaluator.device(), evaluator.values(), combinations) {}

DifferenceAccumulator::DifferenceAccumulator(const Device& device, const PackedRows& values,
                                             const std::vector<Combination>& combinations)
    : device_(device), values_(shared(values)), count_(combinations.size()) {
  checked("cannot prepare differences of materials", [&] {
    std::vector<cl_uint> first{0};
    std::vector<cl_uint> lobes;
    std::vector<double> weights;
    for (const auto& combination : combinations) {
      for (const auto& [row, weight] : combination.terms) {
        lobes.push_back(static_cast<cl_uint>(row));
        weights.push_back(weight);
      }
      first.push_back(static_cast<cl_uint>(lobes.size()));
    }
    // Identical materials have no terms at all; a buffer needs at least one element.
    lobes.push_back(0);
    weights.push_back(0);
    const auto program =
        build_program(device_, {"prelude.clh", "products/accumulate_differences.cl"}, Precision::double_precision);
    kernel_ = make_kernel(program, "accumulate_differences", 7);
    first_term_ = constant_buffer(device_, std::span<const cl_uint>(first));
    term_lobe_ = constant_buffer(device_, std::span<const cl_uint>(lobes));
    term_weight_ = constant_buffer(device_, std::span<const double>(weights));
    sums_ = zeros(device_, count_);
    require_sound(device_, "accumulate_differences.cl", [&] { return test_differences(device_); });
  });
}

void DifferenceAccumulator::add(std::size_t nodes) {
  checked("cannot accumulate differences of materials", [&] {
    kernel_.setArg(0, values_.values);
    kernel_.setArg(1, static_cast<cl_uint>(values_.stride));
    kernel_.setArg(2, static_cast<cl_uint>(nodes));
    kernel_.setArg(3, first_term_);
    kernel_.setArg(4, term_lobe_);
    kernel_.setArg(5, term_weight_);
    kernel_.setArg(6, sums_);
    device_.implementation().queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(count_),
                                                        device_.implementation().work_group(1));
  });
}

std::vector<double> DifferenceAccumulator::take() {
  return checked("cannot read differences of materials", [&] {
    std::vector<double> sums(count_);
    read_and_clear(device_, sums_, sums.data(), sums.size());
    return sums;
  });
}

}  // namespace lobe
