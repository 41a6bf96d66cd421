// A source of its own, for its flags (lib/CMakeLists.txt).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "hemisphere/geometry.hpp"
#include "hemisphere/node_place.hpp"

// gcc is told which of glibc's functions take vectors; <cmath> does so only under -ffast-math.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__)
#if __GNUC__ >= 12 && __GLIBC_PREREQ(2, 35)
extern "C" {
__attribute__((simd("notinbranch"))) double sin(double) noexcept;
__attribute__((simd("notinbranch"))) double log1p(double) noexcept;
}
#define LOBE_VECTORS _Pragma("omp simd")
// The clone is chosen while the library is loaded, before sanitizers are ready.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LOBE_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#endif
#endif
#endif
#ifndef LOBE_VECTORS
#define LOBE_VECTORS
#endif
#ifndef LOBE_CLONES
#define LOBE_CLONES
#endif

namespace lobe {
namespace {

/// No vector has more numbers.
constexpr std::size_t kWidest = 8;

/// Rows of a block, from the first column that is meant.
struct Columns {
  const double *cos_i, *cos_o;
  double *cos_h, *cos_d, *tan2_h, *log_cos_h, *log_rv;
  const double *psi, *sin_difference, *sines, *cos_difference;
};

/// What make_node() of geometry.cpp does, for many nodes.
/// \param count a multiple of kWidest
LOBE_CLONES void complete(const Columns& at, std::size_t count) {
  LOBE_VECTORS
  for (std::size_t k = 0; k < count; ++k) {
    const double along = at.cos_i[k] + at.cos_o[k];
    const double along2 = along * along;
    const double half_sine = sin(at.psi[k] / 2);
    const double across2 = at.sin_difference[k] * at.sin_difference[k] + at.sines[k] * half_sine * half_sine;
    const double deficit = (at.cos_difference[k] * at.cos_difference[k] + across2) / 2;
    const double cos_d = std::sqrt(across2 + along2) / 2;
    const double tan2_h = across2 / along2;
    const bool is_seen = deficit < 1;
    const double log_rv = log1p(is_seen ? -deficit : 0.0);
    at.cos_h[k] = along / (2 * cos_d);
    at.cos_d[k] = cos_d;
    at.tan2_h[k] = tan2_h;
    at.log_cos_h[k] = -0.5 * log1p(tan2_h);
    at.log_rv[k] = is_seen ? log_rv : kNoMirrorCosine;
  }
}

template <typename RowOf>
Columns columns_of(const RowOf& row) {
  return {.cos_i = row(NodeBlock::cos_i),
          .cos_o = row(NodeBlock::cos_o),
          .cos_h = row(NodeBlock::cos_h),
          .cos_d = row(NodeBlock::cos_d),
          .tan2_h = row(NodeBlock::tan2_h),
          .log_cos_h = row(NodeBlock::log_cos_h),
          .log_rv = row(NodeBlock::log_rv),
          .psi = row(place::kPsi),
          .sin_difference = row(place::kSinDifference),
          .sines = row(place::kSines),
          .cos_difference = row(place::kCosDifference)};
}

}  // namespace

void complete_nodes(NodeBlock& block, std::size_t first, std::size_t count) {
  const std::size_t rest = count % kWidest;
  complete(columns_of([&](NodeBlock::Row which) { return block.row(which) + first; }), count - rest);
  if (rest == 0) return;
  // The others fill vectors, too: functions of single numbers round differently.
  const std::size_t begin = first + count - rest;
  std::array<std::array<double, kWidest>, NodeBlock::kRows> columns;
  for (std::size_t row = 0; row < NodeBlock::kRows; ++row) {
    columns[row].fill(block.row(NodeBlock::Row(row))[begin]);
    std::copy_n(block.row(NodeBlock::Row(row)) + begin, rest, columns[row].begin());
  }
  complete(columns_of([&](NodeBlock::Row which) { return columns[which].data(); }), kWidest);
  for (std::size_t row = 0; row < NodeBlock::kRows; ++row) {
    std::copy_n(columns[row].begin(), rest, block.row(NodeBlock::Row(row)) + begin);
  }
}

}  // namespace lobe
