#include "device/evaluate_lobes.hpp"

#include <algorithm>
#include <memory>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kPackAlignment = 3;  // accumulate_gram.cl reads columns in triples of packs

/// packs x numbers per lobe x width; lanes without a lobe repeat the last one with c0 = 0, so that they are zero.
std::vector<double> pack_numbers(const LobeBatch& batch, std::size_t packs, std::size_t width) {
  const std::size_t count = batch.numbers_per_lobe();
  std::vector<double> packed(packs * count * width);
  for (std::size_t lane = 0; lane < packs * width; ++lane) {
    const bool real_lobe = lane < batch.coefficients.size();
    const auto source = batch.numbers(std::min(lane, batch.coefficients.size() - 1));
    for (std::size_t k = 0; k < count; ++k) {
      packed[(lane / width * count + k) * width + lane % width] = k == 0 && !real_lobe ? 0.0 : source[k];
    }
  }
  return packed;
}

}  // namespace

LobeEvaluator::LobeEvaluator(const Device& device, const std::vector<LobeBatch>& batches, Precision precision,
                             std::size_t node_capacity)
    : device_(device), width_(device.implementation().pack_width), capacity_(node_capacity) {
  checked("cannot prepare the evaluation of models", [&] {
    auto& implementation = device_.implementation();
    for (const auto& batch : batches) {
      const std::size_t packs = round_up(batch.coefficients.size(), width_) / width_;
      const auto program = build_lobe_program(device_, batch.kernel, "lobes/evaluate_lobes.cl", precision);
      needs_tangents_ = needs_tangents_ || batch.kernel.is_anisotropic;
      auto coefficients = pack_numbers(batch, packs, width_);
      models_.push_back({make_kernel(program, "evaluate_lobes", 8),
                         cl::Buffer(implementation.context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                                    coefficients.size() * sizeof(double), coefficients.data()),
                         packs, packs_});
      require_sound_model(device_, batch.kernel, "evaluate_lobes.cl", precision);
      for (std::size_t i = 0; i < batch.coefficients.size(); ++i) rows_.push_back(packs_ * width_ + i);
      packs_ += packs;
    }
    packs_ = round_up(packs_, kPackAlignment);
    const std::size_t geometry_rows = NodeBlock::kRows + (needs_tangents_ ? NodeBlock::kTangentRows : 0);
    geometry_ = cl::Buffer(implementation.context, CL_MEM_READ_ONLY, geometry_rows * capacity_ * sizeof(double));
    values_ = cl::Buffer(implementation.context, CL_MEM_READ_WRITE, packs_ * width_ * capacity_ * sizeof(double));
  });
}

void LobeEvaluator::evaluate(const NodeBlock& nodes) {
  if (!has_zeros_) {
    // The padding stays zero. Where values are only read nobody sees it, and to clear it takes longer than a block.
    checked("cannot prepare the evaluation of models", [&] {
      const std::vector<double> zeros(packs_ * width_ * capacity_);
      device_.implementation().queue.enqueueWriteBuffer(values_, CL_TRUE, 0, zeros.size() * sizeof(double),
                                                        zeros.data());
    });
    has_zeros_ = true;
  }
  launch(nodes, CL_TRUE);
}

std::size_t LobeEvaluator::suggested_capacity(std::size_t lobes) {
  // Large enough to make launches cheap beside the work, small enough for the last-level cache.
  constexpr std::size_t kSampleBytes = std::size_t{24} << 20;
  return std::clamp<std::size_t>(kSampleBytes / (sizeof(double) * std::max<std::size_t>(lobes, 1)) / 64 * 64, 512,
                                 8192);
}

void LobeEvaluator::launch(const NodeBlock& nodes, cl_bool waits) {
  if (nodes.capacity() != capacity_) throw DeviceError("node block and evaluator differ in capacity");
  if (nodes.has_tangents() != needs_tangents_) {
    throw DeviceError("anisotropic lobes at nodes without azimuths, or the other way round");
  }
  if (nodes.size() == 0) return;
  checked("cannot evaluate models", [&] {
    auto& implementation = device_.implementation();
    implementation.queue.enqueueWriteBuffer(geometry_, waits, 0, nodes.data().size_bytes(), nodes.data().data());
    // A scalar pack's lanes are the work-items of a group; a wide pack has its lanes in the item.
    const std::size_t nodes_per_item = width_ == 1 ? 1 : 32;
    const std::size_t group = width_ == 1 ? 64 : 1;
    const std::size_t items = round_up(round_up(nodes.size(), nodes_per_item) / nodes_per_item, group);
    for (auto& model : models_) {
      model.kernel.setArg(0, geometry_);
      model.kernel.setArg(1, static_cast<cl_uint>(capacity_));
      model.kernel.setArg(2, static_cast<cl_uint>(nodes.size()));
      model.kernel.setArg(3, static_cast<cl_uint>(nodes_per_item));
      model.kernel.setArg(4, model.coefficients);
      model.kernel.setArg(5, static_cast<cl_uint>(model.packs));
      model.kernel.setArg(6, static_cast<cl_uint>(model.first_pack));
      model.kernel.setArg(7, values_);
      implementation.queue.enqueueNDRangeKernel(model.kernel, cl::NullRange, cl::NDRange(items), cl::NDRange(group));
    }
  });
}

Eigen::MatrixXd read_values(const LobeEvaluator& evaluator, std::size_t nodes) {
  return checked("cannot read values", [&] {
    const std::size_t width = evaluator.width();
    const auto& rows = evaluator.rows();
    Eigen::MatrixXd values(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(nodes));
    if (nodes == 0) return values;
    // Padding is neither read nor cleared: it is most of the buffer where lobes are few.
    const auto packed = std::make_unique_for_overwrite<double[]>(width * nodes);
    for (std::size_t lobe = 0; lobe < rows.size(); ++lobe) {
      const std::size_t pack = rows[lobe] / width;
      if (lobe == 0 || pack != rows[lobe - 1] / width) {
        evaluator.device().implementation().queue.enqueueReadBuffer(
            evaluator.values().values, CL_TRUE, pack * evaluator.node_stride() * width * sizeof(double),
            width * nodes * sizeof(double), packed.get());
      }
      for (std::size_t node = 0; node < nodes; ++node) {
        values(static_cast<Eigen::Index>(lobe), static_cast<Eigen::Index>(node)) =
            packed[node * width + rows[lobe] % width];
      }
    }
    return values;
  });
}

Eigen::MatrixXd values_at(LobeEvaluator& evaluator, const NodeBlock& nodes) {
  // One wait, for the values: a second one, for the nodes, costs as much as evaluating thousands.
  const FinishOnFailure finish(evaluator.device());
  evaluator.launch(nodes, CL_FALSE);
  return read_values(evaluator, nodes.size());
}

void finish(const Device& device) {
  checked("cannot finish the work on the device", [&] { device.implementation().queue.finish(); });
}

}  // namespace lobe
