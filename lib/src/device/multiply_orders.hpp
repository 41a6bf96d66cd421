#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "device/cosine_plan.hpp"
#include "device/isotropic_product.hpp"
#include "device/isotropic_workspace.hpp"
#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// The stages of an isotropic product on devices with packs (kernels/products/isotropic.clh): folded transforms, and
/// tables in panels. Orders are in the sequence of the CosinePlan.
class IsotropicPacks {
 public:
  /// Memory that a shape needs, before anything is allocated.
  struct Layout {
    Layout(const Device& device, const IsotropicShape& shape, Precision precision, const IsotropicLimits& limits);

    IsotropicShape shape;
    Precision precision;
    CosinePlan plan;
    std::size_t number_bytes;  ///< size of a double or float
    std::size_t vector_bytes;  ///< size of a register
    std::size_t panel_bytes;   ///< size of a panel's row: two registers
    std::size_t padded_rows, padded_inner;
    std::size_t inner_panels, column_panels;
    IsotropicWorkspace workspace{};
    std::vector<OrderRange> blocks;
    std::size_t orders = 0;  ///< orders of the largest block

    [[nodiscard]] std::uint64_t workspace_bytes() const { return workspace.bytes(orders); }
    /// Local memory of a work-item.
    [[nodiscard]] std::uint64_t local_bytes() const;
  };

  IsotropicPacks(const Device& device, Layout layout);

  [[nodiscard]] const Layout& layout() const { return layout_; }
  void set_scale(std::span<const double> scale);
  void transform(OrderRange orders, const cl::Buffer& table, Sides sides);
  void multiply(OrderRange orders);
  void restore(OrderRange orders, const cl::Buffer& table, bool accumulate);

 private:
  /// A direction of the transform on the device.
  struct Direction {
    Direction(const Device& device, const CosinePlan::Direction& direction, Precision precision);
    std::size_t count;
    cl::Buffer strips, coefficients;
  };

  Device device_;
  Layout layout_;
  Direction forward_, inverse_;
  cl::Buffer scale_, left_, right_, product_;
  cl::Kernel transform_, multiply_, restore_;
};

}  // namespace lobe
