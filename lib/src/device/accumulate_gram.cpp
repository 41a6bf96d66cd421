#include "device/accumulate_gram.hpp"

#include <algorithm>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"
#include "device/sums.hpp"

namespace lobe {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

GramAccumulator::GramAccumulator(const LobeEvaluator& evaluator, std::size_t first_row, std::size_t rows)
    : GramAccumulator(evaluator.device(), evaluator.values(), first_row, rows) {}

GramAccumulator::GramAccumulator(const Device& device, const PackedRows& values, std::size_t first_row,
                                 std::size_t rows)
    : device_(device), values_(shared(values)), first_row_(first_row), rows_(rows) {
  checked("cannot prepare the Gram matrix", [&] {
    const bool scalar = values_.width == 1;
    const auto program = build_program(
        device_, {"prelude.clh", scalar ? "products/accumulate_gram_scalar.cl" : "products/accumulate_gram.cl"},
        Precision::double_precision);
    kernel_ = scalar ? make_kernel(program, "accumulate_gram_scalar", 8) : make_kernel(program, "accumulate_gram", 8);
    gram_ = zeros(device_, rows_ * values_.rows());
    require_sound(device_, "accumulate_gram.cl", [&] { return test_gram(device_); });
  });
}

void GramAccumulator::add(std::size_t nodes) {
  checked("cannot accumulate the Gram matrix", [&] {
    auto& queue = device_.implementation().queue;
    const std::size_t lobes = values_.rows();
    const auto argument = [](std::size_t value) { return static_cast<cl_uint>(value); };
    kernel_.setArg(0, values_.values);
    kernel_.setArg(1, argument(values_.stride));
    if (values_.width == 1) {
      constexpr std::size_t kGramTile = 16;
      kernel_.setArg(2, argument(nodes));
      kernel_.setArg(3, argument(first_row_));
      kernel_.setArg(4, argument(rows_));
      kernel_.setArg(5, argument(lobes));
      kernel_.setArg(6, gram_);
      kernel_.setArg(7, argument(lobes));
      const auto tiles = [&](std::size_t count) { return (count + kGramTile - 1) / kGramTile * kGramTile; };
      queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(tiles(lobes), tiles(rows_)),
                                 cl::NDRange(kGramTile, kGramTile));
      return;
    }
    constexpr std::size_t kNodesPerPass = 2048;  // packs of 128 KiB
    constexpr std::size_t kItemPacks = 6;        // ITEM_PACKS of accumulate_gram.cl
    kernel_.setArg(4, argument(first_row_ / 8));
    kernel_.setArg(5, argument(rows_ / 8));
    kernel_.setArg(6, gram_);
    kernel_.setArg(7, argument(lobes));
    for (std::size_t first = 0; first < nodes; first += kNodesPerPass) {
      kernel_.setArg(2, argument(first));
      kernel_.setArg(3, argument(std::min(kNodesPerPass, nodes - first)));
      queue.enqueueNDRangeKernel(kernel_, cl::NullRange,
                                 cl::NDRange(lobes / 24, round_up(rows_ / 8, kItemPacks) / kItemPacks),
                                 cl::NDRange(1, 1));
    }
  });
}

RowMajorMatrix GramAccumulator::take() {
  return checked("cannot read the Gram matrix", [&] {
    RowMajorMatrix gram(static_cast<Eigen::Index>(rows_), static_cast<Eigen::Index>(values_.rows()));
    read_and_clear(device_, gram_, gram.data(), static_cast<std::size_t>(gram.size()));
    return gram;
  });
}

}  // namespace lobe
