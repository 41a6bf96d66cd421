// A source of its own, for its flags (lib/CMakeLists.txt).
#include <cmath>
#include <cstddef>

#include "hemisphere/geometry.hpp"
#include "hemisphere/node_place.hpp"

// gcc is told which functions glibc has for several numbers at a time; <cmath> tells it under -ffast-math alone.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 35)
extern "C" {
__attribute__((simd("notinbranch"))) double sin(double) noexcept;
__attribute__((simd("notinbranch"))) double log1p(double) noexcept;
}
// The processor is looked at as the library is loaded, when sanitizers are not ready yet.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LOBE_FOR_EACH_PROCESSOR __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#endif
#endif
#endif
#ifndef LOBE_FOR_EACH_PROCESSOR
#define LOBE_FOR_EACH_PROCESSOR
#endif

namespace lobe {
namespace {

/// Rows of a block, from the first column that is meant.
struct Columns {
  const double *cos_i, *cos_o;
  double *cos_h, *cos_d, *tan2_h, *log_cos_h, *log_rv;
  const double *psi, *sin_difference, *sines, *cos_difference;
};

/// What make_node() of geometry.cpp does, for many nodes.
LOBE_FOR_EACH_PROCESSOR void complete(const Columns& at, std::size_t count) {
#pragma omp simd
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

}  // namespace

void complete_nodes(NodeBlock& block, std::size_t first, std::size_t count) {
  const auto row = [&](NodeBlock::Row which) { return block.row(which) + first; };
  complete({.cos_i = row(NodeBlock::cos_i),
            .cos_o = row(NodeBlock::cos_o),
            .cos_h = row(NodeBlock::cos_h),
            .cos_d = row(NodeBlock::cos_d),
            .tan2_h = row(NodeBlock::tan2_h),
            .log_cos_h = row(NodeBlock::log_cos_h),
            .log_rv = row(NodeBlock::log_rv),
            .psi = row(place::psi),
            .sin_difference = row(place::sin_difference),
            .sines = row(place::sines),
            .cos_difference = row(place::cos_difference)},
           count);
}

}  // namespace lobe
