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
__kernel void evaluate_lobes(__global const double* restrict geometry_rows, const uint node_stride, const uint nodes,
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
      // Here and not in a function: compilers call it, and 1 KiB of constants goes through memory for each pack.
      const uint numbers = LOBE_NUMBERS * p;
      coefficients c;
      c.c0 = TO_REAL(LOAD_PACK(numbers, model_coefficients));
      c.c1 = TO_REAL(LOAD_PACK(numbers + 1, model_coefficients));
      c.c2 = TO_REAL(LOAD_PACK(numbers + 2, model_coefficients));
      c.c3 = TO_REAL(LOAD_PACK(numbers + 3, model_coefficients));
      c.c4 = TO_REAL(LOAD_PACK(numbers + 4, model_coefficients));
      c.c5 = TO_REAL(LOAD_PACK(numbers + 5, model_coefficients));
      c.c6 = TO_REAL(LOAD_PACK(numbers + 6, model_coefficients));
      c.c7 = TO_REAL(LOAD_PACK(numbers + 7, model_coefficients));
      c.c8 = TO_REAL(LOAD_PACK(numbers + 8, model_coefficients));
      c.c9 = TO_REAL(LOAD_PACK(numbers + 9, model_coefficients));
      c.c10 = TO_REAL(LOAD_PACK(numbers + 10, model_coefficients));
      c.c11 = TO_REAL(LOAD_PACK(numbers + 11, model_coefficients));
      c.c12 = TO_REAL(LOAD_PACK(numbers + 12, model_coefficients));
      c.c13 = TO_REAL(LOAD_PACK(numbers + 13, model_coefficients));
      c.c14 = TO_REAL(LOAD_PACK(numbers + 14, model_coefficients));
      c.c15 = TO_REAL(LOAD_PACK(numbers + 15, model_coefficients));
#if CURVES
      c.curves = model_coefficients + (size_t)(numbers + COEFFICIENTS) * REAL_WIDTH;
      c.curve_step = REAL_WIDTH;
      c.curve_lane = 1;
#endif
      const size_t at = (size_t)(first_pack + p) * node_stride + node;
      STORE_PACK(factor * TO_PACK(MODEL(g, c)), at, samples);
    }
  }
}
