// Batched matrix product for devices whose work-items are the lanes (GPUs): square tiles through local memory. The
// three stages of an isotropic product are such products, with different strides.
#include "prelude.clh"

#define TILE 16

#if REAL_BITS == 64
typedef double number;
#else
typedef float number;
#endif

// Where a batch of matrices begins, and the elements between neighbours.
typedef struct {
  ulong first, batch, row, column;
} strides;

// out[b] = left[b] right[b], times factor at batch b and column j (factor_strides.row is not used), or += where
// accumulate is not 0. left: rows x inner, right: inner x columns.
// global size: columns and rows rounded up to TILE, batches; local size: TILE x TILE x 1.
__kernel __attribute__((reqd_work_group_size(TILE, TILE, 1))) void multiply_strided(
    const uint rows, const uint inner, const uint columns, __global const double* restrict left,
    const strides left_strides, __global const double* restrict right, const strides right_strides,
    __global const double* restrict factor, const strides factor_strides, const uint accumulate,
    __global double* restrict out, const strides out_strides) {
  __local number left_tile[TILE][TILE + 1];
  __local number right_tile[TILE][TILE + 1];
  const uint x = (uint)get_local_id(0);
  const uint y = (uint)get_local_id(1);
  const uint column0 = (uint)get_group_id(0) * TILE;
  const uint row0 = (uint)get_group_id(1) * TILE;
  const size_t batch = get_global_id(2);
  left += left_strides.first + batch * left_strides.batch;
  right += right_strides.first + batch * right_strides.batch;

  // Neighbouring work-items read neighbouring elements, whichever way a matrix lies.
  const bool left_along_rows = left_strides.row == 1;
  const bool right_along_rows = right_strides.row == 1;
  const uint left_row = left_along_rows ? x : y, left_column = left_along_rows ? y : x;
  const uint right_row = right_along_rows ? x : y, right_column = right_along_rows ? y : x;

  number sum = 0;
  for (uint first = 0; first < inner; first += TILE) {
    const uint i = row0 + left_row, left_k = first + left_column;
    const uint j = column0 + right_column, right_k = first + right_row;
    left_tile[left_row][left_column] =
        i < rows && left_k < inner ? (number)left[i * left_strides.row + left_k * left_strides.column] : (number)0;
    right_tile[right_row][right_column] = right_k < inner && j < columns
                                              ? (number)right[right_k * right_strides.row + j * right_strides.column]
                                              : (number)0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint k = 0; k < TILE; ++k) sum = fma(left_tile[y][k], right_tile[k][x], sum);
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  const uint row = row0 + y;
  const uint column = column0 + x;
  if (row >= rows || column >= columns) return;
  const number scaled = sum * (number)factor[batch * factor_strides.batch + column * factor_strides.column];
  out += batch * out_strides.batch + row * out_strides.row + column * out_strides.column;
  *out = (accumulate ? *out : 0.0) + (double)scaled;
}
