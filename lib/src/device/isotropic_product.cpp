#include "device/isotropic_product.hpp"

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/multiply_orders.hpp"
#include "device/multiply_strided.hpp"
#include "device/self_test.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Layout = std::variant<IsotropicPacks::Layout, IsotropicScalars::Layout>;
using Stages = std::variant<IsotropicPacks, IsotropicScalars>;

void require_valid(const IsotropicShape& shape) {
  if (shape.rows == 0 || shape.inner == 0 || shape.columns == 0) {
    throw ArgumentError("product of isotropic tables without rings; expected at least one ring on each side");
  }
  if (shape.azimuths == 0 || shape.azimuths % 2 != 0) {
    throw ArgumentError("isotropic tables of " + std::to_string(shape.azimuths) +
                        " azimuths; expected an even number of at least 2");
  }
}

void require_size(const char* what, std::size_t size, std::size_t expected) {
  if (size == expected) return;
  throw ArgumentError(std::string(what) + " of an isotropic product has " + std::to_string(size) +
                      " values; expected " + std::to_string(expected));
}

Layout make_layout(const Device& device, const IsotropicShape& shape, Precision precision,
                   const IsotropicLimits& limits) {
  require_valid(shape);
  if (device.implementation().pack_width == 8) {
    IsotropicPacks::Layout packs(device, shape, precision, limits);
    // Thousands of azimuths do not fit; the other kernels need no room for them.
    if (packs.local_bytes() <= device.implementation().device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>()) return packs;
  }
  return IsotropicScalars::Layout(device, shape, precision, limits);
}

Stages make_stages(const Device& device, Layout layout) {
  if (auto* packs = std::get_if<IsotropicPacks::Layout>(&layout)) {
    return Stages(std::in_place_type<IsotropicPacks>, device, std::move(*packs));
  }
  return Stages(std::in_place_type<IsotropicScalars>, device, std::get<IsotropicScalars::Layout>(std::move(layout)));
}

/// True for devices that are CPUs and nothing else. Oclgrind, which is of every type at once, does not know memory that
/// it uses in place to be initialised.
bool shares_memory(const Device& device) {
  return device.implementation().device.getInfo<CL_DEVICE_TYPE>() == CL_DEVICE_TYPE_CPU;
}

/// A table of the caller as a buffer: in place where host and device share memory, else a copy.
class TableBuffer {
 public:
  /// A table that is read.
  TableBuffer(const Device& device, std::span<const double> table)
      : TableBuffer(device, const_cast<double*>(table.data()), table.size(), CL_MEM_READ_ONLY) {
    if (!in_place_) queue_.enqueueWriteBuffer(buffer_, CL_FALSE, 0, bytes_, data_);
  }

  /// A table that is written; complete after read().
  TableBuffer(const Device& device, std::span<double> table)
      : TableBuffer(device, table.data(), table.size(), CL_MEM_READ_WRITE) {}

  [[nodiscard]] const cl::Buffer& buffer() const { return buffer_; }

  void read() {
    if (in_place_) {
      queue_.enqueueUnmapMemObject(buffer_, queue_.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ, 0, bytes_));
    } else {
      queue_.enqueueReadBuffer(buffer_, CL_TRUE, 0, bytes_, data_);
    }
  }

 private:
  TableBuffer(const Device& device, double* data, std::size_t size, cl_mem_flags access)
      : queue_(device.implementation().queue),
        in_place_(shares_memory(device)),
        data_(data),
        bytes_(size * sizeof(double)),
        buffer_(in_place_ ? cl::Buffer(device.implementation().context, access | CL_MEM_USE_HOST_PTR, bytes_, data)
                          : make_workspace(device, bytes_)) {}

  cl::CommandQueue& queue_;
  bool in_place_;
  double* data_;
  std::size_t bytes_;
  cl::Buffer buffer_;
};

}  // namespace

class IsotropicProduct::Implementation {
 public:
  Implementation(const Device& device, Layout layout)
      : device_(device), stages_(make_stages(device, std::move(layout))) {}

  void multiply(std::span<const double> a, std::span<const double> b, std::span<const double> scale,
                std::span<double> c, const ProgressCallback& progress) {
    std::visit([&](auto& stages) { multiply(stages, a, b, scale, c, progress); }, stages_);
  }

  [[nodiscard]] const IsotropicShape& shape() const {
    return std::visit([](const auto& stages) -> const IsotropicShape& { return stages.layout().shape; }, stages_);
  }
  [[nodiscard]] std::uint64_t workspace_bytes() const {
    return std::visit([](const auto& stages) { return stages.layout().workspace_bytes(); }, stages_);
  }
  [[nodiscard]] std::size_t blocks() const {
    return std::visit([](const auto& stages) { return stages.layout().blocks.size(); }, stages_);
  }

 private:
  template <typename AnyStages>
  void multiply(AnyStages& stages, std::span<const double> a, std::span<const double> b, std::span<const double> scale,
                std::span<double> c, const ProgressCallback& progress) {
    auto& queue = device_.implementation().queue;
    const bool self = a.data() == b.data() && shape().rows == shape().inner && shape().inner == shape().columns;
    const TableBuffer left(device_, a);
    const std::optional<TableBuffer> right =
        self ? std::nullopt : std::optional<TableBuffer>(std::in_place, device_, b);
    TableBuffer product(device_, c);
    const FinishOnFailure finish(device_);

    stages.set_scale(scale);
    const auto& blocks = stages.layout().blocks;
    for (const auto& block : blocks) {
      stages.transform(block, left.buffer(), self ? Sides::both : Sides::left);
      if (!self) stages.transform(block, right->buffer(), Sides::right);
      stages.multiply(block);
      stages.restore(block, product.buffer(), block.first > 0);
      if (progress) {
        queue.finish();
        const auto fraction = static_cast<double>(block.end) / static_cast<double>(shape().points());
        if (!progress("product", fraction)) throw Cancelled("the product of isotropic tables was cancelled");
      }
    }
    product.read();
  }

  Device device_;
  Stages stages_;
};

IsotropicProduct::IsotropicProduct(const Device& device, const IsotropicShape& shape, Precision precision,
                                   const IsotropicLimits& limits)
    : implementation_(checked("cannot prepare a product of isotropic tables", [&] {
        return std::make_unique<Implementation>(device, make_layout(device, shape, precision, limits));
      })) {
  require_sound(device, with_precision("product of isotropic tables", precision),
                [&] { return test_isotropic_product(device, precision); });
}

IsotropicProduct::IsotropicProduct(IsotropicProduct&&) noexcept = default;
IsotropicProduct& IsotropicProduct::operator=(IsotropicProduct&&) noexcept = default;
IsotropicProduct::~IsotropicProduct() = default;

void IsotropicProduct::multiply(std::span<const double> a, std::span<const double> b, std::span<const double> scale,
                                std::span<double> c, const ProgressCallback& progress) {
  const auto& shape = implementation_->shape();
  require_size("the left table", a.size(), shape.rows * shape.inner * shape.points());
  require_size("the right table", b.size(), shape.inner * shape.columns * shape.points());
  require_size("the scale", scale.size(), shape.inner);
  require_size("the result", c.size(), shape.rows * shape.columns * shape.points());
  checked("cannot multiply isotropic tables", [&] { implementation_->multiply(a, b, scale, c, progress); });
}

std::uint64_t IsotropicProduct::workspace_bytes() const {
  return implementation_->workspace_bytes();
}

std::size_t IsotropicProduct::blocks() const {
  return implementation_->blocks();
}

void multiply_isotropic(const Device& device, std::size_t rows, std::size_t inner, std::size_t columns,
                        std::size_t azimuths, std::span<const double> a, std::span<const double> b,
                        std::span<const double> scale, std::span<double> c, Precision precision,
                        const ProgressCallback& progress) {
  IsotropicProduct(device, {rows, inner, columns, azimuths}, precision).multiply(a, b, scale, c, progress);
}

std::uint64_t isotropic_workspace_bytes(const Device& device, const IsotropicShape& shape, Precision precision,
                                        const IsotropicLimits& limits) {
  return checked("cannot plan a product of isotropic tables", [&] {
    return std::visit([](const auto& layout) { return layout.workspace_bytes(); },
                      make_layout(device, shape, precision, limits));
  });
}

}  // namespace lobe
