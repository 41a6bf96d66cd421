#include "device/accumulate_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"

namespace lobe {
namespace {

std::string name_of(NodeMap map) {
  switch (map) {
    case NodeMap::linear:
      return "map_linear";
    case NodeMap::log:
      return "map_log";
    case NodeMap::cube_root:
      return "map_cube_root";
    case NodeMap::cube_root_log:
      break;
  }
  return "map_cube_root_log";
}

std::string name_of(PairTerm term) {
  switch (term) {
    case PairTerm::square:
      return "add_square";
    case PairTerm::absolute:
      return "add_absolute";
    case PairTerm::two_thirds:
      break;
  }
  return "add_two_thirds";
}

/// term(k d) = factor term(d).
double root_of(PairTerm term, double factor) {
  switch (term) {
    case PairTerm::square:
      return std::sqrt(factor);
    case PairTerm::absolute:
      return factor;
    case PairTerm::two_thirds:
      break;
  }
  return factor * std::sqrt(factor);
}

std::size_t packs_of(std::size_t rows, std::size_t width) {
  return (rows + width - 1) / width;
}

}  // namespace

std::string pair_kernel_name(NodeMap map, PairTerm term) {
  return "accumulate_pairs.cl, " + name_of(map) + ", " + name_of(term);
}

PairAccumulator::PairAccumulator(const LobeEvaluator& evaluator,
                                 const std::vector<Eigen::SparseMatrix<double, Eigen::RowMajor>>& mix, NodeMap map,
                                 PairTerm term, std::size_t split)
    : evaluator_(evaluator),
      term_(term),
      channels_(mix.size()),
      rows_(static_cast<std::size_t>(mix.front().rows())),
      split_(split),
      left_packs_(packs_of(split, evaluator.width())),
      packs_(left_packs_ + packs_of(rows_ - split, evaluator.width())) {
  checked("cannot prepare the comparison of materials", [&] {
    const Device& device = evaluator_.device();
    const std::size_t padded = packs_ * evaluator_.width();
    std::vector<cl_uint> first{0};
    std::vector<cl_uint> places;
    std::vector<double> weights;
    // Rows before the split end with a whole pack.
    const std::size_t behind = left_packs_ * evaluator_.width();
    for (const auto& channel : mix) {
      for (std::size_t place = 0; place < padded; ++place) {
        const bool is_behind = place >= behind;
        const std::size_t row = is_behind ? place - behind + split_ : place;
        if (row < (is_behind ? rows_ : split_)) {
          for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(channel,
                                                                                 static_cast<Eigen::Index>(row));
               entry; ++entry) {
            const std::size_t lobe = evaluator_.rows()[static_cast<std::size_t>(entry.col())];
            const std::size_t width = evaluator_.width();
            places.push_back(static_cast<cl_uint>(lobe / width * evaluator_.node_stride() * width + lobe % width));
            weights.push_back(entry.value());
          }
        }
        first.push_back(static_cast<cl_uint>(places.size()));
      }
    }
    // All may be black; a buffer needs at least one element.
    places.push_back(0);
    weights.push_back(0);
    first_term_ = constant_buffer(device, std::span<const cl_uint>(first));
    term_place_ = constant_buffer(device, std::span<const cl_uint>(places));
    term_weight_ = constant_buffer(device, std::span<const double>(weights));

    map_kernel_ = make_kernel(build_program(device, {"prelude.clh", "products/map_materials.cl"},
                                            Precision::double_precision, "-D MAP=" + name_of(map)),
                              "map_materials", 10);
    pair_kernel_ = make_kernel(build_program(device, {"prelude.clh", "products/accumulate_pairs.cl"},
                                             Precision::double_precision, "-D DIFFERENCE=" + name_of(term)),
                               "accumulate_pairs", 9);
    const std::size_t stride = evaluator_.node_stride();
    scale_ = make_workspace(device, stride * sizeof(double));
    factor_ = make_workspace(device, stride * sizeof(double));
    mapped_ = make_workspace(device, channels_ * padded * stride * sizeof(double));
    const std::size_t sums = channels_ * sum_rows() * sum_columns() * evaluator_.width() * evaluator_.width();
    sums_ = make_workspace(device, sums * sizeof(double));
    clear(device, sums_, sums);
    require_sound(device, pair_kernel_name(map, term), [&] { return test_pairs(device, map, term); });
  });
}

void PairAccumulator::add(std::span<const double> scale, std::span<const double> weight) {
  if (scale.empty()) return;
  checked("cannot compare materials", [&] {
    constexpr std::size_t kNodesPerItem = 64;
    constexpr std::size_t kNodesPerPass = 1024;  // of two packs: 128 KiB
    auto& queue = evaluator_.device().implementation().queue;
    const auto argument = [](std::size_t value) { return static_cast<cl_uint>(value); };
    const std::size_t nodes = scale.size();
    queue.enqueueWriteBuffer(scale_, CL_TRUE, 0, nodes * sizeof(double), scale.data());
    std::vector<double> factor;
    for (const double value : weight) factor.push_back(root_of(term_, value));
    queue.enqueueWriteBuffer(factor_, CL_TRUE, 0, nodes * sizeof(double), factor.data());

    map_kernel_.setArg(0, evaluator_.values().values);
    map_kernel_.setArg(1, argument(evaluator_.node_stride()));
    map_kernel_.setArg(2, argument(nodes));
    map_kernel_.setArg(3, argument(kNodesPerItem));
    map_kernel_.setArg(4, first_term_);
    map_kernel_.setArg(5, term_place_);
    map_kernel_.setArg(6, term_weight_);
    map_kernel_.setArg(7, scale_);
    map_kernel_.setArg(8, factor_);
    map_kernel_.setArg(9, mapped_);
    queue.enqueueNDRangeKernel(map_kernel_, cl::NullRange,
                               cl::NDRange(channels_ * packs_, (nodes + kNodesPerItem - 1) / kNodesPerItem),
                               evaluator_.device().implementation().work_group(2));

    pair_kernel_.setArg(0, mapped_);
    pair_kernel_.setArg(1, argument(evaluator_.node_stride()));
    pair_kernel_.setArg(6, sums_);
    pair_kernel_.setArg(8, argument(sum_columns() * evaluator_.width()));
    for (std::size_t channel = 0; channel < channels_; ++channel) {
      pair_kernel_.setArg(4, argument(channel * packs_));
      pair_kernel_.setArg(5, argument(channel * packs_ + left_packs_));
      pair_kernel_.setArg(7, argument(channel * sum_rows()));
      for (std::size_t first = 0; first < nodes; first += kNodesPerPass) {
        pair_kernel_.setArg(2, argument(first));
        pair_kernel_.setArg(3, argument(std::min(kNodesPerPass, nodes - first)));
        queue.enqueueNDRangeKernel(pair_kernel_, cl::NullRange, cl::NDRange(sum_rows(), sum_columns()),
                                   evaluator_.device().implementation().work_group(2));
      }
    }
  });
}

std::vector<Eigen::MatrixXd> PairAccumulator::take() {
  return checked("cannot read the comparison of materials", [&] {
    using PaddedMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto padded = static_cast<Eigen::Index>(sum_rows() * evaluator_.width());
    const auto rows = static_cast<Eigen::Index>(is_split() ? split_ : rows_);
    const auto columns = static_cast<Eigen::Index>(rows_ - split_);
    PaddedMatrix all(static_cast<Eigen::Index>(channels_) * padded,
                     static_cast<Eigen::Index>(sum_columns() * evaluator_.width()));
    evaluator_.device().implementation().queue.enqueueReadBuffer(
        sums_, CL_TRUE, 0, static_cast<std::size_t>(all.size()) * sizeof(double), all.data());
    clear(evaluator_.device(), sums_, static_cast<std::size_t>(all.size()));
    std::vector<Eigen::MatrixXd> result;
    for (std::size_t channel = 0; channel < channels_; ++channel) {
      const Eigen::MatrixXd sums = all.block(static_cast<Eigen::Index>(channel) * padded, 0, rows, columns);
      result.emplace_back(is_split() ? sums : Eigen::MatrixXd(sums.selfadjointView<Eigen::Upper>()));
    }
    return result;
  });
}

}  // namespace lobe
