// Values of one model for pairs of directions, averaged over the points of each direction:
//   values[row][column] (+)= sum over lobes of weight / (row points * column points) *
//                            sum over points of f(in; out)
// Packs run over columns. Built once per model; MODEL names the function that the model's file defines.
#include "lobes/pair_geometry.clh"
#ifndef MODEL
#include "models/lambert.clh"
#define MODEL lambert
#endif

// rows_xyz: 3 x row_points x rows. columns_xyz: 3 x column_points x column_stride, column_stride a multiple of
// REAL_WIDTH. first_column: the first column wanted, by row. model_coefficients: lobes x (LOBE_NUMBERS + 1), the last
// the weight.
// values: rows x columns, from row first_row on. With `accumulate` 0 values are written, else added to.
// global size: (column chunks of chunk_packs packs, rows of this call)
__kernel void tabulate_pairs(__global const double* restrict rows_xyz, const uint rows, const uint row_points,
                             const uint first_row, __global const double* restrict columns_xyz, const uint columns,
                             const uint column_stride, const uint column_points,
                             __global const uint* restrict first_column,
                             __global const double* restrict model_coefficients, const uint lobes,
                             const uint chunk_packs, const uint accumulate, __global double* restrict values) {
  const uint row = first_row + (uint)get_global_id(1);
  const uint first = (uint)get_global_id(0) * chunk_packs;
  const uint last = min(first + chunk_packs, column_stride / REAL_WIDTH);
  const uint row_plane = rows * row_points;
  const uint column_plane = column_stride * column_points;
  const double share = 1.0 / ((double)row_points * (double)column_points);
  __global double* out = values + (size_t)get_global_id(1) * columns;
  for (uint p = max(first, first_column[row] / REAL_WIDTH); p < last; ++p) {
    pack total = (pack)(0.0);
    for (uint lobe = 0; lobe < lobes; ++lobe) {
      __global const double* lobe_coefficients = model_coefficients + lobe * (LOBE_NUMBERS + 1);
      const coefficients c = splat_coefficients(lobe_coefficients);
      pack sum = (pack)(0.0);
      for (uint s = 0; s < row_points; ++s) {
        const uint at = s * rows + row;
        const pack in_x = (pack)(rows_xyz[at]);
        const pack in_y = (pack)(rows_xyz[row_plane + at]);
        const pack in_z = (pack)(rows_xyz[2 * row_plane + at]);
        for (uint t = 0; t < column_points; ++t) {
          __global const double* column = columns_xyz + t * column_stride;
          const pack out_x = LOAD_PACK(p, column);
          const pack out_y = LOAD_PACK(p, column + column_plane);
          const pack out_z = LOAD_PACK(p, column + 2 * column_plane);
          sum += TO_PACK(MODEL(pair_geometry(in_x, in_y, in_z, out_x, out_y, out_z), c));
        }
      }
      total += lobe_coefficients[LOBE_NUMBERS] * share * sum;
    }
#if REAL_WIDTH == 8
    if (8 * p + 8 <= columns) {
      vstore8(accumulate ? vload8(p, out) + total : total, p, out);
    } else {
      double lanes[8];
      vstore8(total, 0, lanes);
      for (uint k = 0; 8 * p + k < columns; ++k) {
        out[8 * p + k] = accumulate ? out[8 * p + k] + lanes[k] : lanes[k];
      }
    }
#else
    if (p < columns) out[p] = accumulate ? out[p] + total : total;
#endif
  }
}
