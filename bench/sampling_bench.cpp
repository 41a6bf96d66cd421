// Directions drawn and weighed per second on the device, against a loop in C++ over all processors, in one run.
// Usage: bench_sampling [--smoke]
#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <string>
#include <string_view>

#include "lobe/lobe.hpp"
#include "measure.hpp"
#include "peers/sampling_host.hpp"

namespace {

constexpr double kTheta = 0.7;

/// Means of weights have to agree with each other within five standard errors.
bool agree(const std::string& name, const lobe::SampledAlbedo& found, double host, double count) {
  const double mean = host / count;
  const double allowed = 5 * found.albedo.front().error + 1e-12;
  fmt::print("{}: albedo {:.6f} ± {:.1g} on the device, {:.6f} on the host\n", name, found.albedo.front().value,
             found.albedo.front().error, mean);
  return std::abs(mean - found.albedo.front().value) <= allowed;
}

int run(bool is_smoke) {
  const auto device = lobe::Device::choose();
  bench::print_setting(device.info().name, device.info().driver);
  const std::size_t count = is_smoke ? 20'000 : 1'000'000;
  const int rounds = is_smoke ? 1 : 5;
  const double cosine = std::cos(kTheta);
  const lobe::Material phong = lobe::parse_material("phong:n=20");
  const lobe::Material ggx = lobe::parse_material("ggx:alpha=0.3");
  const lobe::Material mixture = lobe::parse_material("lambert:scale=0.3+ggx:alpha=0.3,scale=0.6");
  lobe::SampledAlbedo found;
  double host = 0;
  const auto on_device = [&](const lobe::Material& material) {
    return [&] { found = lobe::sampled_albedo(device, material, {kTheta, 0}, count); };
  };
  bool is_right = true;
  bench::Table table("Msamples/s");
  const double work = static_cast<double>(count) / 1e6;
  table.add("phong:n=20", work,
            bench::measure_together({{"lobe", on_device(phong)},
                                     {"host loop", [&] { host = bench::sample_phong_on_host(cosine, 20, 1, count); }}},
                                    rounds));
  is_right = agree("phong:n=20", found, host, static_cast<double>(count)) && is_right;
  table.add("ggx:alpha=0.3", work,
            bench::measure_together({{"lobe", on_device(ggx)},
                                     {"host loop", [&] { host = bench::sample_ggx_on_host(cosine, 0.3, 1, count); }}},
                                    rounds));
  is_right = agree("ggx:alpha=0.3", found, host, static_cast<double>(count)) && is_right;
  table.add("lambert + ggx", work, bench::measure_together({{"lobe", on_device(mixture)}}, rounds));
  table.print();
  return is_right ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc > 1 && std::string_view(argv[1]) == "--smoke");
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_sampling: {}\n", error.what());
    return 1;
  }
}
