// Evaluates one model for packs of materials at a block of nodes:
//   samples[pack][node] = factor[node] * f(node; coefficients[pack]).
// Built once per model; MODEL names the function that the model's file defines.
#include "prelude.clh"
#ifndef MODEL
#include "models/lambert.clh"
#define MODEL lambert
#endif

// geometry_rows: ROW_* x node_stride. model_coefficients: packs x LOBE_NUMBERS x REAL_WIDTH.
// samples: packs x node_stride x REAL_WIDTH, written from pack first_pack on.
// A work-item takes nodes_per_item consecutive nodes and runs over the packs inside, so that what depends on the node
// alone is computed once.
__kernel void sample_model(__global const double* restrict geometry_rows, const uint node_stride, const uint nodes,
                           const uint nodes_per_item, __global const double* restrict model_coefficients,
                           const uint packs, const uint first_pack, __global double* restrict samples) {
  const uint first = (uint)get_global_id(0) * nodes_per_item;
  const uint last = min(first + nodes_per_item, nodes);
  for (uint node = first; node < last; ++node) {
    geometry g;
    g.cos_i = SPLAT(geometry_rows[ROW_COS_I * node_stride + node]);
    g.cos_o = SPLAT(geometry_rows[ROW_COS_O * node_stride + node]);
    g.cos_h = SPLAT(geometry_rows[ROW_COS_H * node_stride + node]);
    g.cos_d = SPLAT(geometry_rows[ROW_COS_D * node_stride + node]);
    g.tan2_h = SPLAT(geometry_rows[ROW_TAN2_H * node_stride + node]);
    g.log_cos_h = SPLAT(geometry_rows[ROW_LOG_COS_H * node_stride + node]);
    g.log_rv = SPLAT(geometry_rows[ROW_LOG_RV * node_stride + node]);
#if ANISOTROPIC
    g.slope_x = SPLAT(geometry_rows[ROW_SLOPE_X * node_stride + node]);
    g.slope_y = SPLAT(geometry_rows[ROW_SLOPE_Y * node_stride + node]);
    g.in_x = SPLAT(geometry_rows[ROW_IN_X * node_stride + node]);
    g.in_y = SPLAT(geometry_rows[ROW_IN_Y * node_stride + node]);
#endif
    const pack factor = (pack)(geometry_rows[ROW_FACTOR * node_stride + node]);
    for (uint p = 0; p < packs; ++p) {
      const coefficients c = load_coefficients(p, model_coefficients);
      const size_t at = (size_t)(first_pack + p) * node_stride + node;
      STORE_PACK(factor * TO_PACK(MODEL(g, c)), at, samples);
    }
  }
}
