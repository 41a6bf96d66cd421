// Composition of tables against peers in the same run.
// Usage: bench_compose [--smoke]
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <string_view>

#include "compose.hpp"
#include "lobe/lobe.hpp"
#include "measure.hpp"

namespace {

/// Starts the program again without the variables that force kernels and block sizes on OpenBLAS, if there are any:
/// peers get every advantage.
void let_openblas_choose(char** argv) {
  if (std::getenv("OPENBLAS_CORETYPE") == nullptr && std::getenv("OPENBLAS_L2_SIZE") == nullptr) return;
  ::unsetenv("OPENBLAS_CORETYPE");
  ::unsetenv("OPENBLAS_L2_SIZE");
  ::execv("/proc/self/exe", argv);  // returns only where it fails; then the choice stays as it was
}

}  // namespace

int main(int argc, char** argv) {
  let_openblas_choose(argv);
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
