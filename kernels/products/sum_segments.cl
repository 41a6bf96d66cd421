// Sums of samples over runs of consecutive nodes: out[pack][segment] += sum of samples[pack][node] over the segment.
#include "prelude.clh"

// Segment s holds the nodes segment_start[s] .. segment_start[s+1]-1 and adds to column first_segment + s.
// samples: packs x node_stride x REAL_WIDTH; out: packs x out_stride x REAL_WIDTH. global size: (segments, packs).
__kernel void sum_segments(__global const double* restrict samples, const uint node_stride,
                           __global const uint* restrict segment_start, const uint first_segment,
                           __global double* restrict out, const uint out_stride) {
  const uint s = (uint)get_global_id(0);
  const size_t p = get_global_id(1);
  pack sum = (pack)(0.0);
  for (uint node = segment_start[s]; node < segment_start[s + 1]; ++node) {
    sum += LOAD_PACK(p * node_stride + node, samples);
  }
  const size_t at = p * out_stride + first_segment + s;
  STORE_PACK(LOAD_PACK(at, out) + sum, at, out);
}
