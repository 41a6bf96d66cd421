// Symmetric rank-k update gram += S S^T for samples in packs of eight lobes, upper triangle by tiles.
//
// A work-item owns a tile of 8 x 24 lobes: 24 accumulators of eight lanes stay in registers while it runs over the
// nodes, reading one row pack (each lane broadcast) and three column packs. No repacking: samples are stored as the
// product needs them.
#include "prelude.clh"

#define FOR_EACH_LANE(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)

#define DECLARE(lane) double8 a##lane = (double8)(0.0), b##lane = (double8)(0.0), c##lane = (double8)(0.0);

#define UPDATE(lane)                        \
  {                                         \
    const double8 r = (double8)(row[lane]); \
    a##lane = fma(r, column0, a##lane);     \
    b##lane = fma(r, column1, b##lane);     \
    c##lane = fma(r, column2, c##lane);     \
  }

#define ADD(lane)                                                                \
  {                                                                              \
    __global double* out = gram + (size_t)(8 * i + lane) * gram_stride + 24 * j; \
    vstore8(vload8(0, out) + a##lane, 0, out);                                   \
    vstore8(vload8(1, out) + b##lane, 1, out);                                   \
    vstore8(vload8(2, out) + c##lane, 2, out);                                   \
  }

// samples: packs x node_stride x 8, of which the nodes first_node .. first_node+nodes-1 are added: as many as let the
// three column packs stay in a core's cache. gram: rows x gram_stride, rows from pack first_row_pack on.
// global size: (row packs, column triples); tiles below the diagonal return at once.
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void accumulate_gram(
    __global const double* restrict samples, const uint node_stride, const uint first_node, const uint nodes,
    const uint first_row_pack, __global double* restrict gram, const uint gram_stride) {
  const uint i = (uint)get_global_id(0);
  const uint j = (uint)get_global_id(1);
  const uint row_pack = first_row_pack + i;
  if (3 * j + 2 < row_pack) return;

  __global const double* row = samples + ((size_t)row_pack * node_stride + first_node) * 8;
  __global const double* columns = samples + ((size_t)(3 * j) * node_stride + first_node) * 8;
  const size_t pack_stride = (size_t)node_stride * 8;
  FOR_EACH_LANE(DECLARE)
  for (uint node = 0; node < nodes; ++node) {
    const double8 column0 = vload8(0, columns);
    const double8 column1 = vload8(0, columns + pack_stride);
    const double8 column2 = vload8(0, columns + 2 * pack_stride);
    FOR_EACH_LANE(UPDATE)
    row += 8;
    columns += 8;
  }
  FOR_EACH_LANE(ADD)
}
