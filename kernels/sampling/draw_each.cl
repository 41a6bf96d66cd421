// Draws a direction V for each of many directions L, from a mixture of its own (sampling/proposal.clh): the vertices of
// paths.
#include "sampling/proposal.clh"

#if REAL_WIDTH == 8
#define FIRST_LANE(x) ((x).s0)
#else
#define FIRST_LANE(x) (x)
#endif

// Rows of what is drawn, of `count` numbers each.
#define EACH_X 0
#define EACH_Y 1
#define EACH_Z 2
#define EACH_PDF 3
#define EACH_PART 4

// lights: 3 x count, L. densities: from which one each is drawn. parts: PART_NUMBERS each; those of density d end
// before ends[d] and begin where those of d - 1 end. numbers: of the samples, on which their random numbers depend.
// drawn: 5 x count. A work-item draws one; in a pack of eight the other lanes draw samples that nobody asked for.
__kernel void draw_each(__global const double* restrict lights, __global const uint* restrict densities,
                        __global const double* restrict parts, __global const uint* restrict ends,
                        __global const double* restrict tables, const ulong seed,
                        __global const ulong* restrict numbers, const uint count, __global double* restrict drawn) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const uint density = densities[i];
  const uint begin = density == 0 ? 0u : ends[density - 1];
  const vector light = {(pack)(lights[i]), (pack)(lights[count + i]), (pack)(lights[2 * count + i])};
  const drawn_direction one = draw_from_proposal(source_of(numbers[i], seed), light, parts + PART_NUMBERS * begin,
                                                 ends[density] - begin, tables);
  drawn[EACH_X * count + i] = FIRST_LANE(one.v.x);
  drawn[EACH_Y * count + i] = FIRST_LANE(one.v.y);
  drawn[EACH_Z * count + i] = FIRST_LANE(one.v.z);
  drawn[EACH_PDF * count + i] = FIRST_LANE(one.density);
  drawn[EACH_PART * count + i] = FIRST_LANE(one.part);
}
