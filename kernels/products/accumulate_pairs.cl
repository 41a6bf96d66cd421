// Differences of all pairs of rows, summed over nodes: sums[i][j] += sum over nodes of DIFFERENCE(x_i - x_j).
//
// DIFFERENCE, set by the host: add_square, d^2; add_absolute, |d|; add_two_thirds, |d|^(2/3).
// Differences are taken at the nodes, so close rows do not cancel as they would in products. Weights of nodes are
// within the rows.
#include "prelude.clh"
#ifndef DIFFERENCE
#define DIFFERENCE add_two_thirds
#endif

#if REAL_WIDTH == 8
typedef float8 half_pack;  // single precision
typedef int8 bits;
#define TO_HALF(x) convert_float8(x)
#define FROM_HALF(x) convert_double8(x)
#define AS_BITS(x) as_int8(x)
#define AS_HALF(x) as_float8(x)
#define HALF_OF_BITS(x) convert_float8(x)
#define BITS_OF_HALF(x) convert_int8(x)
#define FOR_EACH_ROW(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)
#else
typedef float half_pack;
typedef int bits;
#define TO_HALF(x) ((float)(x))
#define FROM_HALF(x) ((double)(x))
#define AS_BITS(x) as_int(x)
#define AS_HALF(x) as_float(x)
#define HALF_OF_BITS(x) ((float)(x))
#define BITS_OF_HALF(x) ((int)(x))
#define FOR_EACH_ROW(X) X(0)
#endif

inline pack add_square(const pack d, const pack sum) {
  return fma(d, d, sum);
}

inline pack add_absolute(const pack d, const pack sum) {
  return sum + fabs(d);
}

// x r with r = |x|^(-1/3), in single precision once the difference is taken: right to 2e-7. The first guess of r takes
// a third of the number's bits and is right to 3.5 %; with e = 1 - |x| r^3 the series of (1 - e)^(-1/3) leaves 3e-5
// after e^3, and a second one 1e-9 after e. The runtime's cbrt() has divisions and branches. 0 and what is below 1e-38
// give 0; what is not finite stays so.
inline pack add_two_thirds(const pack d, const pack sum) {
  const half_pack x = TO_HALF(fabs(d));
  const half_pack third = fma(HALF_OF_BITS(AS_BITS(x)), (half_pack)(-1.0f / 3.0f), (half_pack)(1419900000.0f));
  half_pack r = AS_HALF(BITS_OF_HALF(third));
  half_pack e = fma(-x * r, r * r, (half_pack)(1.0f));
  const half_pack series =
      fma(e, fma(e, (half_pack)(14.0f / 81.0f), (half_pack)(2.0f / 9.0f)), (half_pack)(1.0f / 3.0f));
  r = fma(r * e, series, r);
  const half_pack y = x * r;
  e = fma(-y, r * r, (half_pack)(1.0f));
  return sum + FROM_HALF(fma(y * e, (half_pack)(1.0f / 3.0f), y));
}

#define DECLARE(row) pack sum##row = (pack)(0.0);

#define UPDATE(row) sum##row = DIFFERENCE((pack)(rows[row]) - column, sum##row);

#define ADD(row)                                                                                               \
  {                                                                                                            \
    __global double* out = sums + ((size_t)REAL_WIDTH * (first_sum + i) + row) * sums_stride + REAL_WIDTH * j; \
    STORE_PACK(LOAD_PACK(0, out) + sum##row, 0, out);                                                          \
  }

// mapped: packs x node_stride x REAL_WIDTH, of which the nodes first_node .. first_node+nodes-1 are added. Packs from
// first_row on are compared with those from first_column on, as many as the global size has, pack by pack, but for
// those left of the diagonal. sums: rows from pack first_sum on x sums_stride.
__kernel void accumulate_pairs(__global const double* restrict mapped, const uint node_stride, const uint first_node,
                               const uint nodes, const uint first_row, const uint first_column,
                               __global double* restrict sums, const uint first_sum, const uint sums_stride) {
  const uint i = (uint)get_global_id(0);
  const uint j = (uint)get_global_id(1);
  if (first_column + j < first_row + i) return;

  __global const double* rows = mapped + ((size_t)(first_row + i) * node_stride + first_node) * REAL_WIDTH;
  __global const double* columns = mapped + ((size_t)(first_column + j) * node_stride + first_node) * REAL_WIDTH;
  FOR_EACH_ROW(DECLARE)
  for (uint node = 0; node < nodes; ++node) {
    const pack column = LOAD_PACK(0, columns);
    FOR_EACH_ROW(UPDATE)
    rows += REAL_WIDTH;
    columns += REAL_WIDTH;
  }
  FOR_EACH_ROW(ADD)
}
