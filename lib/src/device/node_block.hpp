#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lobe {

/// A block of quadrature nodes in the layout of kernels/prelude.clh: one row per quantity, one column per node.
class NodeBlock {
 public:
  /// Rows, in the order of ROW_* in kernels/prelude.clh. What isotropic models see, and the factor.
  enum Row : std::size_t { cos_i, cos_o, cos_h, cos_d, tan2_h, log_cos_h, log_rv, factor };
  static constexpr std::size_t kRows = 8;
  using Node = std::array<double, kRows>;

  /// Rows that anisotropic models see besides: (H_x, H_y) / H_z and L_x, L_y.
  enum TangentRow : std::size_t { slope_x, slope_y, in_x, in_y };
  static constexpr std::size_t kTangentRows = 4;
  using Tangents = std::array<double, kTangentRows>;

  explicit NodeBlock(std::size_t capacity, bool has_tangents = false)
      : capacity_(capacity), has_tangents_(has_tangents), data_(rows() * capacity) {}

  void push(const Node& node) { set(size_++, node); }
  /// Into a block with tangents.
  void push(const Node& node, const Tangents& tangents) {
    for (std::size_t row = 0; row < kTangentRows; ++row) data_[(kRows + row) * capacity_ + size_] = tangents[row];
    push(node);
  }
  void clear() { size_ = 0; }
  /// As many more nodes, without tangents, that set() or place_node() gives in any order.
  void extend(std::size_t count) { size_ += count; }
  void set(std::size_t column, const Node& node) {
    for (std::size_t row = 0; row < kRows; ++row) data_[row * capacity_ + column] = node[row];
  }
  /// The values of a row, one for each node.
  [[nodiscard]] double* row(Row which) { return nth_row(which); }
  /// Those of tangents come after the others.
  [[nodiscard]] double* nth_row(std::size_t number) { return data_.data() + number * capacity_; }
  /// How many rows there are.
  [[nodiscard]] std::size_t rows() const { return kRows + (has_tangents_ ? kTangentRows : 0); }
  /// L and V change places at every node; the factor stays.
  void exchange_directions() {
    const auto row = [&](std::size_t k) { return data_.data() + k * capacity_; };
    for (std::size_t node = 0; node < size_; ++node) {
      if (has_tangents_) {
        const double both = row(cos_i)[node] + row(cos_o)[node];
        row(kRows + in_x)[node] = row(kRows + slope_x)[node] * both - row(kRows + in_x)[node];
        row(kRows + in_y)[node] = row(kRows + slope_y)[node] * both - row(kRows + in_y)[node];
      }
      std::swap(row(cos_i)[node], row(cos_o)[node]);
    }
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  [[nodiscard]] bool full() const { return size_ == capacity_; }
  [[nodiscard]] bool has_tangents() const { return has_tangents_; }
  /// Rows x capacity values; only the first size() of each row are meant.
  [[nodiscard]] std::span<const double> data() const { return data_; }

 private:
  std::size_t capacity_;
  bool has_tangents_;
  std::size_t size_ = 0;
  std::vector<double> data_;
};

}  // namespace lobe
