// Differences of all pairs of rows, summed over nodes: sums[i][j] += sum over nodes of weight * DIFFERENCE(x_i - x_j).
//
// DIFFERENCE, set by the host: difference_square, d^2; difference_absolute, |d|; difference_two_thirds, |d|^(2/3).
// Differences are taken at the nodes, so close rows do not cancel as they would in products.
#include "prelude.clh"
#ifndef DIFFERENCE
#define DIFFERENCE difference_two_thirds
#endif

#if REAL_WIDTH == 8
typedef ulong8 bits;
#define AS_BITS(x) as_ulong8(x)
#define AS_PACK(x) as_double8(x)
#define UPPER_WORD(x) convert_uint8((x) >> 32)
#define LONG_WORD(x) convert_ulong8(x)
typedef uint8 words;
#define FOR_EACH_ROW(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)
#else
typedef ulong bits;
#define AS_BITS(x) as_ulong(x)
#define AS_PACK(x) as_double(x)
#define UPPER_WORD(x) ((uint)((x) >> 32))
#define LONG_WORD(x) ((ulong)(x))
typedef uint words;
#define FOR_EACH_ROW(X) X(0)
#endif

inline pack difference_square(const pack d) {
  return d * d;
}

inline pack difference_absolute(const pack d) {
  return fabs(d);
}

// x r with r = |x|^(-1/3) by Newton's iteration r <- r (4 - |x| r^3) / 3, which has no division and no branch: the
// runtime's cbrt() has both, and exp(2/3 ln x) costs three times as much. The first guess, a third of the exponent and
// of the mantissa's upper bits, is right to 4 %; three steps leave 1e-9. 0 gives 0; what is not finite stays so.
inline pack difference_two_thirds(const pack d) {
  const pack x = fabs(d);
  const words third = mul_hi(UPPER_WORD(AS_BITS(x)), (words)(0x55555556u));
  pack r = AS_PACK(LONG_WORD((words)(0x553ef0ffu) - third) << 32);
  for (int step = 0; step < 3; ++step) r *= fma(-x * r, r * r, (pack)(4.0)) * (pack)(1.0 / 3.0);
  return x * r;
}

#define DECLARE(row) pack sum##row = (pack)(0.0);

#define UPDATE(row) sum##row = fma(w, DIFFERENCE((pack)(rows[row]) - column), sum##row);

#define ADD(row)                                                                                               \
  {                                                                                                            \
    __global double* out = sums + ((size_t)REAL_WIDTH * (first_row + i) + row) * sums_stride + REAL_WIDTH * j; \
    STORE_PACK(LOAD_PACK(0, out) + sum##row, 0, out);                                                          \
  }

// mapped: packs x node_stride x REAL_WIDTH, of which the nodes first_node .. first_node+nodes-1 are added. Packs
// first_row .. first_row + global size - 1 are compared among themselves, pack by pack, on and right of the diagonal.
// sums: rows x sums_stride, columns relative to first_row.
__kernel void accumulate_pairs(__global const double* restrict mapped, const uint node_stride, const uint first_node,
                               const uint nodes, __global const double* restrict weight, const uint first_row,
                               __global double* restrict sums, const uint sums_stride) {
  const uint i = (uint)get_global_id(0);
  const uint j = (uint)get_global_id(1);
  if (j < i) return;

  __global const double* rows = mapped + ((size_t)(first_row + i) * node_stride + first_node) * REAL_WIDTH;
  __global const double* columns = mapped + ((size_t)(first_row + j) * node_stride + first_node) * REAL_WIDTH;
  FOR_EACH_ROW(DECLARE)
  for (uint node = 0; node < nodes; ++node) {
    const pack w = (pack)(weight[first_node + node]);
    const pack column = LOAD_PACK(0, columns);
    FOR_EACH_ROW(UPDATE)
    rows += REAL_WIDTH;
    columns += REAL_WIDTH;
  }
  FOR_EACH_ROW(ADD)
}
