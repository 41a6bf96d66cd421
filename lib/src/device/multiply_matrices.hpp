#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// Row-major matrix of doubles in host memory.
struct MatrixView {
  const double* data;
  std::size_t rows, columns;
  std::size_t row_stride;  ///< values from one row to the next, at least `columns`
};

/// A matrix to be written.
struct MutableMatrixView {
  double* data;
  std::size_t rows, columns;
  std::size_t row_stride;
};

/// c = a diag(scale)^2 b.
///
/// Every term is formed as (a[i,x] scale[x]) (b[x,j] scale[x]), and terms are added over x in the same order by the
/// same operations for every entry: of symmetric a and b, multiply(a, b) is the transpose of multiply(b, a) bit for
/// bit. The matrices are used where they lie in memory (CPU devices) or go to the device piece by piece (others), so
/// they may be larger than the device's memory.
///
/// \param scale one value for each column of a
/// \param c overwritten; shares no memory with a or b
/// \param precision arithmetic of the products. In single precision the scaled factors are rounded to float and 256
///   terms at a time are added in float; the sums of these blocks are added in double.
/// \param progress called between pieces with the stage "product"
/// \throws ArgumentError where shapes do not fit; DeviceError; Cancelled, with c in part written
void multiply(const Device& device, const MatrixView& a, const MatrixView& b, std::span<const double> scale,
              const MutableMatrixView& c, Precision precision, const ProgressCallback& progress = {});

/// Bytes of device memory that multiply() takes for a (rows x depth) times b (depth x columns), beside the matrices.
[[nodiscard]] std::uint64_t multiply_workspace_bytes(const Device& device, std::size_t rows, std::size_t depth,
                                                     std::size_t columns, Precision precision);

/// The largest pieces that a product is cut into. The defaults keep a piece below a fraction of a second, and what is
/// packed of b about as large as a last-level cache; tests use smaller ones.
struct PieceLimits {
  std::size_t rows = 2048;     ///< of a and c
  std::size_t depth = 1536;    ///< columns of a, rows of b; taken as a multiple of 256
  std::size_t columns = 4096;  ///< of b and c
  unsigned vector_bytes = 0;   ///< of the device's registers, 64 or 32; 0: what the device reports
};

/// How a product is done; multiply() and multiply_workspace_bytes() both follow it.
struct ProductPlan {
  std::size_t rows, depth, columns;  ///< of all pieces but the last ones, which may be smaller
  bool packed;                       ///< by multiply_matrices_packed.cl, else by multiply_matrices_tiles.cl
  unsigned vector_bytes;             ///< packed: width of a register
  std::size_t item_rows;             ///< packed: rows of a work-item
  std::uint64_t workspace_bytes;
};

/// Plans a (rows x depth) times b (depth x columns).
[[nodiscard]] ProductPlan plan_product(const Device& device, std::size_t rows, std::size_t depth, std::size_t columns,
                                       Precision precision, const PieceLimits& limits = {});

/// multiply() by a plan for these shapes and this precision.
void multiply(const Device& device, const ProductPlan& plan, const MatrixView& a, const MatrixView& b,
              std::span<const double> scale, const MutableMatrixView& c, Precision precision,
              const ProgressCallback& progress = {});

}  // namespace lobe
