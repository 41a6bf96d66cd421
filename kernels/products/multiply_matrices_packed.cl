// Product of matrices on CPU devices: c = a diag(scale)^2 b, for a piece of each.
//
// b is packed once, in panels as wide as two vector registers. A work-item owns some rows of c: it packs a block of its
// rows of a into local memory, then fills c by tiles whose sums stay in registers. Every sum runs over blocks of
// DEPTH_BLOCK terms by fma, in order, and the blocks are added in double precision, in order; so it does not depend on
// how the matrices are cut into pieces, nor on which factor comes first.
#include "prelude.clh"

// Bytes of a vector register, set by the host. There are 32 registers of 64 bytes, or 16 of fewer: all but a few hold
// sums.
#ifndef VECTOR_BYTES
#define VECTOR_BYTES 64
#endif
#if VECTOR_BYTES == 64
#define TILE_ROWS 12
#define FOR_EACH_ROW(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(9) X(10) X(11)
#else
#define TILE_ROWS 6
#define FOR_EACH_ROW(X) X(0) X(1) X(2) X(3) X(4) X(5)
#endif

#if REAL_BITS == 64
#define NUMBER double
#else
#define NUMBER float
#endif
#if VECTOR_BYTES * 8 / REAL_BITS == 16
#define LANES 16
#elif VECTOR_BYTES * 8 / REAL_BITS == 8
#define LANES 8
#else
#define LANES 4
#endif
#define JOIN_EXPANDED(x, y) x##y
#define JOIN(x, y) JOIN_EXPANDED(x, y)

typedef NUMBER number;                    // double, or float
typedef JOIN(NUMBER, LANES) wide;         // a register of numbers
typedef JOIN(double, LANES) double_wide;  // as many doubles
#define TO_NUMBER(x) ((number)(x))
#define TO_WIDE(x) JOIN(JOIN(convert_, NUMBER), LANES)(x)
#define TO_DOUBLE_WIDE(x) JOIN(convert_double, LANES)(x)
#define LOAD_WIDE(index, pointer) JOIN(vload, LANES)(index, pointer)
#define STORE_WIDE(value, index, pointer) JOIN(vstore, LANES)(value, index, pointer)

#define TILE_COLUMNS (2 * LANES)
#define DEPTH_BLOCK 256
// Columns of b whose block stays in a core's cache while the rows of a work-item pass: 16 panels of 32 KiB.
#define CACHED_COLUMNS (16 * TILE_COLUMNS)

// packed[panel][x][column in the panel] = b[x][j] scale[x]; 0 for columns past the last.
// b: depth x columns in rows of b_stride; scale: depth values from first_scale on. global size: (panels, blocks of
// depth)
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void pack_columns(
    __global const double* restrict b, const uint b_stride, __global const double* restrict scale,
    const uint first_scale, const uint depth, const uint columns, __global number* restrict packed) {
  const uint column = (uint)get_global_id(0) * TILE_COLUMNS;
  const uint first = (uint)get_global_id(1) * DEPTH_BLOCK;
  const uint end = min(first + DEPTH_BLOCK, depth);
  __global number* out = packed + ((size_t)column * depth + (size_t)first * TILE_COLUMNS);
  for (uint x = first; x < end; ++x, out += TILE_COLUMNS) {
    __global const double* in = b + (size_t)x * b_stride + column;
    const double factor = scale[first_scale + x];
    if (column + TILE_COLUMNS <= columns) {
      STORE_WIDE(TO_WIDE(LOAD_WIDE(0, in) * factor), 0, out);
      STORE_WIDE(TO_WIDE(LOAD_WIDE(1, in) * factor), 1, out);
    } else {
      for (uint j = 0; j < TILE_COLUMNS; ++j) out[j] = TO_NUMBER(column + j < columns ? in[j] * factor : 0.0);
    }
  }
}

#define FOR_EACH_TERM(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)
#define PACK_TERM(term) packed[(x + term) * TILE_ROWS + row] = TO_NUMBER(scaled.s##term);

// packed[x][row] = a[row][x] scale[x] for the rows of a tile; 0 for rows past the last. Eight terms at a time.
void pack_rows(__global const double* a, const uint a_stride, __global const double* scale, const uint rows,
               const uint depth, __local number* packed) {
  uint x = 0;
  for (; x + 8 <= depth; x += 8) {
    const double8 factors = vload8(0, scale + x);
    for (uint row = 0; row < TILE_ROWS; ++row) {
      const double8 scaled = row < rows ? vload8(0, a + (size_t)row * a_stride + x) * factors : (double8)(0.0);
      FOR_EACH_TERM(PACK_TERM)
    }
  }
  for (; x < depth; ++x) {
    for (uint row = 0; row < TILE_ROWS; ++row) {
      packed[x * TILE_ROWS + row] = TO_NUMBER(row < rows ? a[(size_t)row * a_stride + x] * scale[x] : 0.0);
    }
  }
}

// Sets or raises the first `columns` values of a tile's row.
void put_row(const wide left, const wide right, const uint columns, const uint add, __global double* c) {
  const double_wide sum0 = TO_DOUBLE_WIDE(left);
  const double_wide sum1 = TO_DOUBLE_WIDE(right);
  if (columns >= TILE_COLUMNS) {
    STORE_WIDE(add ? LOAD_WIDE(0, c) + sum0 : sum0, 0, c);
    STORE_WIDE(add ? LOAD_WIDE(1, c) + sum1 : sum1, 1, c);
  } else {
    double sums[TILE_COLUMNS];
    STORE_WIDE(sum0, 0, sums);
    STORE_WIDE(sum1, 1, sums);
    for (uint j = 0; j < columns; ++j) c[j] = add ? c[j] + sums[j] : sums[j];
  }
}

#define DECLARE(row) wide a##row = (wide)((number)0), b##row = (wide)((number)0);

#define UPDATE(row)                        \
  {                                        \
    const wide factor = (wide)(left[row]); \
    a##row = fma(factor, right0, a##row);  \
    b##row = fma(factor, right1, b##row);  \
  }

#define PUT(row) \
  if (row < rows) put_row(a##row, b##row, columns, add, c + (size_t)(row)*c_stride);

// c (+)= left right for one tile. left: depth x TILE_ROWS; right: depth x TILE_COLUMNS.
void multiply_tile(__local const number* left, __global const number* right, const uint depth, const uint rows,
                   const uint columns, const uint add, __global double* c, const uint c_stride) {
  FOR_EACH_ROW(DECLARE)
  for (uint x = 0; x < depth; ++x) {
    const wide right0 = LOAD_WIDE(0, right);
    const wide right1 = LOAD_WIDE(1, right);
    FOR_EACH_ROW(UPDATE)
    left += TILE_ROWS;
    right += TILE_COLUMNS;
  }
  FOR_EACH_ROW(PUT)
}

// c (+)= a diag(scale) b. a: rows x depth in rows of a_stride; scale: depth values from first_scale on; packed: what
// pack_columns made of b; c: rows x columns in rows of c_stride, raised if `add` is 1, else set. global size: items of
// item_rows rows, a multiple of TILE_ROWS; block: room for item_rows x DEPTH_BLOCK.
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void multiply_matrices_packed(
    __global const double* restrict a, const uint a_stride, __global const double* restrict scale,
    const uint first_scale, __global const number* restrict packed, const uint rows, const uint depth,
    const uint columns, const uint add, __global double* restrict c, const uint c_stride, const uint item_rows,
    __local number* block) {
  const uint first_row = (uint)get_global_id(0) * item_rows;
  const uint own_rows = min(item_rows, rows - first_row);
  a += (size_t)first_row * a_stride;
  c += (size_t)first_row * c_stride;
  for (uint first = 0; first < depth; first += DEPTH_BLOCK) {
    const uint terms = min((uint)DEPTH_BLOCK, depth - first);
    for (uint row = 0; row < own_rows; row += TILE_ROWS) {
      pack_rows(a + (size_t)row * a_stride + first, a_stride, scale + first_scale + first, own_rows - row, terms,
                block + row * DEPTH_BLOCK);
    }
    for (uint cached = 0; cached < columns; cached += CACHED_COLUMNS) {
      const uint end = min(cached + CACHED_COLUMNS, columns);
      for (uint row = 0; row < own_rows; row += TILE_ROWS) {
        for (uint j = cached; j < end; j += TILE_COLUMNS) {
          multiply_tile(block + row * DEPTH_BLOCK, packed + ((size_t)j * depth + (size_t)first * TILE_COLUMNS), terms,
                        own_rows - row, columns - j, first > 0 ? 1 : add, c + (size_t)row * c_stride + j, c_stride);
        }
      }
    }
  }
}
