// A source of its own, for its flags (lib/CMakeLists.txt).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/clones.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/node_place.hpp"

// gcc is told which of glibc's functions take vectors; <cmath> does so only under -ffast-math.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__)
#if __GNUC__ >= 12 && __GLIBC_PREREQ(2, 35)
extern "C" {
__attribute__((simd("notinbranch"), const)) double cos(double) noexcept;
__attribute__((simd("notinbranch"), const)) double sin(double) noexcept;  // no built-in one (lib/CMakeLists.txt)
__attribute__((simd("notinbranch"), const)) double log1p(double) noexcept;
}
#define LOBE_VECTORS _Pragma("omp simd")
#endif
#endif
#ifndef LOBE_VECTORS
#define LOBE_VECTORS
#endif
// What clones share has to be compiled as each of them is.
#if defined(__GNUC__)
#define LOBE_INSIDE __attribute__((always_inline)) inline
#else
#define LOBE_INSIDE inline
#endif

namespace lobe {
namespace {

/// No vector has more numbers.
constexpr std::size_t kWidest = 8;

static_assert(place::kDeltaPhi == place::kPsi);

/// Rows of a block, from the first column that is meant. Of pairs of directions `psi` holds delta_phi, and the rows of
/// cosines hold angles.
struct Columns {
  double *cos_i, *cos_o;
  double *cos_h, *cos_d, *tan2_h, *log_cos_h, *log_rv;
  const double *psi, *sin_difference, *sines, *cos_difference;
};

/// Rows of tangents, likewise; the first holds phi_in until then.
struct TangentColumns {
  double *slope_x, *slope_y, *in_x, *in_y;
};

/// What make_node() of geometry.cpp does but for ln(R.V).
/// \param across2 square of what L and the mirror image of V differ by along the surface
/// \return 1 - R.V
LOBE_INSIDE double make_half_vector(const Columns& at, std::size_t k, double along, double across2,
                                    double cos_difference) {
  const double along2 = along * along;
  const double cos_d = std::sqrt(across2 + along2) / 2;
  const double tan2_h = across2 / along2;
  at.cos_h[k] = along / (2 * cos_d);
  at.cos_d[k] = cos_d;
  at.tan2_h[k] = tan2_h;
  at.log_cos_h[k] = -0.5 * log1p(tan2_h);
  return (cos_difference * cos_difference + across2) / 2;
}

// ln(R.V) stands in the loops: of a condition in a function gcc makes branches before it comes to vectors.

/// What make_node() of geometry.cpp does, for many nodes.
/// \param count a multiple of kWidest
LOBE_CLONES void complete(const Columns& at, std::size_t count) {
  LOBE_VECTORS
  for (std::size_t k = 0; k < count; ++k) {
    const double half_sine = sin(at.psi[k] / 2);
    const double across2 = at.sin_difference[k] * at.sin_difference[k] + at.sines[k] * half_sine * half_sine;
    const double deficit = make_half_vector(at, k, at.cos_i[k] + at.cos_o[k], across2, at.cos_difference[k]);
    const bool is_seen = deficit < 1;
    const double log_rv = log1p(is_seen ? -deficit : 0.0);
    at.log_rv[k] = is_seen ? log_rv : kNoMirrorCosine;
  }
}

/// Sines and cosines of a pair of directions, and their differences, as pair_of_directions() of geometry.cpp has them.
struct Angles {
  double cos_i, cos_o, sin_i, sin_o, cos_difference, sin_difference;
};

LOBE_INSIDE Angles angles_of(double theta_in, double theta_out) {
  const double cos_i = cos(theta_in);
  const double cos_o = cos(theta_out);
  const double sin_i = sin(theta_in);
  const double sin_o = sin(theta_out);
  const double cos_difference = -2 * sin((theta_in + theta_out) / 2) * sin((theta_in - theta_out) / 2);
  constexpr double kSome = 1e-300;  // nothing beside sines, but where both directions are the normal
  const double sin_difference = -cos_difference * (cos_i + cos_o) / (sin_i + sin_o + kSome);
  return {cos_i, cos_o, sin_i, sin_o, cos_difference, sin_difference};
}

/// What node_of_directions() of geometry.cpp does, for many nodes.
/// \param count a multiple of kWidest
LOBE_CLONES void complete_pairs(const Columns& at, std::size_t count) {
  LOBE_VECTORS
  for (std::size_t k = 0; k < count; ++k) {
    const Angles pair = angles_of(at.cos_i[k], at.cos_o[k]);
    const double half_sine = cos(at.psi[k] / 2);  // sin(psi/2) = cos(delta_phi/2)
    const double across2 =
        pair.sin_difference * pair.sin_difference + 4 * pair.sin_i * pair.sin_o * half_sine * half_sine;
    at.cos_i[k] = pair.cos_i;
    at.cos_o[k] = pair.cos_o;
    const double deficit = make_half_vector(at, k, pair.cos_i + pair.cos_o, across2, pair.cos_difference);
    const bool is_seen = deficit < 1;
    const double log_rv = log1p(is_seen ? -deficit : 0.0);
    at.log_rv[k] = is_seen ? log_rv : kNoMirrorCosine;
  }
}

/// And tangents_of_directions().
LOBE_CLONES void complete_turned_pairs(const Columns& at, const TangentColumns& tangents, std::size_t count) {
  LOBE_VECTORS
  for (std::size_t k = 0; k < count; ++k) {
    const Angles pair = angles_of(at.cos_i[k], at.cos_o[k]);
    const double half_sine = cos(at.psi[k] / 2);  // sin(psi/2) = cos(delta_phi/2)
    const double half_cosine = sin(at.psi[k] / 2);
    const double across2 =
        pair.sin_difference * pair.sin_difference + 4 * pair.sin_i * pair.sin_o * half_sine * half_sine;
    const double along = pair.cos_i + pair.cos_o;
    const double ahead = pair.sin_difference + 2 * pair.sin_o * half_sine * half_sine;
    const double aside = 2 * pair.sin_o * half_sine * half_cosine;
    const double cosine = cos(tangents.slope_x[k]);
    const double sine = sin(tangents.slope_x[k]);
    tangents.slope_x[k] = (ahead * cosine - aside * sine) / along;
    tangents.slope_y[k] = (ahead * sine + aside * cosine) / along;
    tangents.in_x[k] = pair.sin_i * cosine;
    tangents.in_y[k] = pair.sin_i * sine;
    at.cos_i[k] = pair.cos_i;
    at.cos_o[k] = pair.cos_o;
    const double deficit = make_half_vector(at, k, along, across2, pair.cos_difference);
    const bool is_seen = deficit < 1;
    const double log_rv = log1p(is_seen ? -deficit : 0.0);
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

template <typename RowOf>
TangentColumns tangents_of(const RowOf& row) {
  return {.slope_x = row(NodeBlock::kRows + NodeBlock::slope_x),
          .slope_y = row(NodeBlock::kRows + NodeBlock::slope_y),
          .in_x = row(NodeBlock::kRows + NodeBlock::in_x),
          .in_y = row(NodeBlock::kRows + NodeBlock::in_y)};
}

/// Lets `work` run over columns of a block, several at a time.
/// \param work takes a function from rows to their first numbers, and how many columns there are: a multiple of kWidest
template <typename Work>
void in_vectors(NodeBlock& block, std::size_t first, std::size_t count, const Work& work) {
  const std::size_t rest = count % kWidest;
  work([&](std::size_t which) { return block.nth_row(which) + first; }, count - rest);
  if (rest == 0) return;
  // The others fill vectors, too: functions of single numbers round differently.
  const std::size_t begin = first + count - rest;
  std::array<std::array<double, kWidest>, NodeBlock::kRows + NodeBlock::kTangentRows> columns{};
  for (std::size_t row = 0; row < block.rows(); ++row) {
    columns[row].fill(block.nth_row(row)[begin]);
    std::copy_n(block.nth_row(row) + begin, rest, columns[row].begin());
  }
  work([&](std::size_t which) { return columns[which].data(); }, kWidest);
  for (std::size_t row = 0; row < block.rows(); ++row) {
    std::copy_n(columns[row].begin(), rest, block.nth_row(row) + begin);
  }
}

}  // namespace

void complete_nodes(NodeBlock& block, std::size_t first, std::size_t count) {
  in_vectors(block, first, count, [](const auto& row, std::size_t columns) { complete(columns_of(row), columns); });
}

void complete_directions(NodeBlock& block, std::size_t first, std::size_t count) {
  in_vectors(block, first, count, [&](const auto& row, std::size_t columns) {
    if (block.has_tangents()) {
      complete_turned_pairs(columns_of(row), tangents_of(row), columns);
    } else {
      complete_pairs(columns_of(row), columns);
    }
  });
}

}  // namespace lobe
