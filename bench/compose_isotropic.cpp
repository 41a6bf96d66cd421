#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "compose.hpp"
#include "device/cosine_plan.hpp"
#include "device/isotropic_product.hpp"
#include "device/multiply_matrices.hpp"
#include "measure.hpp"

namespace bench {
namespace {

/// Two isotropic tables of a resolution, weights of their rings, and room for their composition.
struct Tables {
  Tables(std::size_t ring_count, std::size_t azimuth_count)
      : rings(ring_count), azimuths(azimuth_count), shape{rings, rings, rings, azimuths} {
    const std::size_t size = rings * rings * shape.points();
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (auto* values : {&a, &b}) {
      values->resize(size);
      for (double& value : *values) value = uniform(generator);
    }
    scale.assign(rings, 1 / std::sqrt(static_cast<double>(rings)));
    c.resize(size);
  }

  std::size_t rings, azimuths;
  lobe::IsotropicShape shape;
  std::vector<double> a, b, scale, c;
};

/// Operations of a composition: products of all orders, and three transforms, folded.
double operations(const lobe::IsotropicShape& shape) {
  const auto rings = static_cast<double>(shape.rows);
  const auto plan = lobe::make_cosine_plan(shape.azimuths);
  const auto transforms = static_cast<double>(2 * plan.forward.coefficients.size() + plan.inverse.coefficients.size());
  return 2 * rings * rings * (rings * static_cast<double>(plan.points) + transforms);
}

Contender isotropic(lobe::IsotropicProduct& product, Tables& t) {
  return {"isotropic", [&] { product.multiply(t.a, t.b, t.scale, t.c); }};
}

/// The same operator as a dense matrix: a row for each ring and azimuth.
std::vector<double> dense_matrix(const Tables& t, const std::vector<double>& table) {
  const std::size_t n = t.azimuths;
  std::vector<double> matrix;
  matrix.reserve(t.rings * n * t.rings * n);
  for (std::size_t i = 0; i < t.rings; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t x = 0; x < t.rings; ++x) {
        for (std::size_t l = 0; l < n; ++l) {
          const std::size_t turn = (n + k - l) % n;
          matrix.push_back(table[(i * t.rings + x) * t.shape.points() + std::min(turn, n - turn)]);
        }
      }
    }
  }
  return matrix;
}

void expect_same(const std::string& peer, double theirs, double ours) {
  if (std::abs(theirs - ours) > 1e-11 * std::abs(ours)) {
    throw std::runtime_error(fmt::format("{} and lobe differ: {} and {}", peer, theirs, ours));
  }
}

void compare_with_dense(const lobe::Device& device, bool smoke) {
  Tables t(smoke ? 4 : 32, smoke ? 8 : 72);
  lobe::IsotropicProduct product(device, t.shape, lobe::Precision::double_precision);
  const std::size_t size = t.rings * t.azimuths;
  const auto a = dense_matrix(t, t.a);
  const auto b = dense_matrix(t, t.b);
  std::vector<double> c(size * size);
  const double solid_angle = 2 * std::numbers::pi / static_cast<double>(t.azimuths);
  const std::vector<double> scale(size, t.scale.front() * std::sqrt(solid_angle));
  const std::vector<Contender> contenders{
      isotropic(product, t),
      {"once",
       [&] {
         lobe::multiply_isotropic(device, t.rings, t.rings, t.rings, t.azimuths, t.a, t.b, t.scale, t.c,
                                  lobe::Precision::double_precision);
       }},
      {"dense", [&] {
         lobe::multiply(device, {a.data(), size, size, size}, {b.data(), size, size, size}, scale,
                        {c.data(), size, size, size}, lobe::Precision::double_precision);
       }}};
  const auto timings = measure_together(contenders, smoke ? 1 : 15);
  for (std::size_t j = 0; j < t.rings; ++j) expect_same("dense", c[j * t.azimuths], t.c[j * t.shape.points()]);
  fmt::print(
      "{} rings x {} azimuths, the same operator, milliseconds: isotropic {:.3f} (prepared once: {:.3f}), "
      "dense N = {} {:.3f}; dense / isotropic {:.0f}\n",
      t.rings, t.azimuths, timings[1].seconds * 1e3, timings[0].seconds * 1e3, size, timings[2].seconds * 1e3,
      timings[2].ratio_to_first);
}

/// What peers/compose.py answers, or nothing where there is no NumPy.
std::optional<nlohmann::json> run_numpy(const Tables& t, int rounds) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("bench_compose_{}.bin", ::getpid());
  std::ofstream out(file, std::ios::binary);
  std::vector<double> weights;
  for (const double s : t.scale) weights.push_back(s * s);
  for (const auto* values : {&t.a, &t.b, static_cast<const std::vector<double>*>(&weights)}) {
    out.write(reinterpret_cast<const char*>(values->data()),
              static_cast<std::streamsize>(values->size() * sizeof(double)));
  }
  out.close();
  const std::string output =
      run_python(fmt::format("'{}/compose.py' {} {} '{}' {}", LOBE_PEERS, t.rings, t.azimuths, file.string(), rounds));
  std::filesystem::remove(file);
  const auto json = nlohmann::json::parse(output, nullptr, false);
  return json.is_discarded() ? std::nullopt : std::optional(json);
}

void compare_with_numpy(const lobe::Device& device, std::size_t rings, std::size_t azimuths, bool smoke) {
  Tables t(rings, azimuths);
  lobe::IsotropicProduct product(device, t.shape, lobe::Precision::double_precision);
  const int rounds = smoke ? 1 : 25;
  const double ours = measure_together({isotropic(product, t)}, rounds).front().seconds;
  const auto numpy = run_numpy(t, rounds);
  std::string peer = "not installed, left out";
  if (numpy) {
    expect_same("NumPy", (*numpy)["sum"], std::accumulate(t.c.begin(), t.c.end(), 0.0));
    expect_same("NumPy", (*numpy)["squares"], std::inner_product(t.c.begin(), t.c.end(), t.c.begin(), 0.0));
    const double theirs = (*numpy)["seconds"];
    peer = fmt::format("{:.3f} ms, NumPy / lobe {:.2f}", theirs * 1e3, theirs / ours);
  }
  fmt::print("{:>4} x {:<4} lobe {:.3f} ms, {:.1f} GFLOP/s; NumPy {}\n", rings, azimuths, ours * 1e3,
             operations(t.shape) / ours / 1e9, peer);
}

struct Resolution {
  std::size_t rings, azimuths;
};

/// How cost grows along one axis of the resolution, beside how the operations do.
void print_exponent(const lobe::Device& device, const std::string& axis, const std::vector<double>& sizes,
                    const std::vector<Resolution>& resolutions, bool smoke) {
  std::vector<double> seconds;
  std::vector<double> expected;
  for (const auto& [rings, azimuths] : resolutions) {
    Tables t(rings, azimuths);
    lobe::IsotropicProduct product(device, t.shape, lobe::Precision::double_precision);
    seconds.push_back(measure_together({isotropic(product, t)}, smoke ? 1 : 15).front().seconds);
    expected.push_back(operations(t.shape));
  }
  fmt::print("exponent of the time in {}: {:.2f}; of the operations: {:.2f}\n", axis, fitted_exponent(sizes, seconds),
             fitted_exponent(sizes, expected));
}

}  // namespace

void run_isotropic(const lobe::Device& device, bool smoke) {
  fmt::print("\nComposition of isotropic tables; medians\n");
  compare_with_dense(device, smoke);
  if (smoke) {
    compare_with_numpy(device, 5, 6, smoke);
    print_exponent(device, "n_theta", {4, 8}, {{4, 8}, {8, 8}}, smoke);
    return;
  }
  for (const auto& [rings, azimuths] : {Resolution{32, 72}, {64, 128}, {128, 256}}) {
    compare_with_numpy(device, rings, azimuths, smoke);
  }
  print_exponent(device, "n_theta at n_phi = 72 (3 for the products, 2 for the transforms)", {32, 64, 128, 256},
                 {{32, 72}, {64, 72}, {128, 72}, {256, 72}}, smoke);
  print_exponent(device, "n_phi at n_theta = 64 (1 for the products, 2 for the transforms)", {32, 64, 128, 256},
                 {{64, 32}, {64, 64}, {64, 128}, {64, 256}}, smoke);
}

}  // namespace bench
