#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// Composition of isotropic tables: a (rows x inner) and b (inner x columns) rings, give rows x columns.
struct IsotropicShape {
  std::size_t rows;
  std::size_t inner;
  std::size_t columns;
  std::size_t azimuths;  ///< n_phi of a full turn, even

  /// Azimuths that a table holds: 0 .. pi.
  [[nodiscard]] std::size_t points() const { return azimuths / 2 + 1; }

  friend bool operator==(const IsotropicShape&, const IsotropicShape&) = default;
};

/// Bounds of what a product takes; tests use smaller ones.
struct IsotropicLimits {
  /// Bytes of device memory beside the tables. Where all orders at once would take more, they are done block by block,
  /// at least as many at a time as a strip of the transform has. The default lets a table of 128 rings and 256 azimuths
  /// through in one piece, and is small beside tables that do not go.
  std::uint64_t workspace_bytes = std::uint64_t{256} << 20;
  unsigned vector_bytes = 0;  ///< size of the device's registers, 64 or 32; 0: as the device reports
};

/// Composes isotropic tables f[i][j][k] of one shape (row-major; k = 0 .. n_phi/2, f even in azimuth):
///
///   c[i][j][k] = (2 pi / n_phi) sum_x w_x sum_{l < n_phi} a[i][x][k-l] b[x][j][l],
///
/// as one product of matrices for each order of the cosine transform over azimuth. Keeps kernels and workspace, so
/// that further products of the shape cost no preparation. Not for concurrent use from several threads.
///
/// Every term is formed as (A[i,x] sqrt(w_x)) (B[x,j] sqrt(w_x)), and all entries by the same operations in the same
/// order: of symmetric tables, multiply(a, b)[i][j] and multiply(b, a)[j][i] agree bit for bit.
class IsotropicProduct {
 public:
  /// \param precision arithmetic of transforms and products; the tables are in double precision either way
  /// \throws ArgumentError for an odd n_phi or an empty table, DeviceError
  IsotropicProduct(const Device& device, const IsotropicShape& shape, Precision precision,
                   const IsotropicLimits& limits = {});
  IsotropicProduct(IsotropicProduct&&) noexcept;
  IsotropicProduct& operator=(IsotropicProduct&&) noexcept;
  ~IsotropicProduct();

  /// Composes two tables. A table composed with itself (a and b the same memory) is transformed once.
  /// \param scale sqrt(w_x) of each inner ring
  /// \param c overwritten; shares no memory with a or b
  /// \param progress called between blocks of orders with the stage "product"
  /// \throws ArgumentError where a span has not the size of the shape, DeviceError, Cancelled
  void multiply(std::span<const double> a, std::span<const double> b, std::span<const double> scale,
                std::span<double> c, const ProgressCallback& progress = {});

  /// Device memory held beside the tables.
  [[nodiscard]] std::uint64_t workspace_bytes() const;

  /// Blocks of orders that a product goes through.
  [[nodiscard]] std::size_t blocks() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// One composition of isotropic tables, see IsotropicProduct.
void multiply_isotropic(const Device& device, std::size_t rows, std::size_t inner, std::size_t columns,
                        std::size_t azimuths, std::span<const double> a, std::span<const double> b,
                        std::span<const double> scale, std::span<double> c, Precision precision,
                        const ProgressCallback& progress = {});

/// Device memory that multiply_isotropic takes beside a, b and c.
[[nodiscard]] std::uint64_t isotropic_workspace_bytes(const Device& device, const IsotropicShape& shape,
                                                      Precision precision, const IsotropicLimits& limits = {});

}  // namespace lobe
