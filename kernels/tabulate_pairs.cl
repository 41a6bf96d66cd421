// Values of one model for pairs of directions, averaged over the samples of each direction:
//   values[row][column] (+)= sum over lobes of weight / (row samples * column samples) *
//                            sum over samples of f(in; out)
// Packs run over columns. Built once per model; MODEL names the function that the model's file defines.
#include "prelude.clh"
#ifndef MODEL
#include "models/lambert.clh"
#define MODEL lambert
#endif

// ln(1 + x) to full relative accuracy by ln(u) x / (u - 1), u = fl(1 + x) (Kahan); log1p itself has no vector form in
// PoCL.
pack log_1p(const pack x) {
  const pack u = 1.0 + x;
  const pack below = u - 1.0;
  return below == 0.0 ? x : log(u) * x / below;
}

// L and V as unit vectors; L + V = (across, along), whose part along the base plane is the m of eq. 4.1.
geometry pair_geometry(const pack in_x, const pack in_y, const pack in_z, const pack out_x, const pack out_y,
                       const pack out_z) {
  const pack across_x = in_x + out_x;
  const pack across_y = in_y + out_y;
  const pack across2 = across_x * across_x + across_y * across_y;
  const pack along = in_z + out_z;
  const pack difference = in_z - out_z;
  const pack length = sqrt(across2 + along * along);
  const pack tan2_h = across2 / (along * along);
  const pack deficit = 0.5 * (difference * difference + across2);  // 1 - R.V
  const pack nothing = (pack)(-1e30);
  geometry g;
  g.cos_i = TO_REAL(in_z);
  g.cos_o = TO_REAL(out_z);
  g.cos_h = TO_REAL(along / length);
  g.cos_d = TO_REAL(0.5 * length);
  g.tan2_h = TO_REAL(tan2_h);
  g.log_cos_h = TO_REAL(-0.5 * log_1p(tan2_h));
  g.log_rv = TO_REAL(deficit < 1.0 ? log_1p(-fmin(deficit, (pack)(0.9999999999999999))) : nothing);
#if ANISOTROPIC
  g.slope_x = TO_REAL(across_x / along);
  g.slope_y = TO_REAL(across_y / along);
  g.in_x = TO_REAL(in_x);
  g.in_y = TO_REAL(in_y);
#endif
  return g;
}

// rows_xyz: 3 x row_samples x rows. columns_xyz: 3 x column_samples x column_stride, column_stride a multiple of
// REAL_WIDTH. first_column: the first column wanted, by row. model_coefficients: lobes x (LOBE_NUMBERS + 1), the last
// the weight.
// values: rows x columns, from row first_row on. With `accumulate` 0 values are written, else added to.
// global size: (column chunks of chunk_packs packs, rows of this call)
__kernel void tabulate_pairs(__global const double* restrict rows_xyz, const uint rows, const uint row_samples,
                             const uint first_row, __global const double* restrict columns_xyz, const uint columns,
                             const uint column_stride, const uint column_samples,
                             __global const uint* restrict first_column,
                             __global const double* restrict model_coefficients, const uint lobes,
                             const uint chunk_packs, const uint accumulate, __global double* restrict values) {
  const uint row = first_row + (uint)get_global_id(1);
  const uint first = (uint)get_global_id(0) * chunk_packs;
  const uint last = min(first + chunk_packs, column_stride / REAL_WIDTH);
  const uint row_plane = rows * row_samples;
  const uint column_plane = column_stride * column_samples;
  const double share = 1.0 / ((double)row_samples * (double)column_samples);
  __global double* out = values + (size_t)get_global_id(1) * columns;
  for (uint p = max(first, first_column[row] / REAL_WIDTH); p < last; ++p) {
    pack total = (pack)(0.0);
    for (uint lobe = 0; lobe < lobes; ++lobe) {
      __global const double* lobe_coefficients = model_coefficients + lobe * (LOBE_NUMBERS + 1);
      const coefficients c = splat_coefficients(lobe_coefficients);
      pack sum = (pack)(0.0);
      for (uint s = 0; s < row_samples; ++s) {
        const uint at = s * rows + row;
        const pack in_x = (pack)(rows_xyz[at]);
        const pack in_y = (pack)(rows_xyz[row_plane + at]);
        const pack in_z = (pack)(rows_xyz[2 * row_plane + at]);
        for (uint t = 0; t < column_samples; ++t) {
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
