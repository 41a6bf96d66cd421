#include "device/sum_segments.hpp"

#include <span>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"
#include "device/sums.hpp"

namespace lobe {

SegmentAccumulator::SegmentAccumulator(const LobeEvaluator& evaluator, std::size_t segments)
    : evaluator_(evaluator), segments_(segments) {
  checked("cannot prepare albedos", [&] {
    const auto program =
        build_program(evaluator.device(), {"prelude.clh", "products/sum_segments.cl"}, Precision::double_precision);
    kernel_ = make_kernel(program, "sum_segments", 6);
    sums_ = zeros(evaluator.device(), evaluator.padded_lobes() * segments_);
    require_sound(evaluator.device(), "sum_segments.cl", [&] { return test_segments(evaluator.device()); });
  });
}

void SegmentAccumulator::add(const std::vector<unsigned>& starts, std::size_t first_segment) {
  checked("cannot accumulate albedos", [&] {
    std::vector<cl_uint> limits(starts.begin(), starts.end());
    const cl::Buffer segment_start =
        constant_buffer(evaluator_.device(), std::span<const cl_uint>(limits));  // setArg keeps no reference
    kernel_.setArg(0, evaluator_.values().values);
    kernel_.setArg(1, static_cast<cl_uint>(evaluator_.node_stride()));
    kernel_.setArg(2, segment_start);
    kernel_.setArg(3, static_cast<cl_uint>(first_segment));
    kernel_.setArg(4, sums_);
    kernel_.setArg(5, static_cast<cl_uint>(segments_));
    evaluator_.device().implementation().queue.enqueueNDRangeKernel(kernel_, cl::NullRange,
                                                                    cl::NDRange(limits.size() - 1, evaluator_.packs()),
                                                                    evaluator_.device().implementation().work_group(2));
  });
}

Eigen::MatrixXd SegmentAccumulator::take() {
  return checked("cannot read albedos", [&] {
    const std::size_t width = evaluator_.width();
    std::vector<double> packed(evaluator_.padded_lobes() * segments_);
    read_and_clear(evaluator_.device(), sums_, packed.data(), packed.size());
    Eigen::MatrixXd sums(static_cast<Eigen::Index>(evaluator_.padded_lobes()), static_cast<Eigen::Index>(segments_));
    for (std::size_t lobe = 0; lobe < evaluator_.padded_lobes(); ++lobe) {
      for (std::size_t s = 0; s < segments_; ++s) {
        sums(static_cast<Eigen::Index>(lobe), static_cast<Eigen::Index>(s)) =
            packed[(lobe / width * segments_ + s) * width + lobe % width];
      }
    }
    return sums;
  });
}

}  // namespace lobe
