#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "lobe/table/table.hpp"

namespace lobe {

/// The data that determine the albedos of a channel, and of the channel times factors of its rows: the values summed
/// over azimuths, and the delta parts.
class RowKernel {
 public:
  enum class Rule {
    full,      ///< that of the grid
    embedded,  ///< every second ring and azimuth, to judge the full one by; on grids of cells, which sum up exactly,
               ///< full
    other      ///< the same with the rings that are left out there
  };
  /// \param table has to outlive this object
  RowKernel(const BrdfTable& table, std::size_t channel, Rule rule);
  RowKernel(RowKernel&&) = default;
  RowKernel& operator=(RowKernel&&) = default;

  [[nodiscard]] std::size_t rows() const { return weights_.size(); }
  /// Integral of the smooth part at L in row i over V in row j is weight(j) sum(i, j).
  [[nodiscard]] double sum(std::size_t i, std::size_t j) const { return sums_[i * rows() + j]; }
  [[nodiscard]] double weight(std::size_t row) const { return weights_[row]; }
  /// The row that the mirror sends a row to.
  [[nodiscard]] std::size_t mirrored(std::size_t row) const;
  [[nodiscard]] double mirror(std::size_t row) const;
  [[nodiscard]] double retro(std::size_t row) const;

  /// Albedos by row over a divisor, rows x rows: light from L, light into V.
  struct Albedos {
    std::vector<double> in;
    std::vector<double> out;
  };
  [[nodiscard]] Albedos albedos(std::span<const double> divisor) const;
  /// Albedos of the bounds on the errors of the values.
  [[nodiscard]] Albedos value_errors(std::span<const double> divisor) const;

 private:
  const BrdfTable* table_;
  std::size_t channel_;
  std::vector<double> weights_;
  std::vector<double> own_sums_;  ///< of isotropic tables
  std::span<const double> sums_;
};

/// Cosine of the angle that a row stands for.
[[nodiscard]] double row_cosine(const BrdfTable& table, std::size_t row);
/// The ring of a row.
[[nodiscard]] std::size_t row_ring(const BrdfTable& table, std::size_t row);

/// Multiplies values, delta parts and error bounds of a channel by factors.
/// \param factor of rows L and V
/// \param uncertainty of the factor, relative
void multiply_rows(BrdfTable& table, std::size_t channel, const std::function<double(std::size_t, std::size_t)>& factor,
                   const std::function<double(std::size_t, std::size_t)>& uncertainty);

}  // namespace lobe
