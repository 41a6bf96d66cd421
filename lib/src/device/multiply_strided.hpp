#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "device/isotropic_product.hpp"
#include "device/isotropic_workspace.hpp"
#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// The stages of an isotropic product on devices whose work-items are the lanes: each a batched dense product
/// (kernels/products/multiply_strided.cl). The workspace is in double precision, arithmetic as wanted.
class IsotropicScalars {
 public:
  /// Memory that a shape needs, before anything is allocated.
  struct Layout {
    Layout(const Device& device, const IsotropicShape& shape, Precision precision, const IsotropicLimits& limits);

    IsotropicShape shape;
    Precision precision;
    IsotropicWorkspace workspace{};
    std::vector<OrderRange> blocks;
    std::size_t orders = 0;  ///< orders of the largest block

    [[nodiscard]] std::uint64_t workspace_bytes() const { return workspace.bytes(orders); }
  };

  IsotropicScalars(const Device& device, Layout layout);

  [[nodiscard]] const Layout& layout() const { return layout_; }
  void set_scale(std::span<const double> scale);
  void transform(OrderRange orders, const cl::Buffer& table, Sides sides);
  void multiply(OrderRange orders);
  void restore(OrderRange orders, const cl::Buffer& table, bool accumulate);

 private:
  /// Where a batch of matrices begins, and the elements between neighbours; laid out as in
  /// kernels/products/multiply_strided.cl.
  struct Strides {
    cl_ulong first, batch, row, column;
  };
  struct Matrices {
    const cl::Buffer& buffer;
    Strides strides;
  };
  struct Sizes {
    std::size_t batches, rows, inner, columns;
  };

  void launch(const Sizes& sizes, const Matrices& a, const Matrices& b, const Matrices& factor, const Matrices& out,
              bool accumulate);

  Device device_;
  Layout layout_;
  cl::Buffer forward_, inverse_;  ///< [order][point] each
  cl::Buffer one_, scale_, left_, right_, product_;
  cl::Kernel kernel_;
};

}  // namespace lobe
