#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lobe {

/// A block of quadrature nodes in the layout of kernels/prelude.clh: one row per quantity, one column per node.
class NodeBlock {
 public:
  /// Rows, in the order of ROW_* in kernels/prelude.clh.
  enum Row : std::size_t { cos_i, cos_o, cos_h, cos_d, tan2_h, log_cos_h, log_rv, factor };
  static constexpr std::size_t kRows = 8;
  using Node = std::array<double, kRows>;

  explicit NodeBlock(std::size_t capacity) : capacity_(capacity), data_(kRows * capacity) {}

  void push(const Node& node) {
    for (std::size_t row = 0; row < kRows; ++row) data_[row * capacity_ + size_] = node[row];
    ++size_;
  }
  void clear() { size_ = 0; }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  [[nodiscard]] bool full() const { return size_ == capacity_; }
  /// kRows x capacity values; only the first size() of each row are meant.
  [[nodiscard]] std::span<const double> data() const { return data_; }

 private:
  std::size_t capacity_;
  std::size_t size_ = 0;
  std::vector<double> data_;
};

}  // namespace lobe
