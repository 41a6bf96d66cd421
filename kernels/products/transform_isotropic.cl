// Cosine transform over azimuth of an isotropic table, for one or both sides of a product.
#include "prelude.clh"
#include "products/isotropic.clh"

#define LOAD_ROW(lane) double8 r##lane = vload8(0, table + min((uint)(lane), last) * points + k);
#define STORE_COLUMN(i) vstore8(NUMBER8(r##i), 0, samples + (k + (i)) * PANEL);

// samples[k][lane] = table[lane][k] for eight pairs; lanes beyond the last pair repeat it.
void transpose_in(__global const double* restrict table, const uint last, const uint points, __local number* samples) {
  uint k = 0;
  for (; k + 8 <= points; k += 8) {
    FOR_EACH_OF_8(LOAD_ROW)
    TRANSPOSE_8X8
    FOR_EACH_OF_8(STORE_COLUMN)
  }
  for (; k < points; ++k) {
    for (uint lane = 0; lane < 8; ++lane) samples[k * PANEL + lane] = (number)table[min(lane, last) * points + k];
  }
}

// A transform of L+1 points in place becomes one of the sums f[k] + f[L-k], for even orders, which are left at the
// first half of the points, and one of the differences f[k] - f[L-k], for odd orders, left at L-k. Again for the sums.
void fold(__local number* samples, uint length, const uint levels) {
  for (uint level = 0; level < levels; ++level) {
    for (uint k = 0; 2 * k <= length; ++k) {
      __local number* head = samples + k * PANEL;
      __local number* tail = samples + (length - k) * PANEL;
      const wide head0 = LOAD_WIDE(0, head), head1 = LOAD_WIDE(1, head);
      const wide tail0 = LOAD_WIDE(0, tail), tail1 = LOAD_WIDE(1, tail);
      STORE_WIDE(head0 - tail0, 0, tail);
      STORE_WIDE(head1 - tail1, 1, tail);
      STORE_WIDE(head0 + tail0, 0, head);  // last: the point in the middle is its own mirror image and counts twice
      STORE_WIDE(head1 + tail1, 1, head);
    }
    length /= 2;
  }
}

// table: rows x columns x points, points = n_phi/2 + 1. Of its orders, first_order .. end_order-1 are made, by the
// strips first_strip .. end_strip-1. scale: a factor for each inner ring, with which the columns of a left operand and
// the rows of a right one are multiplied. sides: 1 for left, 2 for right, 3 for both, each [order][panel][row][PANEL]
// with order_stride numbers per order; rows beyond the last, up to the padded number, repeat it. samples, outputs:
// points x PANEL and STRIP x PANEL numbers. global size: (panels, padded rows).
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void transform_isotropic(
    __global const double* restrict table, const uint rows, const uint columns, const uint points, const uint levels,
    __global const strip* restrict strips, const uint first_strip, const uint end_strip, const uint first_order,
    const uint end_order, __global const number* restrict coefficients, __global const number* restrict scale,
    const uint sides, __global number* restrict left, __global number* restrict right, const ulong order_stride,
    __local number* restrict samples, __local number* restrict outputs) {
  const uint panel = (uint)get_global_id(0);
  const uint padded_row = (uint)get_global_id(1);
  const uint row = min(padded_row, rows - 1);
  for (uint lane = 0; lane < PANEL; lane += 8) {
    const uint column = min(panel * PANEL + lane, columns - 1);
    transpose_in(table + ((size_t)row * columns + column) * points, columns - 1 - column, points, samples + lane);
  }
  fold(samples, points - 1, levels);

  const size_t place = ((size_t)panel * get_global_size(1) + padded_row) * PANEL;
  for (uint s = first_strip; s < end_strip; ++s) {
    const uint order = strips[s].output;
    const uint next_order = s + 1 < end_strip ? strips[s + 1].output : end_order;
    apply_strip(coefficients + strips[s].entry, strips[s].inputs, samples + strips[s].input * PANEL, outputs);
    for (uint r = 0; r < next_order - order; ++r) {
      const size_t at = (order - first_order + r) * order_stride + place;
      for (uint part = 0; part < 2; ++part) {
        const wide value = LOAD_WIDE(2 * r + part, outputs);
        if (sides & 1) STORE_WIDE(value * LOAD_WIDE(2 * panel + part, scale), part, left + at);
        if (sides & 2) STORE_WIDE(value * (wide)(scale[row]), part, right + at);
      }
    }
  }
}
