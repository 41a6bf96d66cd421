// Draws directions V for a direction L from a mixture of strategies (sampling/proposal.clh).
#include "sampling/proposal.clh"

// Rows of what is drawn, of `stride` numbers each: V, the density in sr^-1, the number of the part that drew it. What
// points below the horizon or nowhere has density 0; of delta parts the density is minus their probability.
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
  const random_pair choice = random_numbers(source, 0);
  const vector light = {(pack)(light_x), (pack)(light_y), (pack)(light_z)};
  vector v = NOWHERE;
  pack by = (pack)(0.0);
  pack is_delta = (pack)(0.0);
  double sum = 0.0;
  for (uint k = 0; k < count; ++k) {
    __global const double* part = parts + PART_NUMBERS * k;
    const vector next = draw_part((uint)part[0], choice.v, source, light, part + 2, tables);
    // The last part takes what rounding leaves.
    const double end = k + 1 == count ? 2.0 : sum + part[1];
    const pack chosen = (choice.u >= sum && choice.u < end) ? (pack)(1.0) : (pack)(0.0);
    v.x = chosen > 0.5 ? next.x : v.x;
    v.y = chosen > 0.5 ? next.y : v.y;
    v.z = chosen > 0.5 ? next.z : v.z;
    by = chosen > 0.5 ? (pack)((double)k) : by;
    is_delta = chosen > 0.5 && (uint)part[0] == STRATEGY_DELTA ? (pack)(part[1]) : is_delta;
    sum = end;
  }
  const pack density = pdf_proposal(light, v, parts, count, tables);
  STORE_PACK(v.x, p, drawn + DRAWN_X * stride);
  STORE_PACK(v.y, p, drawn + DRAWN_Y * stride);
  STORE_PACK(v.z, p, drawn + DRAWN_Z * stride);
  STORE_PACK(is_delta > 0.0 ? -is_delta : density, p, drawn + DRAWN_PDF * stride);
  STORE_PACK(by, p, drawn + DRAWN_PART * stride);
}
