#include "device/multiply_matrices.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kDepthBlock = 256;  // DEPTH_BLOCK of both kernels
constexpr std::size_t kGroup = 16;        // GROUP of multiply_matrices_tiles.cl
constexpr std::size_t kGroupTile = 64;    // its TILE

std::size_t divide_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step;
}

/// Cuts `total` into as few pieces as the limit allows, of about the same size: a multiple of `unit`, or all of it.
std::size_t piece_size(std::size_t total, std::size_t limit, std::size_t unit) {
  const std::size_t largest = std::max(limit / unit * unit, unit);
  return std::min(round_up(divide_up(total, divide_up(total, largest)), unit), total);
}

std::size_t number_bytes(Precision precision) {
  return precision == Precision::double_precision ? sizeof(double) : sizeof(float);
}

/// Entries of c that are computed together.
struct Tile {
  std::size_t rows, columns;
};

/// The register tile of multiply_matrices_packed.cl.
Tile register_tile(unsigned vector_bytes, Precision precision) {
  return {vector_bytes == 64 ? 12U : 6U, std::size_t{2} * vector_bytes / number_bytes(precision)};
}

unsigned vector_bytes(const cl::Device& device) {
  return device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_DOUBLE>() >= 8 ? 64 : 32;
}

/// Rows of c for each work-item: packed, they take no more than half of local memory, which on CPUs is as large as a
/// core's cache, and all compute units get as many items.
std::size_t item_rows(const Device& device, std::size_t rows, std::size_t tile_rows, Precision precision) {
  constexpr std::size_t kMostRows = 192;
  const std::size_t local_bytes = device.implementation().device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  const std::size_t most = std::min(kMostRows, local_bytes / 2 / (kDepthBlock * number_bytes(precision)));
  const std::size_t units = std::max(device.info().compute_units, 1U);
  const std::size_t largest = std::max(most / tile_rows, std::size_t{1}) * tile_rows;
  const std::size_t items = round_up(divide_up(rows, largest), units);
  return round_up(divide_up(rows, items), tile_rows);
}

/// A piece of a range.
struct Piece {
  std::size_t first, count;
};

std::vector<Piece> pieces(std::size_t total, std::size_t size) {
  std::vector<Piece> result;
  for (std::size_t first = 0; first < total; first += size) result.push_back({first, std::min(size, total - first)});
  return result;
}

/// The factors, the result and how they are cut.
struct Task {
  const Device& device;
  const ProductPlan& plan;
  MatrixView a, b;
  std::span<const double> scale;
  MutableMatrixView c;
  Precision precision;

  [[nodiscard]] std::vector<Piece> row_pieces() const { return pieces(c.rows, plan.rows); }
  [[nodiscard]] std::vector<Piece> depth_pieces() const { return pieces(b.rows, plan.depth); }
  [[nodiscard]] std::vector<Piece> column_pieces() const { return pieces(c.columns, plan.columns); }
  [[nodiscard]] cl::CommandQueue& queue() const { return device.implementation().queue; }
};

/// Tells the caller about each piece that is done.
class Progress {
 public:
  Progress(const Task& task, const ProgressCallback& callback)
      : callback_(callback),
        total_(task.row_pieces().size() * task.depth_pieces().size() * task.column_pieces().size()) {}

  /// \throws Cancelled
  void piece_done() {
    ++done_;
    if (callback_ && !callback_("product", static_cast<double>(done_) / static_cast<double>(total_))) {
      throw Cancelled("the product of matrices was cancelled");
    }
  }

 private:
  const ProgressCallback& callback_;
  std::size_t total_;
  std::size_t done_ = 0;
};

template <typename Number>
cl_uint argument(Number value) {
  return static_cast<cl_uint>(value);
}

/// A piece of a host matrix as a buffer, without a copy where device and host share memory.
class HostPiece {
 public:
  template <typename View>
  HostPiece(const Task& task, const View& view, const Piece& rows, const Piece& columns, cl_mem_flags access)
      : bytes_(((rows.count - 1) * view.row_stride + columns.count) * sizeof(double)) {
    const double* first = view.data + rows.first * view.row_stride + columns.first;
    // Written only by a device with access.
    buffer_ = host_buffer(task.device, std::span(const_cast<double*>(first), bytes_ / sizeof(double)), access);
  }

  [[nodiscard]] const cl::Buffer& buffer() const { return buffer_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::size_t bytes_;
  cl::Buffer buffer_;
};

/// The product on CPU devices (kernels/products/multiply_matrices_packed.cl).
class PackedProduct {
 public:
  explicit PackedProduct(const Task& task) : task_(task), tile_(register_tile(task.plan.vector_bytes, task.precision)) {
    const auto program = build_program(task.device, {"prelude.clh", "products/multiply_matrices_packed.cl"},
                                       task.precision, "-D VECTOR_BYTES=" + std::to_string(task.plan.vector_bytes));
    pack_ = make_kernel(program, "pack_columns", 7);
    multiply_ = make_kernel(program, "multiply_matrices_packed", 13);
    packed_ = make_workspace(task.device, packed_bytes(task.plan, tile_, task.precision));
    scale_ = constant_buffer(task.device, task.scale);
  }

  static std::uint64_t packed_bytes(const ProductPlan& plan, const Tile& tile, Precision precision) {
    return plan.depth * round_up(plan.columns, tile.columns) * number_bytes(precision);
  }

  void run(Progress& progress) {
    for (const auto& columns : task_.column_pieces()) {
      for (const auto& depth : task_.depth_pieces()) {
        pack(depth, columns);
        for (const auto& rows : task_.row_pieces()) {
          multiply(rows, depth, columns);
          progress.piece_done();
        }
      }
    }
  }

 private:
  void pack(const Piece& depth, const Piece& columns) {
    const HostPiece b(task_, task_.b, depth, columns, CL_MEM_READ_ONLY);
    const FinishOnFailure finish(task_.device);
    set_arguments(pack_, b.buffer(), argument(task_.b.row_stride), scale_, argument(depth.first), argument(depth.count),
                  argument(columns.count), packed_);
    task_.queue().enqueueNDRangeKernel(
        pack_, cl::NullRange, cl::NDRange(divide_up(columns.count, tile_.columns), divide_up(depth.count, kDepthBlock)),
        cl::NDRange(1, 1));
    task_.queue().finish();
  }

  void multiply(const Piece& rows, const Piece& depth, const Piece& columns) {
    const HostPiece a(task_, task_.a, rows, depth, CL_MEM_READ_ONLY);
    const HostPiece c(task_, task_.c, rows, columns, CL_MEM_READ_WRITE);
    const FinishOnFailure finish(task_.device);
    const std::size_t item_rows = task_.plan.item_rows;
    set_arguments(multiply_, a.buffer(), argument(task_.a.row_stride), scale_, argument(depth.first), packed_,
                  argument(rows.count), argument(depth.count), argument(columns.count), argument(depth.first > 0),
                  c.buffer(), argument(task_.c.row_stride), argument(item_rows),
                  cl::Local(item_rows * kDepthBlock * number_bytes(task_.precision)));
    task_.queue().enqueueNDRangeKernel(multiply_, cl::NullRange, cl::NDRange(divide_up(rows.count, item_rows)),
                                       cl::NDRange(1));
    map_once(task_.device, c.buffer(), c.bytes(), CL_MAP_READ);
    task_.queue().finish();
  }

  const Task& task_;
  Tile tile_;
  cl::Kernel pack_;
  cl::Kernel multiply_;
  cl::Buffer packed_;
  cl::Buffer scale_;
};

/// The product on other devices (kernels/products/multiply_matrices_tiles.cl): pieces are copied to the device and
/// back.
class TiledProduct {
 public:
  explicit TiledProduct(const Task& task) : task_(task) {
    const auto program =
        build_program(task.device, {"prelude.clh", "products/multiply_matrices_tiles.cl"}, task.precision);
    multiply_ = make_kernel(program, "multiply_matrices_tiles", 12);
    const ProductPlan& plan = task.plan;
    a_ = make_buffer(task.device, plan.rows * plan.depth * sizeof(double));
    b_ = make_buffer(task.device, plan.depth * plan.columns * sizeof(double));
    c_ = make_workspace(task.device, plan.rows * plan.columns * sizeof(double));
    scale_ = constant_buffer(task.device, task.scale);
  }

  static std::uint64_t piece_bytes(const ProductPlan& plan) {
    return (plan.rows * plan.depth + plan.depth * plan.columns + plan.rows * plan.columns) * sizeof(double);
  }

  void run(Progress& progress) {
    for (const auto& columns : task_.column_pieces()) {
      for (const auto& rows : task_.row_pieces()) {
        for (const auto& depth : task_.depth_pieces()) {
          multiply(rows, depth, columns);
          progress.piece_done();
        }
        read(rows, columns);
      }
    }
  }

 private:
  /// Copies a piece of a matrix into mapped memory, which is the fastest way and one that oclgrind sees.
  void write(const cl::Buffer& buffer, const MatrixView& view, const Piece& rows, const Piece& columns) {
    const std::size_t bytes = rows.count * columns.count * sizeof(double);
    void* mapped = task_.queue().enqueueMapBuffer(buffer, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0, bytes);
    auto* target = static_cast<double*>(mapped);
    for (std::size_t row = 0; row < rows.count; ++row, target += columns.count) {
      std::copy_n(view.data + (rows.first + row) * view.row_stride + columns.first, columns.count, target);
    }
    task_.queue().enqueueUnmapMemObject(buffer, mapped);
  }

  void multiply(const Piece& rows, const Piece& depth, const Piece& columns) {
    write(a_, task_.a, rows, depth);
    write(b_, task_.b, depth, columns);
    set_arguments(multiply_, a_, argument(depth.count), b_, argument(columns.count), scale_, argument(depth.first),
                  argument(rows.count), argument(depth.count), argument(columns.count), argument(depth.first > 0), c_,
                  argument(columns.count));
    const auto items = [](std::size_t count) { return divide_up(count, kGroupTile) * kGroup; };
    task_.queue().enqueueNDRangeKernel(multiply_, cl::NullRange, cl::NDRange(items(columns.count), items(rows.count)),
                                       cl::NDRange(kGroup, kGroup));
    task_.queue().finish();
  }

  void read(const Piece& rows, const Piece& columns) {
    const cl::array<cl::size_type, 3> origin{};
    const std::size_t row_bytes = columns.count * sizeof(double);
    task_.queue().enqueueReadBufferRect(c_, CL_TRUE, origin, origin, {row_bytes, rows.count, 1}, row_bytes, 0,
                                        task_.c.row_stride * sizeof(double), 0,
                                        task_.c.data + rows.first * task_.c.row_stride + columns.first);
  }

  const Task& task_;
  cl::Kernel multiply_;
  cl::Buffer a_;
  cl::Buffer b_;
  cl::Buffer c_;
  cl::Buffer scale_;
};

template <typename View>
std::string shape_text(const View& view) {
  return std::to_string(view.rows) + " x " + std::to_string(view.columns);
}

void check_shapes(const MatrixView& a, const MatrixView& b, std::span<const double> scale, const MutableMatrixView& c) {
  if (a.columns != b.rows || a.rows != c.rows || b.columns != c.columns || scale.size() != b.rows) {
    throw ArgumentError("matrices of " + shape_text(a) + " and " + shape_text(b) + " with " +
                        std::to_string(scale.size()) + " scales cannot give " + shape_text(c) +
                        "; expected m x k, k x n, k and m x n");
  }
  if (a.row_stride < a.columns || b.row_stride < b.columns || c.row_stride < c.columns) {
    throw ArgumentError("rows of a matrix overlap; expected a row stride of at least its columns");
  }
}

void clear(const MutableMatrixView& c) {
  for (std::size_t row = 0; row < c.rows; ++row) std::fill_n(c.data + row * c.row_stride, c.columns, 0.0);
}

}  // namespace

ProductPlan plan_product(const Device& device, std::size_t rows, std::size_t depth, std::size_t columns,
                         Precision precision, const PieceLimits& limits) {
  ProductPlan plan{};
  if (rows == 0 || depth == 0 || columns == 0) return plan;
  return checked("cannot plan a product of matrices", [&] {
    plan.packed = device.implementation().pack_width > 1;
    plan.vector_bytes = limits.vector_bytes != 0 ? limits.vector_bytes : vector_bytes(device.implementation().device);
    const Tile tile = plan.packed ? register_tile(plan.vector_bytes, precision) : Tile{kGroupTile, kGroupTile};
    // A piece of whole rows has to fit into a buffer.
    const std::size_t longest = std::max(depth, columns) * sizeof(double);
    const std::size_t fitting = std::max<std::size_t>(device.info().largest_buffer_bytes / longest, 1);
    plan.rows = piece_size(rows, std::min(limits.rows, fitting), tile.rows);
    plan.depth = piece_size(depth, limits.depth, kDepthBlock);
    plan.columns = piece_size(columns, limits.columns, tile.columns);
    plan.item_rows = item_rows(device, plan.rows, tile.rows, precision);
    plan.workspace_bytes = depth * sizeof(double) + (plan.packed ? PackedProduct::packed_bytes(plan, tile, precision)
                                                                 : TiledProduct::piece_bytes(plan));
    return plan;
  });
}

void multiply(const Device& device, const ProductPlan& plan, const MatrixView& a, const MatrixView& b,
              std::span<const double> scale, const MutableMatrixView& c, Precision precision,
              const ProgressCallback& callback) {
  check_shapes(a, b, scale, c);
  if (c.rows == 0 || c.columns == 0) return;
  if (scale.empty()) return clear(c);
  require_sound(device, with_precision("product of matrices", precision),
                [&] { return test_matrix_product(device, precision); });
  checked("cannot multiply matrices", [&] {
    const Task task{device, plan, a, b, scale, c, precision};
    Progress progress(task, callback);
    if (plan.packed) {
      PackedProduct(task).run(progress);
    } else {
      TiledProduct(task).run(progress);
    }
  });
}

void multiply(const Device& device, const MatrixView& a, const MatrixView& b, std::span<const double> scale,
              const MutableMatrixView& c, Precision precision, const ProgressCallback& progress) {
  multiply(device, plan_product(device, a.rows, a.columns, b.columns, precision), a, b, scale, c, precision, progress);
}

std::uint64_t multiply_workspace_bytes(const Device& device, std::size_t rows, std::size_t depth, std::size_t columns,
                                       Precision precision) {
  return plan_product(device, rows, depth, columns, precision).workspace_bytes;
}

}  // namespace lobe
