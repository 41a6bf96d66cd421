#include "device/accumulators.hpp"

#include <algorithm>
#include <utility>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"

namespace lobe {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

cl::Buffer zeros(const Device& device, std::size_t count) {
  cl::Buffer buffer(device.implementation().context, CL_MEM_READ_WRITE, count * sizeof(double));
  clear(device, buffer, count);
  return buffer;
}

PackedRows shared(const PackedRows& samples) {
  return checked("cannot share samples", [&] { return samples; });
}

/// Reads a buffer of sums and sets it to zero.
void read_and_clear(const Device& device, const cl::Buffer& buffer, double* target, std::size_t count) {
  auto& queue = device.implementation().queue;
  queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(double), target);
  clear(device, buffer, count);
}

}  // namespace

GramAccumulator::GramAccumulator(const Sampler& sampler, std::size_t first_row, std::size_t rows)
    : GramAccumulator(sampler.device(), sampler.samples(), first_row, rows) {}

GramAccumulator::GramAccumulator(const Device& device, const PackedRows& samples, std::size_t first_row,
                                 std::size_t rows)
    : device_(device), samples_(shared(samples)), first_row_(first_row), rows_(rows) {
  checked("cannot prepare the Gram matrix", [&] {
    const bool scalar = samples_.width == 1;
    const auto program =
        build_program(device_, {"prelude.clh", scalar ? "accumulate_gram_scalar.cl" : "accumulate_gram.cl"},
                      Precision::double_precision);
    kernel_ = scalar ? make_kernel(program, "accumulate_gram_scalar", 8) : make_kernel(program, "accumulate_gram", 7);
    gram_ = zeros(device_, rows_ * samples_.rows());
    require_sound(device_, "accumulate_gram.cl", [&] { return test_gram(device_); });
  });
}

void GramAccumulator::add(std::size_t nodes) {
  checked("cannot accumulate the Gram matrix", [&] {
    auto& queue = device_.implementation().queue;
    const std::size_t lobes = samples_.rows();
    const auto argument = [](std::size_t value) { return static_cast<cl_uint>(value); };
    kernel_.setArg(0, samples_.values);
    kernel_.setArg(1, argument(samples_.stride));
    if (samples_.width == 1) {
      constexpr std::size_t kTile = 16;
      kernel_.setArg(2, argument(nodes));
      kernel_.setArg(3, argument(first_row_));
      kernel_.setArg(4, argument(rows_));
      kernel_.setArg(5, argument(lobes));
      kernel_.setArg(6, gram_);
      kernel_.setArg(7, argument(lobes));
      const auto tiles = [&](std::size_t count) { return (count + kTile - 1) / kTile * kTile; };
      queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(tiles(lobes), tiles(rows_)),
                                 cl::NDRange(kTile, kTile));
      return;
    }
    constexpr std::size_t kNodesPerPass = 2048;  // three packs of 128 KiB
    kernel_.setArg(4, argument(first_row_ / 8));
    kernel_.setArg(5, gram_);
    kernel_.setArg(6, argument(lobes));
    for (std::size_t first = 0; first < nodes; first += kNodesPerPass) {
      kernel_.setArg(2, argument(first));
      kernel_.setArg(3, argument(std::min(kNodesPerPass, nodes - first)));
      queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(rows_ / 8, lobes / 24), cl::NDRange(1, 1));
    }
  });
}

RowMajorMatrix GramAccumulator::take() {
  return checked("cannot read the Gram matrix", [&] {
    RowMajorMatrix gram(static_cast<Eigen::Index>(rows_), static_cast<Eigen::Index>(samples_.rows()));
    read_and_clear(device_, gram_, gram.data(), static_cast<std::size_t>(gram.size()));
    return gram;
  });
}

Eigen::MatrixXd read_samples(const Sampler& sampler, std::size_t nodes) {
  return checked("cannot read samples", [&] {
    const std::size_t width = sampler.width();
    std::vector<double> packed(sampler.padded_lobes() * sampler.node_stride());
    sampler.device().implementation().queue.enqueueReadBuffer(sampler.samples().values, CL_TRUE, 0,
                                                              packed.size() * sizeof(double), packed.data());
    const auto& rows = sampler.rows();
    Eigen::MatrixXd samples(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(nodes));
    for (std::size_t lobe = 0; lobe < rows.size(); ++lobe) {
      const std::size_t pack = rows[lobe] / width;
      for (std::size_t node = 0; node < nodes; ++node) {
        samples(static_cast<Eigen::Index>(lobe), static_cast<Eigen::Index>(node)) =
            packed[(pack * sampler.node_stride() + node) * width + rows[lobe] % width];
      }
    }
    return samples;
  });
}

void finish(const Device& device) {
  checked("cannot finish the work on the device", [&] { device.implementation().queue.finish(); });
}

DifferenceAccumulator::DifferenceAccumulator(const Sampler& sampler, const std::vector<Combination>& combinations)
    : DifferenceAccumulator(sampler.device(), sampler.samples(), combinations) {}

DifferenceAccumulator::DifferenceAccumulator(const Device& device, const PackedRows& samples,
                                             const std::vector<Combination>& combinations)
    : device_(device), samples_(shared(samples)), count_(combinations.size()) {
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
        build_program(device_, {"prelude.clh", "accumulate_differences.cl"}, Precision::double_precision);
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
    kernel_.setArg(0, samples_.values);
    kernel_.setArg(1, static_cast<cl_uint>(samples_.stride));
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

SegmentAccumulator::SegmentAccumulator(const Sampler& sampler, std::size_t segments)
    : sampler_(sampler), segments_(segments) {
  checked("cannot prepare albedos", [&] {
    const auto program =
        build_program(sampler.device(), {"prelude.clh", "sum_segments.cl"}, Precision::double_precision);
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
