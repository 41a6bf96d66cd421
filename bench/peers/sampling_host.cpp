#include "peers/sampling_host.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace bench {
namespace {

using std::numbers::pi;

struct Vector {
  double x, y, z;
};

double dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

struct Pair {
  double u, v;
};

Pair random_pair(std::uint64_t seed, std::uint64_t number) {
  std::array<std::uint32_t, 4> x{static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), 1, 0};
  auto key_0 = static_cast<std::uint32_t>(seed);
  auto key_1 = static_cast<std::uint32_t>(seed >> 32);
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t first = std::uint64_t{0xD2511F53} * x[0];
    const std::uint64_t second = std::uint64_t{0xCD9E8D57} * x[2];
    x = {static_cast<std::uint32_t>(second >> 32) ^ x[1] ^ key_0, static_cast<std::uint32_t>(second),
         static_cast<std::uint32_t>(first >> 32) ^ x[3] ^ key_1, static_cast<std::uint32_t>(first)};
    key_0 += 0x9E3779B9;
    key_1 += 0xBB67AE85;
  }
  constexpr double kStep = 1.0 / (1ULL << 52);
  const auto unit = [](std::uint32_t high, std::uint32_t low) {
    return (static_cast<double>((static_cast<std::uint64_t>(high) << 20) | (low >> 12)) + 0.5) * kStep;
  };
  return {unit(x[0], x[1]), unit(x[2], x[3])};
}

/// Sum of weight(number) over all processors.
template <typename Weight>
double sum_over(std::size_t count, Weight weight) {
  double sum = 0;
#pragma omp parallel for reduction(+ : sum) schedule(static)
  for (std::size_t i = 0; i < count; ++i) sum += weight(i);
  return sum;
}

}  // namespace

double sample_phong_on_host(double cosine, double n, std::uint64_t seed, std::size_t count) {
  const double sine = std::sqrt(1 - cosine * cosine);
  const Vector mirror{-sine, 0, cosine};
  return sum_over(count, [=](std::size_t i) {
    const Pair r = random_pair(seed, i);
    const double along = std::pow(r.u, 1 / (n + 1));
    const double across = std::sqrt(1 - along * along);
    const double first = across * std::cos(2 * pi * r.v);
    const double second = across * std::sin(2 * pi * r.v);
    const Vector v{along * mirror.x + first * mirror.z, second, along * mirror.z - first * mirror.x};
    if (v.z <= 0) return 0.0;
    const double power = std::pow(std::max(0.0, dot(mirror, v)), n);
    const double density = (n + 1) / (2 * pi) * power;
    return density > 0 ? (n + 2) / (2 * pi) * power * v.z / density : 0.0;
  });
}

double sample_ggx_on_host(double cosine, double alpha, std::uint64_t seed, std::size_t count) {
  const Vector light{std::sqrt(1 - cosine * cosine), 0, cosine};
  const double length = std::hypot(alpha * light.x, light.z);
  const Vector stretched{alpha * light.x / length, 0, light.z / length};
  const double a2 = alpha * alpha;
  const double root_i = std::sqrt(a2 + (1 - a2) * light.z * light.z);
  return sum_over(count, [=](std::size_t i) {
    const Pair r = random_pair(seed, i);
    const double radius = std::sqrt(r.u);
    const double first = radius * std::cos(2 * pi * r.v);
    const double share = 0.5 * (1 + stretched.z);
    const double second = (1 - share) * std::sqrt(1 - first * first) + share * radius * std::sin(2 * pi * r.v);
    const double up = std::sqrt(std::max(0.0, 1 - first * first - second * second));
    // Axes of the disc: y, and the stretched L times y.
    Vector h{-second * stretched.z + up * stretched.x, first, second * stretched.x + up * stretched.z};
    h = {alpha * h.x, alpha * h.y, std::max(0.0, h.z)};
    const double norm = 1 / std::sqrt(dot(h, h));
    h = {norm * h.x, norm * h.y, norm * h.z};
    const double twice = 2 * dot(light, h);
    const Vector v{twice * h.x - light.x, twice * h.y - light.y, twice * h.z - light.z};
    if (v.z <= 0) return 0.0;
    const double spread = 1 + (a2 - 1) * h.z * h.z;
    const double distribution = a2 / (pi * spread * spread);
    const double root_o = std::sqrt(a2 + (1 - a2) * v.z * v.z);
    const double value = distribution / (2 * (light.z * root_o + v.z * root_i));
    const double density = distribution / (2 * (light.z + root_i));
    return value * v.z / density;
  });
}

}  // namespace bench
