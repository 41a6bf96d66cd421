// Linear maps of segments of rows that are stored in packs:
//   to[pack][target + y] = sum over x < count of from[pack][source + x step] table[entry + x stride + y],  y < columns
// A work-item owns three packs of rows and takes eight columns at a time: 24 sums stay in registers. What is left of
// the packs, one or two, is taken one by one.
#include "prelude.clh"

#define TILE 8
#define FOR_EACH_OF_TILE(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)

#define DECLARE(k) pack a##k = (pack)(0.0), b##k = (pack)(0.0), c##k = (pack)(0.0);

#define UPDATE(k)                  \
  {                                \
    const pack t = (pack)(row[k]); \
    a##k = fma(value0, t, a##k);   \
    b##k = fma(value1, t, b##k);   \
    c##k = fma(value2, t, c##k);   \
  }

#define STORE(k)                                    \
  if (y + (k) < s.columns) {                        \
    STORE_PACK(a##k, y + (k), out);                 \
    STORE_PACK(b##k, to_stride + y + (k), out);     \
    STORE_PACK(c##k, 2 * to_stride + y + (k), out); \
  }

// As MapSegment of the host.
typedef struct {
  uint source, step, count, target, columns, entry, stride;
} segment;

// from: packs x from_stride x REAL_WIDTH; to: packs x to_stride x REAL_WIDTH. table: rows of each segment, their
// columns padded to a multiple of TILE. global size: (packs / 3, segments).
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void map_segments(
    __global const double* restrict from, const uint from_stride, __global double* restrict to, const uint to_stride,
    __global const segment* restrict segments, __global const double* restrict table) {
  const size_t p = 3 * get_global_id(0);
  const segment s = segments[get_global_id(1)];
  __global double* out = to + (p * to_stride + s.target) * REAL_WIDTH;
  for (uint y = 0; y < s.columns; y += TILE) {
    __global const double* row = table + s.entry + y;
    __global const double* in = from + (p * from_stride + s.source) * REAL_WIDTH;
    FOR_EACH_OF_TILE(DECLARE)
    for (uint x = 0; x < s.count; ++x) {
      const pack value0 = LOAD_PACK(0, in);
      const pack value1 = LOAD_PACK(from_stride, in);
      const pack value2 = LOAD_PACK(2 * from_stride, in);
      FOR_EACH_OF_TILE(UPDATE)
      in += s.step * REAL_WIDTH;
      row += s.stride;
    }
    FOR_EACH_OF_TILE(STORE)
  }
}

#define DECLARE_ONE(k) pack only##k = (pack)(0.0);
#define UPDATE_ONE(k) only##k = fma(value, (pack)(row[k]), only##k);
#define STORE_ONE(k) \
  if (y + (k) < s.columns) STORE_PACK(only##k, y + (k), out);

// As map_segments(), for one pack at a time from first_pack on. global size: (packs, segments).
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void map_segments_of_pack(
    __global const double* restrict from, const uint from_stride, __global double* restrict to, const uint to_stride,
    __global const segment* restrict segments, __global const double* restrict table, const uint first_pack) {
  const size_t p = first_pack + get_global_id(0);
  const segment s = segments[get_global_id(1)];
  __global double* out = to + (p * to_stride + s.target) * REAL_WIDTH;
  for (uint y = 0; y < s.columns; y += TILE) {
    __global const double* row = table + s.entry + y;
    __global const double* in = from + (p * from_stride + s.source) * REAL_WIDTH;
    FOR_EACH_OF_TILE(DECLARE_ONE)
    for (uint x = 0; x < s.count; ++x) {
      const pack value = LOAD_PACK(0, in);
      FOR_EACH_OF_TILE(UPDATE_ONE)
      in += s.step * REAL_WIDTH;
      row += s.stride;
    }
    FOR_EACH_OF_TILE(STORE_ONE)
  }
}
