// Squared norms of sparse combinations of lobes: out[q] += sum over nodes of (sum_t weight_t S[lobe_t][node])^2.
// Near-identical materials: their difference is taken at the nodes, before squaring, where products would cancel.
#include "prelude.clh"

// Combination q has the terms first_term[q] .. first_term[q+1]-1. samples: packs x node_stride x REAL_WIDTH.
__kernel void accumulate_differences(__global const double* restrict samples, const uint node_stride, const uint nodes,
                                     __global const uint* restrict first_term, __global const uint* restrict term_lobe,
                                     __global const double* restrict term_weight, __global double* restrict out) {
  const uint q = (uint)get_global_id(0);
  const uint first = first_term[q];
  const uint last = first_term[q + 1];
  double sum = 0.0;
  for (uint node = 0; node < nodes; ++node) {
    double value = 0.0;
    for (uint t = first; t < last; ++t) {
      const uint lobe = term_lobe[t];
      const size_t at = ((size_t)(lobe / REAL_WIDTH) * node_stride + node) * REAL_WIDTH + lobe % REAL_WIDTH;
      value += term_weight[t] * samples[at];
    }
    sum += value * value;
  }
  out[q] += sum;
}
