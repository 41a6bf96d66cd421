// Product of matrices in scalar packs (GPUs): c = a diag(scale)^2 b for a piece of each, by tiles through local memory.
//
// Sums run in the same order and precision as in multiply_matrices_packed.cl: fma over blocks of DEPTH_BLOCK terms,
// blocks added in double precision.
#include "prelude.clh"

#if REAL_BITS == 64
typedef double number;
typedef double4 number4;
#else
typedef float number;
typedef float4 number4;
#endif

#define GROUP 16          // work-items each way
#define TILE (4 * GROUP)  // rows and columns of c that a group owns; an item has 4 x 4 of them
#define STEP GROUP        // terms that are in local memory at a time
#define DEPTH_BLOCK 256

#define FOR_EACH_ROW(X) X(0) X(1) X(2) X(3)
#define DECLARE(r) double4 total##r = add && row + r < rows ? get_row(kept, out + (r)*c_stride) : (double4)(0.0);
#define CLEAR(r) number4 sum##r = (number4)((number)0);
#define UPDATE(r) sum##r = fma((number4)(left[r]), right, sum##r);
#define ADD(r) total##r += convert_double4(sum##r);
#define PUT(r) \
  if (row + r < rows) put_row(total##r, kept, out + (r)*c_stride);

// Loads a step of a: tile[x][row] = a[row][x] scale[x], 0 outside.
void load_left(__global const double* a, const uint a_stride, __global const double* scale, const uint rows,
               const uint depth, __local number (*tile)[TILE + 1]) {
  const uint x = (uint)get_local_id(0);
  for (uint row = (uint)get_local_id(1); row < TILE; row += GROUP) {
    tile[x][row] = (number)(row < rows && x < depth ? a[(size_t)row * a_stride + x] * scale[x] : 0.0);
  }
}

// Loads a step of b: tile[x][column] = b[x][column] scale[x], 0 outside.
void load_right(__global const double* b, const uint b_stride, __global const double* scale, const uint depth,
                const uint columns, __local number (*tile)[TILE]) {
  const uint x = (uint)get_local_id(1);
  for (uint column = (uint)get_local_id(0); column < TILE; column += GROUP) {
    tile[x][column] = (number)(column < columns && x < depth ? b[(size_t)x * b_stride + column] * scale[x] : 0.0);
  }
}

// The first `columns` of four values; 0 for the others.
double4 get_row(const uint columns, __global const double* c) {
  double values[4] = {0.0, 0.0, 0.0, 0.0};
  for (uint j = 0; j < columns; ++j) values[j] = c[j];
  return vload4(0, values);
}

// Sets the first `columns` of four values.
void put_row(const double4 total, const uint columns, __global double* c) {
  double values[4];
  vstore4(total, 0, values);
  for (uint j = 0; j < columns; ++j) c[j] = values[j];
}

// c (+)= a diag(scale)^2 b. a: rows x depth, b: depth x columns, c: rows x columns, in rows of the strides; scale:
// depth values from first_scale on; c is raised if `add` is 1, else set. global size: columns and rows over 4, in whole
// groups.
__kernel __attribute__((reqd_work_group_size(GROUP, GROUP, 1))) void multiply_matrices_tiles(
    __global const double* restrict a, const uint a_stride, __global const double* restrict b, const uint b_stride,
    __global const double* restrict scale, const uint first_scale, const uint rows, const uint depth,
    const uint columns, const uint add, __global double* restrict c, const uint c_stride) {
  __local number left_tile[STEP][TILE + 1];
  __local number right_tile[STEP][TILE];
  const uint x_item = (uint)get_local_id(0);
  const uint y_item = (uint)get_local_id(1);
  const uint tile_row = (uint)get_group_id(1) * TILE;
  const uint tile_column = (uint)get_group_id(0) * TILE;

  const uint row = tile_row + 4 * y_item;
  const uint column = tile_column + 4 * x_item;
  const uint kept = min(4u, columns - min(column, columns));  // of the item's columns
  const bool inside = kept > 0 && row < rows;                 // items outside only help to load
  __global double* out = c + (size_t)row * c_stride + column;

  FOR_EACH_ROW(DECLARE)
  for (uint first = 0; first < depth; first += DEPTH_BLOCK) {
    const uint end = min(first + DEPTH_BLOCK, depth);
    FOR_EACH_ROW(CLEAR)
    for (uint start = first; start < end; start += STEP) {
      __global const double* factors = scale + first_scale + start;
      load_left(a + (size_t)tile_row * a_stride + start, a_stride, factors, rows - tile_row, end - start, left_tile);
      load_right(b + (size_t)start * b_stride + tile_column, b_stride, factors, end - start, columns - tile_column,
                 right_tile);
      barrier(CLK_LOCAL_MEM_FENCE);
      for (uint x = 0; inside && x < STEP; ++x) {
        __local const number* left = left_tile[x] + 4 * y_item;
        const number4 right = vload4(x_item, right_tile[x]);
        FOR_EACH_ROW(UPDATE)
      }
      barrier(CLK_LOCAL_MEM_FENCE);
    }
    FOR_EACH_ROW(ADD)
  }
  FOR_EACH_ROW(PUT)
}
