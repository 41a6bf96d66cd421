// Draws directions V for a direction L from a mixture of strategies (sampling/proposal.clh).
#include "sampling/proposal.clh"

// Rows of what is drawn, of `stride` numbers each.
#define DRAWN_X 0
#define DRAWN_Y 1
#define DRAWN_Z 2
#define DRAWN_PDF 3
#define DRAWN_PART 4

// parts: count x PART_NUMBERS. first: the number of the first sample. stride, a multiple of REAL_WIDTH, is how many are
// drawn, a pack by each work-item.
__kernel void draw_directions(const double light_x, const double light_y, const double light_z,
                              __global const double* restrict parts, const uint count,
                              __global const double* restrict tables, const ulong seed, const ulong first,
                              const uint stride, __global double* restrict drawn) {
  const uint p = (uint)get_global_id(0);
  if (p >= stride / REAL_WIDTH) return;
  const random_source source = source_of(first + (ulong)p * REAL_WIDTH, seed);
  const vector light = {(pack)(light_x), (pack)(light_y), (pack)(light_z)};
  const drawn_direction one = draw_from_proposal(source, light, parts, count, tables);
  STORE_PACK(one.v.x, p, drawn + DRAWN_X * stride);
  STORE_PACK(one.v.y, p, drawn + DRAWN_Y * stride);
  STORE_PACK(one.v.z, p, drawn + DRAWN_Z * stride);
  STORE_PACK(one.density, p, drawn + DRAWN_PDF * stride);
  STORE_PACK(one.part, p, drawn + DRAWN_PART * stride);
}
