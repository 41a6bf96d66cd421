#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "device/error.hpp"
#include "device/lobe_batch.hpp"
#include "device/node_block.hpp"
#include "device/opencl.hpp"
#include "device/packed_rows.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// Evaluates a set of lobes at blocks of nodes and leaves the values on the device, in packs of lobes:
/// values[pack][node][lane]. Lobes that fill up a batch's last pack, or the last triple of packs, are zero.
class LobeEvaluator {
 public:
  /// \param node_capacity the largest block that evaluate() will get
  /// \throws DeviceError
  LobeEvaluator(const Device& device, const std::vector<LobeBatch>& batches, Precision precision,
                std::size_t node_capacity);

  /// Evaluates all lobes at a block, which has tangents where lobes are anisotropic: value = factor * f. Waits
  /// for what the device was given before, unless the block is empty, and returns before this is finished.
  void evaluate(const NodeBlock& nodes);

  /// A block size that keeps the values of so many lobes within the cache of a CPU.
  [[nodiscard]] static std::size_t suggested_capacity(std::size_t lobes);

  [[nodiscard]] const Device& device() const { return device_; }
  [[nodiscard]] PackedRows values() const {
    return checked("cannot share values", [&] { return PackedRows{values_, capacity_, packs_, width_}; });
  }
  [[nodiscard]] std::size_t node_stride() const { return capacity_; }
  [[nodiscard]] std::size_t packs() const { return packs_; }
  [[nodiscard]] std::size_t width() const { return width_; }
  /// Some lobe is anisotropic.
  [[nodiscard]] bool needs_tangents() const { return needs_tangents_; }
  [[nodiscard]] std::size_t padded_lobes() const { return packs_ * width_; }
  /// Padded row of each lobe, in the order of the batches.
  [[nodiscard]] const std::vector<std::size_t>& rows() const { return rows_; }

 private:
  friend Eigen::MatrixXd values_at(LobeEvaluator& evaluator, const NodeBlock& nodes);

  /// \param waits whether the device has read the nodes when this returns
  void launch(const NodeBlock& nodes, cl_bool waits);

  struct Model {
    cl::Kernel kernel;
    cl::Buffer coefficients;
    std::size_t packs;
    std::size_t first_pack;
  };

  Device device_;
  std::size_t width_;
  std::size_t capacity_;
  std::size_t packs_ = 0;
  bool needs_tangents_ = false;
  bool has_zeros_ = false;  // where no lobe is
  std::vector<std::size_t> rows_;
  std::vector<Model> models_;
  cl::Buffer geometry_;
  cl::Buffer values_;
};

/// The evaluator's current values at the first `nodes` nodes: lobes (without padding) x nodes.
[[nodiscard]] Eigen::MatrixXd read_values(const LobeEvaluator& evaluator, std::size_t nodes);

/// Evaluates all lobes at a block and waits for the values: lobes (without padding) x nodes.
[[nodiscard]] Eigen::MatrixXd values_at(LobeEvaluator& evaluator, const NodeBlock& nodes);

/// Waits until the device has done all it was given.
void finish(const Device& device);

}  // namespace lobe
