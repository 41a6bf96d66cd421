#pragma once

#include <cstddef>
#include <cstdint>

namespace bench {

// Sums of weights f cos / pdf of `count` directions drawn for a light at cos(theta) in the x-z plane, by a loop in
// plain C++ over all processors, random numbers by Philox4x32-10 as on the device.

__attribute__((visibility("default"))) double sample_phong_on_host(double cosine, double n, std::uint64_t seed,
                                                                   std::size_t count);
/// GGX by visible normals (Heitz 2018), height-correlated attenuation.
__attribute__((visibility("default"))) double sample_ggx_on_host(double cosine, double alpha, std::uint64_t seed,
                                                                 std::size_t count);

}  // namespace bench
