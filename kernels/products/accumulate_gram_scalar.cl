// Symmetric rank-k update gram += S S^T for samples in scalar packs (GPUs): square tiles through local memory.
#include "prelude.clh"

#define TILE 16

// samples: lobes x node_stride. gram: rows x gram_stride, rows from lobe first_row on.
// global size: rows and columns rounded up to TILE; local size: TILE x TILE. Tiles below the diagonal return at once.
__kernel __attribute__((reqd_work_group_size(TILE, TILE, 1))) void accumulate_gram_scalar(
    __global const double* restrict samples, const uint node_stride, const uint nodes, const uint first_row,
    const uint rows, const uint lobes, __global double* restrict gram, const uint gram_stride) {
  __local double row_tile[TILE][TILE + 1];
  __local double column_tile[TILE][TILE + 1];
  const uint x = (uint)get_local_id(0);
  const uint y = (uint)get_local_id(1);
  const uint column0 = (uint)get_group_id(0) * TILE;
  const uint row0 = (uint)get_group_id(1) * TILE;
  // The whole group decides alike: no barrier is left waiting.
  if (column0 + TILE <= first_row + row0) return;

  double sum = 0.0;
  for (uint start = 0; start < nodes; start += TILE) {
    const uint node = start + x;
    const bool inside = node < nodes;
    const uint row = row0 + y;
    const uint column = column0 + y;
    row_tile[y][x] = inside && row < rows ? samples[(size_t)(first_row + row) * node_stride + node] : 0.0;
    column_tile[y][x] = inside && column < lobes ? samples[(size_t)column * node_stride + node] : 0.0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint k = 0; k < TILE; ++k) sum = fma(row_tile[y][k], column_tile[x][k], sum);
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (row0 + y < rows && column0 + x < lobes) gram[(size_t)(row0 + y) * gram_stride + column0 + x] += sum;
}
