// Radiance that a sphere of one material sends to a distant viewer, under distant point lights, integrated over parts
// of the picture:
//   radiance[channel][part] (+)= sum over lobes of mix[channel] integral of sum over lights of f(L, V) (N.L)+ E dx dy.
// Source: Neumann 2001, section 3.6. The sphere has radius 1; x points to the right, y up, z towards the viewer. The
// surface has its x axis along the parallels about y, its y axis along the meridians, so that at N = (x, y, n)
//   V = (-x, -y n, r n) / r,  L = (l_x n - l_z x, r^2 l_y - y (l_x x + l_z n), r N.l) / r,  r^2 = 1 - y^2.
// Built once per model; MODEL names the function that the model's file defines.
#include "lobes/pair_geometry.clh"
#ifndef MODEL
#include "models/lambert.clh"
#define MODEL lambert
#endif

// Directions of the surface are known to this much: nearer to the silhouette and to the poles they are those there.
#define LEAST_COSINE 1e-9

// parts: rows x_low, x_high, y_low, y_high of `stride` numbers, a multiple of REAL_WIDTH; what lies outside the sphere
// is left out. rule: `order` nodes on [0, 1], then their weights. lights: directions and irradiance E, four numbers
// each. model_coefficients: lobes x (LOBE_NUMBERS + channels), the last the mix. radiance: channels x stride; with
// `accumulate` 0 it is written, else added to. A work-item takes a pack of parts.
__kernel void shade_sphere(__global const double* restrict parts, const uint stride,
                           __global const double* restrict rule, const uint order,
                           __global const double* restrict lights, const uint light_count,
                           __global const double* restrict model_coefficients, const uint lobes, const uint channels,
                           const uint accumulate, __global double* restrict radiance) {
  const uint p = (uint)get_global_id(0);
  if (p >= stride / REAL_WIDTH) return;
  const pack x_low = LOAD_PACK(p, parts);
  const pack x_high = LOAD_PACK(p, parts + stride);
  const pack y_low = LOAD_PACK(p, parts + 2 * (size_t)stride);
  const pack y_high = LOAD_PACK(p, parts + 3 * (size_t)stride);
  for (uint lobe = 0; lobe < lobes; ++lobe) {
    __global const double* numbers = model_coefficients + lobe * (LOBE_NUMBERS + channels);
    const coefficients c = splat_coefficients(numbers);
    pack sum = (pack)(0.0);
    for (uint j = 0; j < order; ++j) {
      const pack y = y_low + (y_high - y_low) * rule[j];
      const pack reach = sqrt(fmax((1.0 - y) * (1.0 + y), (pack)(0.0)));
      const pack from = clamp(x_low, -reach, reach);
      const pack width = clamp(x_high, -reach, reach) - from;
      const pack share = width * (y_high - y_low) * rule[order + j];
      const pack r = fmax(reach, (pack)(LEAST_COSINE));
      pack row = (pack)(0.0);
      for (uint i = 0; i < order; ++i) {
        const pack x = from + width * rule[i];
        const pack n = fmax(sqrt(fmax((reach - x) * (reach + x), (pack)(0.0))), (pack)(LEAST_COSINE));
        const pack view_x = -x / r;
        const pack view_y = -y * n / r;
        pack lit = (pack)(0.0);
        for (uint k = 0; k < light_count; ++k) {
          const double l_x = lights[4 * k];
          const double l_y = lights[4 * k + 1];
          const double l_z = lights[4 * k + 2];
          const pack in_z = l_x * x + l_y * y + l_z * n;
          const pack in_x = (l_x * n - l_z * x) / r;
          const pack in_y = r * l_y - y * (l_x * x + l_z * n) / r;
          const pack above = fmax(in_z, (pack)(LEAST_COSINE));  // of what is in shadow nothing is used
          const pack f = TO_PACK(MODEL(pair_geometry(in_x, in_y, above, view_x, view_y, n), c));
          lit += in_z > 0.0 ? lights[4 * k + 3] * in_z * f : (pack)(0.0);
        }
        row += rule[order + i] * lit;
      }
      sum += share * row;
    }
    for (uint channel = 0; channel < channels; ++channel) {
      __global double* out = radiance + (size_t)channel * stride;
      const pack before = accumulate != 0 || lobe > 0 ? LOAD_PACK(p, out) : (pack)(0.0);
      STORE_PACK(before + numbers[LOBE_NUMBERS + channel] * sum, p, out);
    }
  }
}
