#include "device/draw_directions.hpp"

#include <algorithm>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/proposal_rows.hpp"
#include "device/self_test.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

/// The lobes of one batch as the kernel takes them: their numbers and their mix.
std::vector<double> lobe_rows(const LobeBatch& batch, std::size_t index, std::span<const MixedLobe> lobes) {
  std::vector<double> rows;
  for (const auto& lobe : lobes) {
    if (lobe.batch != index) continue;
    const auto numbers = batch.numbers(lobe.lobe);
    rows.insert(rows.end(), numbers.begin(), numbers.end());
    rows.insert(rows.end(), lobe.mix.begin(), lobe.mix.end());
  }
  return rows;
}

}  // namespace

DirectionSampler::DirectionSampler(const Device& device, const UnitVector& light, std::span<const ProposalPart> parts,
                                   const std::vector<LobeBatch>& batches, std::span<const MixedLobe> lobes,
                                   std::size_t channels, Precision precision, std::size_t capacity)
    : device_(device),
      light_(light),
      part_count_(parts.size()),
      channels_(channels),
      capacity_(round_up(std::max<std::size_t>(capacity, 1), device.implementation().pack_width)),
      drawn_(kRows * capacity_),
      weights_(channels * capacity_) {
  checked("cannot prepare the drawing of directions", [&] {
    ProposalRows proposal;
    proposal.add(parts);
    parts_ = constant_buffer(device_, proposal.parts());
    tables_ = constant_buffer(device_, proposal.tables());
    // Proposals are in double precision whatever the models are.
    draw_ = make_kernel(
        build_program(device_, {"sampling/proposal.clh", "sampling/draw_directions.cl"}, Precision::double_precision),
        "draw_directions", 10);
    require_sound(device_, "draw_directions.cl", [&] { return test_drawing(device_); });
    for (std::size_t b = 0; b < batches.size(); ++b) {
      const auto rows = lobe_rows(batches[b], b, lobes);
      if (rows.empty()) continue;
      const auto program = build_lobe_program(device_, batches[b].kernel, "sampling/weigh_directions.cl", precision,
                                              "lobes/pair_geometry.clh");
      models_.push_back({make_kernel(program, "weigh_directions", 9), constant_buffer(device_, rows),
                         rows.size() / (batches[b].numbers_per_lobe() + channels)});
      require_sound_model(device_, batches[b].kernel, "weigh_directions.cl", precision);
    }
    drawn_buffer_ = make_workspace(device_, drawn_.size() * sizeof(double));
    weight_buffer_ = make_workspace(device_, weights_.size() * sizeof(double));
  });
}

void DirectionSampler::launch(cl::Kernel& kernel) {
  const std::size_t width = device_.implementation().pack_width;
  const std::size_t group = width == 1 ? 64 : 1;
  const std::size_t items = round_up(capacity_ / width, group);
  device_.implementation().queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(items),
                                                      device_.implementation().work_group(1));
}

void DirectionSampler::draw(std::uint64_t seed, std::uint64_t first, std::size_t count) {
  if (count > capacity_) throw DeviceError("more directions than the sampler has room for");
  checked("cannot draw directions", [&] {
    const FinishOnFailure finish(device_);
    auto& queue = device_.implementation().queue;
    set_arguments(draw_, light_[0], light_[1], light_[2], parts_, static_cast<cl_uint>(part_count_), tables_,
                  static_cast<cl_ulong>(seed), static_cast<cl_ulong>(first), static_cast<cl_uint>(capacity_),
                  drawn_buffer_);
    launch(draw_);
    if (!models_.empty()) {
      std::ranges::fill(weights_, 0.0);
      queue.enqueueWriteBuffer(weight_buffer_, CL_FALSE, 0, weights_.size() * sizeof(double), weights_.data());
    }
    for (auto& model : models_) {
      set_arguments(model.kernel, light_[0], light_[1], light_[2], model.numbers, static_cast<cl_uint>(model.lobes),
                    static_cast<cl_uint>(channels_), static_cast<cl_uint>(capacity_), drawn_buffer_, weight_buffer_);
      launch(model.kernel);
    }
    queue.enqueueReadBuffer(drawn_buffer_, CL_FALSE, 0, drawn_.size() * sizeof(double), drawn_.data());
    if (!models_.empty()) {
      queue.enqueueReadBuffer(weight_buffer_, CL_FALSE, 0, weights_.size() * sizeof(double), weights_.data());
    }
    queue.finish();
  });
}

void DirectionSampler::find_densities(std::span<const UnitVector> directions, std::span<double> densities) {
  if (directions.size() > capacity_ || directions.size() != densities.size()) {
    throw DeviceError("more directions than the sampler has room for, or fewer densities");
  }
  for (std::size_t i = 0; i < capacity_; ++i) {
    // The rest of the block is filled with the normal.
    const UnitVector at = i < directions.size() ? directions[i] : UnitVector{0, 0, 1};
    for (std::size_t k = 0; k < at.size(); ++k) drawn_[k * capacity_ + i] = at[k];
  }
  require_sound(device_, "find_density.cl", [&] { return test_density(device_); });
  checked("cannot find densities of directions", [&] {
    auto& queue = device_.implementation().queue;
    if (density_() == nullptr) {
      density_ = make_kernel(
          build_program(device_, {"sampling/proposal.clh", "sampling/find_density.cl"}, Precision::double_precision),
          "find_density", 8);
    }
    queue.enqueueWriteBuffer(drawn_buffer_, CL_FALSE, 0, drawn_.size() * sizeof(double), drawn_.data());
    set_arguments(density_, light_[0], light_[1], light_[2], parts_, static_cast<cl_uint>(part_count_), tables_,
                  static_cast<cl_uint>(capacity_), drawn_buffer_);
    launch(density_);
    queue.enqueueReadBuffer(drawn_buffer_, CL_TRUE, 0, drawn_.size() * sizeof(double), drawn_.data());
  });
  std::ranges::copy(row(Row::density).first(directions.size()), densities.begin());
}

}  // namespace lobe
