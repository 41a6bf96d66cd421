// The density with which directions V are drawn for a direction L (sampling/proposal.clh).
#include "sampling/proposal.clh"

// drawn: rows of `stride` numbers, a multiple of REAL_WIDTH, as draw_directions.cl leaves them: x, y, z of V are read,
// the density is written behind them. A work-item takes a pack.
__kernel void find_density(const double light_x, const double light_y, const double light_z,
                           __global const double* restrict parts, const uint count,
                           __global const double* restrict tables, const uint stride, __global double* restrict drawn) {
  const uint p = (uint)get_global_id(0);
  if (p >= stride / REAL_WIDTH) return;
  const vector light = {(pack)(light_x), (pack)(light_y), (pack)(light_z)};
  const vector v = {LOAD_PACK(p, drawn), LOAD_PACK(p, drawn + stride), LOAD_PACK(p, drawn + 2 * stride)};
  STORE_PACK(pdf_proposal(light, v, parts, count, tables), p, drawn + 3 * stride);
}
