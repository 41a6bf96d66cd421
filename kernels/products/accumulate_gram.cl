// Symmetric rank-k update gram += S S^T for samples in packs of eight lobes, upper triangle by tiles.
//
// A tile has 8 x 24 lobes: 24 accumulators of eight lanes stay in registers while it runs over a block of nodes,
// reading one row pack (each lane broadcast) and three column packs. No repacking: samples are stored as the product
// needs them. A work-item owns a column of tiles, and goes over it once for each block of nodes: the column packs then
// stay in a core's cache, and so do the row packs, which its next item reads again. No sum depends on how tiles are
// dealt out.
#include "prelude.clh"

#define ITEM_PACKS 6  // as the host has it
#define NODE_BLOCK 512

#define FOR_EACH_LANE(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7)

#define DECLARE(lane) double8 a##lane = (double8)(0.0), b##lane = (double8)(0.0), c##lane = (double8)(0.0);

#define UPDATE(lane)                        \
  {                                         \
    const double8 r = (double8)(row[lane]); \
    a##lane = fma(r, column0, a##lane);     \
    b##lane = fma(r, column1, b##lane);     \
    c##lane = fma(r, column2, c##lane);     \
  }

#define ADD(lane)                                             \
  {                                                           \
    __global double* out = gram + (size_t)(lane)*gram_stride; \
    vstore8(vload8(0, out) + a##lane, 0, out);                \
    vstore8(vload8(1, out) + b##lane, 1, out);                \
    vstore8(vload8(2, out) + c##lane, 2, out);                \
  }

// Adds one tile. row, columns: the first node's values; pack_stride: from one pack to the next.
void add_tile(__global const double* row, __global const double* columns, const size_t pack_stride, const uint nodes,
              __global double* gram, const uint gram_stride) {
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

// samples: packs x node_stride x 8, of which the nodes first_node .. first_node+nodes-1 are added: as many as let the
// packs of an item stay in a core's cache. gram: rows x gram_stride, rows from pack first_row_pack on, row_packs of
// them. global size: (column triples, row packs by ITEM_PACKS, rounded up). Tiles below the diagonal are left out.
// Items with the least to do come first, since devices deal out large shares before small ones.
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void accumulate_gram(
    __global const double* restrict samples, const uint node_stride, const uint first_node, const uint nodes,
    const uint first_row_pack, const uint row_packs, __global double* restrict gram, const uint gram_stride) {
  const uint j = (uint)get_global_id(0);
  const uint first_pack = (uint)(get_global_size(1) - 1 - get_global_id(1)) * ITEM_PACKS;
  if (3 * j + 2 < first_row_pack + first_pack) return;
  const uint end_pack = min(min(first_pack + ITEM_PACKS, row_packs), 3 * j + 3 - first_row_pack);

  const size_t pack_stride = (size_t)node_stride * 8;
  for (uint first = 0; first < nodes; first += NODE_BLOCK) {
    __global const double* in = samples + (size_t)(first_node + first) * 8;
    for (uint i = first_pack; i < end_pack; ++i) {
      add_tile(in + (first_row_pack + i) * pack_stride, in + 3 * j * pack_stride, pack_stride,
               min((uint)NODE_BLOCK, nodes - first), gram + (size_t)(8 * i) * gram_stride + 24 * j, gram_stride);
    }
  }
}
