// Products of transformed isotropic tables, order by order: product = left right, in panels (isotropic.clh).
//
// A work-item owns a panel of columns of one order and goes down the rows tile by tile: two accumulators for each row
// stay in registers while it runs over the inner rings, reading a left value per row (broadcast) and two right vectors.
#include "products/isotropic.clh"

// As many rows as leave registers for the operands: 32 of 64 bytes, or 16 of 32.
#if VECTOR_BYTES == 64
#define TILE_ROWS 8
#define FOR_EACH_TILE_ROW(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)
#else
#define TILE_ROWS 6
#define FOR_EACH_TILE_ROW(X) X(0) X(1) X(2) X(3) X(4) X(5)
#endif
#include "prelude.clh"

#define DECLARE(r) wide a##r = (wide)((number)0), b##r = (wide)((number)0);

#define UPDATE(r)                                         \
  {                                                       \
    const wide factor = (wide)(left_tile[(r)*PANEL + x]); \
    a##r = fma(factor, right0, a##r);                     \
    b##r = fma(factor, right1, b##r);                     \
  }

#define STORE(r)                                    \
  STORE_WIDE(a##r, 2 * (r), product + row * PANEL); \
  STORE_WIDE(b##r, 2 * (r) + 1, product + row * PANEL);

// left: rows x inner, right: inner x columns, product: rows x columns, each [order][panel][row][PANEL] with rows padded
// to multiples of TILE_ROWS and so many numbers per order as the strides say. global size: (column panels, orders).
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void multiply_orders(
    __global const number* restrict left, __global const number* restrict right, __global number* restrict product,
    const uint padded_rows, const uint inner, const uint padded_inner, const ulong left_stride,
    const ulong right_stride, const ulong product_stride) {
  const size_t panel = get_global_id(0);
  const size_t order = get_global_id(1);
  left += order * left_stride;
  right += order * right_stride + panel * padded_inner * PANEL;
  product += order * product_stride + panel * padded_rows * PANEL;
  for (uint row = 0; row < padded_rows; row += TILE_ROWS) {
    FOR_EACH_TILE_ROW(DECLARE)
    __global const number* left_tile = left + row * PANEL;
    __global const number* right_row = right;
    for (uint first = 0; first < inner; first += PANEL) {
      const uint count = min((uint)PANEL, inner - first);
      for (uint x = 0; x < count; ++x) {
        const wide right0 = LOAD_WIDE(0, right_row);
        const wide right1 = LOAD_WIDE(1, right_row);
        FOR_EACH_TILE_ROW(UPDATE)
        right_row += PANEL;
      }
      left_tile += padded_rows * PANEL;
    }
    FOR_EACH_TILE_ROW(STORE)
  }
}
