// Back from orders to azimuths: the inverse cosine transform of a product of isotropic tables.
#include "prelude.clh"
#include "products/isotropic.clh"

#define LOAD_COLUMN(i) double8 r##i = DOUBLE8(vload8(0, samples + (k + (i)) * PANEL));
#define STORE_ROW(lane)                                       \
  if (lane < lanes) {                                         \
    __global double* out = table + (size_t)(lane)*points + k; \
    if (accumulate) r##lane += vload8(0, out);                \
    vstore8(r##lane, 0, out);                                 \
  }

// table[lane][k] = samples[k][lane], or +=, for the first `lanes` of eight pairs.
void transpose_out(__local const number* samples, const uint points, const uint lanes, const uint accumulate,
                   __global double* restrict table) {
  uint k = 0;
  for (; k + 8 <= points; k += 8) {
    FOR_EACH_OF_8(LOAD_COLUMN)
    TRANSPOSE_8X8
    FOR_EACH_OF_8(STORE_ROW)
  }
  for (; k < points; ++k) {
    for (uint lane = 0; lane < lanes; ++lane) {
      __global double* out = table + (size_t)lane * points + k;
      *out = (accumulate ? *out : 0.0) + (double)samples[k * PANEL + lane];
    }
  }
}

// The transpose of fold() in transform_isotropic.cl: sums of even orders at k and of odd orders at L-k become values.
void unfold(__local number* samples, const uint length, const uint levels) {
  for (uint level = levels; level-- > 0;) {
    const uint last = length >> level;
    for (uint k = 0; 2 * k < last; ++k) {
      __local number* head = samples + k * PANEL;
      __local number* tail = samples + (last - k) * PANEL;
      const wide even0 = LOAD_WIDE(0, head), even1 = LOAD_WIDE(1, head);
      const wide odd0 = LOAD_WIDE(0, tail), odd1 = LOAD_WIDE(1, tail);
      STORE_WIDE(even0 + odd0, 0, head);
      STORE_WIDE(even1 + odd1, 1, head);
      STORE_WIDE(even0 - odd0, 0, tail);
      STORE_WIDE(even1 - odd1, 1, tail);
    }
  }
}

// product: [order][panel][row][PANEL] of the orders first_order .. end_order-1, with padded_rows rows and order_stride
// numbers per order. table: rows x columns x points, set where accumulate is 0, else added to.
// orders, samples: (end_order - first_order) x PANEL and (points + STRIP - 1) x PANEL numbers.
// global size: (panels, rows).
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void restore_isotropic(
    __global const number* restrict product, const uint padded_rows, const ulong order_stride, const uint first_order,
    const uint end_order, __global const strip* restrict strips, const uint strip_count,
    __global const number* restrict coefficients, const uint levels, const uint accumulate,
    __global double* restrict table, const uint columns, const uint points, __local number* restrict orders,
    __local number* restrict samples) {
  const uint panel = (uint)get_global_id(0);
  const size_t row = get_global_id(1);
  product += (panel * padded_rows + row) * PANEL;
  for (uint order = 0; order < end_order - first_order; ++order) {
    STORE_WIDE(LOAD_WIDE(0, product + order * order_stride), 2 * order, orders);
    STORE_WIDE(LOAD_WIDE(1, product + order * order_stride), 2 * order + 1, orders);
  }

  // In ascending order of outputs: what a strip writes beyond its last output is overwritten by the next.
  for (uint s = 0; s < strip_count; ++s) {
    const uint begin = max(strips[s].input, first_order);
    const uint end = max(min(strips[s].input + strips[s].inputs, end_order), begin);
    apply_strip(coefficients + strips[s].entry + (begin - strips[s].input) * STRIP, end - begin,
                orders + (begin - first_order) * PANEL, samples + strips[s].output * PANEL);
  }
  unfold(samples, points - 1, levels);

  for (uint lane = 0; lane < PANEL; lane += 8) {
    const uint column = panel * PANEL + lane;
    if (column >= columns) break;
    transpose_out(samples + lane, points, min(8u, columns - column), accumulate,
                  table + (row * columns + column) * points);
  }
}
