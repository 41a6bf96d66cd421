// Materials from lobes, as comparison metrics look at them:
//   mapped[pack][node][lane] = factor[node] * MAP(scale[node] * sum_t weight_t S[lobe_t][node]).
//
// MAP, set by the host: map_linear, x; map_log, ln(1 + x); map_cube_root, x^(1/3); or map_cube_root_log,
// ln(1 + x^(1/3)).
#include "prelude.clh"
#ifndef MAP
#define MAP map_linear
#endif

#define map_linear(x) (x)

// ln(u) x / (u - 1) with u = 1 + x, rounded: right to a few ulp for every x (Goldberg 1991, theorem 4). The runtime's
// log1p() is no vector code, its log() is.
inline pack map_log(const pack x) {
  const pack u = x + (pack)(1.0);
  const pack step = u - (pack)(1.0);
  return step == (pack)(0.0) ? x : log(u) * x / step;
}

// By a logarithm, right to some 1e-15, and a Newton step on r^3 = |x|, which leaves the last rounding; the runtime's
// cbrt() is no vector code. Below 1e-290, where the step would divide by what is no normal number, 0.
inline pack map_cube_root(const pack x) {
  const pack size = fabs(x);
  const pack a = fmax(size, (pack)(1e-290));
  pack r = exp(log(a) * (pack)(1.0 / 3.0));
  const pack square = r * r;
  r -= fma(square, r, -a) / ((pack)(3.0) * square);
  // Comparisons with what is no number are false, which keeps it.
  return copysign(size < (pack)(1e-290) ? (pack)(0.0) : size <= (pack)(DBL_MAX) ? r : size, x);
}

inline pack map_cube_root_log(const pack x) {
  return map_log(map_cube_root(x));
}

// Row q of the mapped samples has the terms first_term[q] .. first_term[q+1]-1; rows without terms are black.
// term_place: where a lobe's samples begin. samples: as evaluate_lobes.cl leaves them; mapped: row packs x node_stride
// x REAL_WIDTH. A work-item takes a pack of rows and nodes_per_item consecutive nodes.
__kernel void map_materials(__global const double* restrict samples, const uint node_stride, const uint nodes,
                            const uint nodes_per_item, __global const uint* restrict first_term,
                            __global const uint* restrict term_place, __global const double* restrict term_weight,
                            __global const double* restrict scale, __global const double* restrict factor,
                            __global double* restrict mapped) {
  const uint row_pack = (uint)get_global_id(0);
  const uint first_node = (uint)get_global_id(1) * nodes_per_item;
  const uint last_node = min(first_node + nodes_per_item, nodes);
  for (uint node = first_node; node < last_node; ++node) {
    double lanes[REAL_WIDTH];
    for (uint lane = 0; lane < REAL_WIDTH; ++lane) {
      const uint row = row_pack * REAL_WIDTH + lane;
      const uint last = first_term[row + 1];
      double value = 0.0;
      for (uint t = first_term[row]; t < last; ++t) {
        value += term_weight[t] * samples[(size_t)term_place[t] + (size_t)node * REAL_WIDTH];
      }
      lanes[lane] = value;
    }
    const pack x = (pack)(scale[node]) * LOAD_PACK(0, lanes);
    STORE_PACK((pack)(factor[node]) * MAP(x), (size_t)row_pack * node_stride + node, mapped);
  }
}
