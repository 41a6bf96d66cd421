// Composition of tables against peers in the same run.
// Usage: bench_compose [--smoke]
#include <fmt/format.h>

#include <exception>
#include <string_view>

#include "compose.hpp"
#include "lobe/lobe.hpp"
#include "measure.hpp"

int main(int argc, char** argv) {
  bench::let_openblas_choose(argv);
  const bool smoke = argc > 1 && std::string_view(argv[1]) == "--smoke";
  try {
    const auto device = lobe::Device::choose();
    bench::print_setting(device.info().name, device.info().driver);
    bench::run_dense(device, smoke);
    bench::run_isotropic(device, smoke);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_compose: {}\n", error.what());
    return 1;
  }
}
