#include "reference/sampling.hpp"

#include <algorithm>

#include "reference/models.hpp"

namespace lobe::reference {

Real power_density(const Vector& axis, const Vector& view, Real n) {
  return (n + 1) / (2 * kPi) * cosine_power(axis, view, n);
}

Real ward_density(const Vector& light, const Vector& view, Real m_x, Real m_y, Real rotation) {
  const Vector h = from_axes(half_vector(light, view), rotation);
  const Real tan2 = tan_squared_delta(h);
  const Real azimuth = std::atan2(h.y, h.x);
  const Real cosine = std::cos(azimuth) / m_x;
  const Real sine = std::sin(azimuth) / m_y;
  return std::exp(-tan2 * (cosine * cosine + sine * sine)) /
         (4 * kPi * m_x * m_y * dot(half_vector(light, view), light) * h.z * h.z * h.z);
}

Real ashikhmin_density(const Vector& light, const Vector& view, Real n_u, Real n_v, Real rotation) {
  const Vector half = half_vector(light, view);
  const Vector h = from_axes(half, rotation);
  const Real azimuth = std::atan2(h.y, h.x);
  const Real exponent = n_u * std::cos(azimuth) * std::cos(azimuth) + n_v * std::sin(azimuth) * std::sin(azimuth);
  const Real of_half = std::sqrt((n_u + 1) * (n_v + 1)) / (2 * kPi) * std::pow(h.z, exponent);
  return of_half / (4 * dot(half, light));
}

Real visible_density(const Vector& light, const Vector& view, Real a_x, Real a_y, Real rotation) {
  const Vector half = half_vector(light, view);
  const Vector h = from_axes(half, rotation);
  const Vector l = from_axes(light, rotation);
  const Real spread = h.x * h.x / (a_x * a_x) + h.y * h.y / (a_y * a_y) + h.z * h.z;
  const Real distribution = 1 / (kPi * a_x * a_y * spread * spread);
  const Real lambda = (-1 + std::sqrt(1 + (a_x * a_x * l.x * l.x + a_y * a_y * l.y * l.y) / (l.z * l.z))) / 2;
  const Real masking = 1 / (1 + lambda);
  const Real visible = masking * std::max<Real>(0, dot(light, half)) * distribution / l.z;
  return visible / (4 * dot(light, half));
}

namespace {

bool is_within(const Vector& light, const Vector& view, Real radius) {
  const Vector difference = view - mirrored(light);
  return difference.x * difference.x + difference.y * difference.y <= radius * radius;
}

}  // namespace

Real patch_density(const Vector& light, const Vector& view, Real radius) {
  const Real distance = std::sqrt(light.x * light.x + light.y * light.y);
  return is_within(light, view, radius) ? view.z / lens_area(1, radius, distance) : 0;
}

Real roulette_density(const Vector& light, const Vector& view, Real radius) {
  const Real smaller = std::min<Real>(1, radius);
  return is_within(light, view, radius) ? view.z / (kPi * smaller * smaller) : 0;
}

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t left = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t right = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(right >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(right),
               static_cast<std::uint32_t>(left >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(left)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

}  // namespace lobe::reference
