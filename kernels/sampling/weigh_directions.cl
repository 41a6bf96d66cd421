// Weights of drawn directions: how much light each stands for,
//   weights[channel] += sum over lobes of mix[channel] f(L, V; coefficients) N.V / pdf.
// Built once per model; MODEL names the function that the model's file defines.
#include "lobes/pair_geometry.clh"
#ifndef MODEL
#include "models/lambert.clh"
#define MODEL lambert
#endif

// model_coefficients: lobes x (LOBE_NUMBERS + channels), the last the mix. drawn: rows of `stride` numbers, a multiple
// of REAL_WIDTH, as draw_directions.cl leaves them. weights: channels x stride. A work-item takes a pack.
__kernel void weigh_directions(const double light_x, const double light_y, const double light_z,
                               __global const double* restrict model_coefficients, const uint lobes,
                               const uint channels, const uint stride, __global const double* restrict drawn,
                               __global double* restrict weights) {
  const uint p = (uint)get_global_id(0);
  if (p >= stride / REAL_WIDTH) return;
  const pack density = LOAD_PACK(p, drawn + 3 * stride);
  // What is lost is looked at where nothing overflows, and counts for nothing.
  const pack x = density > 0.0 ? LOAD_PACK(p, drawn) : (pack)(0.0);
  const pack y = density > 0.0 ? LOAD_PACK(p, drawn + stride) : (pack)(0.0);
  const pack z = density > 0.0 ? LOAD_PACK(p, drawn + 2 * stride) : (pack)(1.0);
  const pack share = density > 0.0 ? z / density : (pack)(0.0);
  const geometry g = pair_geometry((pack)(light_x), (pack)(light_y), (pack)(light_z), x, y, z);
  for (uint lobe = 0; lobe < lobes; ++lobe) {
    __global const double* numbers = model_coefficients + lobe * (LOBE_NUMBERS + channels);
    const pack weight = share * TO_PACK(MODEL(g, splat_coefficients(numbers)));
    for (uint c = 0; c < channels; ++c) {
      __global double* row = weights + (size_t)c * stride;
      STORE_PACK(LOAD_PACK(p, row) + numbers[LOBE_NUMBERS + c] * weight, p, row);
    }
  }
}
