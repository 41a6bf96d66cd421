// A source of its own, for its flags (lib/CMakeLists.txt).
#include "hemisphere/row_tables.hpp"

#include <cmath>

#include "core/clones.hpp"

namespace lobe {
namespace {

/// As many numbers, anywhere in memory.
typedef double Lanes __attribute__((vector_size(kTableLanes * sizeof(double)), aligned(sizeof(double)), may_alias));

Lanes* at_lanes(double* values) {
  return reinterpret_cast<Lanes*>(values);
}
const Lanes* at_lanes(const double* values) {
  return reinterpret_cast<const Lanes*>(values);
}

LOBE_CLONES void combine(const double* weights, std::size_t count, std::size_t fine_count, const double* fine,
                         std::size_t stride, double* rows) {
  for (std::size_t column = 0; column < stride; column += kTableLanes) {
    std::size_t row = 0;
    for (; row + 4 <= count; row += 4) {
      Lanes sum0{};
      Lanes sum1{};
      Lanes sum2{};
      Lanes sum3{};
      for (std::size_t k = 0; k < fine_count; ++k) {
        const Lanes value = *at_lanes(fine + k * stride + column);
        const double* weight = weights + k * count + row;
        sum0 += weight[0] * value;
        sum1 += weight[1] * value;
        sum2 += weight[2] * value;
        sum3 += weight[3] * value;
      }
      double* const out = rows + row * stride + column;
      *at_lanes(out) = sum0;
      *at_lanes(out + stride) = sum1;
      *at_lanes(out + 2 * stride) = sum2;
      *at_lanes(out + 3 * stride) = sum3;
    }
    for (; row < count; ++row) {
      Lanes sum{};
      for (std::size_t k = 0; k < fine_count; ++k) {
        sum += weights[k * count + row] * *at_lanes(fine + k * stride + column);
      }
      *at_lanes(rows + row * stride + column) = sum;
    }
  }
}

}  // namespace

LOBE_CLONES void write_cosines(double psi, double scale, std::size_t stride, double* values) {
  const double slope = 2 * std::cos(psi);
  double first[kTableLanes] = {1, slope / 2};
  for (std::size_t m = 2; m < kTableLanes; ++m) first[m] = slope * first[m - 1] - first[m - 2];
  const double eighth = slope * first[kTableLanes - 1] - first[kTableLanes - 2];                  // cos(8 psi)
  Lanes now = *at_lanes(first);                                                                   // orders m .. m + 7
  Lanes before = {eighth, first[7], first[6], first[5], first[4], first[3], first[2], first[1]};  // m - 8 .. m - 1
  now *= scale;
  before *= scale;
  const double step = 2 * eighth;
  for (double* const end = values + stride; values != end; values += kTableLanes) {
    *at_lanes(values) = now;
    const Lanes next = step * now - before;
    before = now;
    now = next;
  }
}

void combine_rows(const Eigen::MatrixXd& weights, const RowMajorMatrix& fine, double* rows) {
  combine(weights.data(), static_cast<std::size_t>(weights.rows()), static_cast<std::size_t>(weights.cols()),
          fine.data(), static_cast<std::size_t>(fine.cols()), rows);
}

}  // namespace lobe
