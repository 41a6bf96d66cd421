#include "device/sum_segments.hpp"

#include <span>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"
#include "device/sums.hpp"

namespace lobe {

SegmentAccumulator::SegmentAccumulator(const LobeEvaluator& sampler, std::size_t segments)
    : sampler_(sampler), segments_(segments) {
  checked("cannot prepare albedos", [&] {
    const auto program =
        build_program(sampler.device(), {"prelude.clh", "products/sum_segments.cl"}, Precision::double_precision);
    kernel_ = make_kernel(program, "sum_segments", 6);
    sums_ = zeros(sampler.device(), sampler.padded_lobes() * segments_);
    require_sound(sampler.device(), "sum_segments.cl", [&] { return test_segments(sampler.device()); });
  });
}

void SegmentAccumulator::add(const std::vector<unsigned>& starts, std::size_t first_segment) {
  checked("cannot accumulate albedos", [&] {
    std::vector<cl_uint> limits(starts.begin(), starts.end());
    const cl::Buffer segment_start =
        constant_buffer(sampler_.device(), std::span<const cl_uint>(limits));  // setArg keeps no reference
    kernel_.setArg(0, sampler_.samples().values);
    kernel_.setArg(1, static_cast<cl_uint>(sampler_.node_stride()));
    kernel_.setArg(2, segment_start);
    kernel_.setArg(3, static_cast<cl_uint>(first_segment));
    kernel_.setArg(4, sums_);
    kernel_.setArg(5, static_cast<cl_uint>(segments_));
    sampler_.device().implementation().queue.enqueueNDRangeKernel(kernel_, cl::NullRange,
                                                                  cl::NDRange(limits.size() - 1, sampler_.packs()),
                                                                  sampler_.device().implementation().work_group(2));
  });
}

Eigen::MatrixXd SegmentAccumulator::take() {
  return checked("cannot read albedos", [&] {
    const std::size_t width = sampler_.width();
    std::vector<double> packed(sampler_.padded_lobes() * segments_);
    read_and_clear(sampler_.device(), sums_, packed.data(), packed.size());
    Eigen::MatrixXd sums(static_cast<Eigen::Index>(sampler_.padded_lobes()), static_cast<Eigen::Index>(segments_));
    for (std::size_t lobe = 0; lobe < sampler_.padded_lobes(); ++lobe) {
      for (std::size_t s = 0; s < segments_; ++s) {
        sums(static_cast<Eigen::Index>(lobe), static_cast<Eigen::Index>(s)) =
            packed[(lobe / width * segments_ + s) * width + lobe % width];
      }
    }
    return sums;
  });
}

}  // namespace lobe
