#include <cblas.h>
#include <clblast.h>
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "compose.hpp"
#include "device/implementation.hpp"
#include "device/multiply_matrices.hpp"
#include "measure.hpp"
#include "peers/eigen_host.hpp"

namespace bench {
namespace {

std::vector<double> random_values(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> values(count);
  for (double& value : values) value = uniform(generator);
  return values;
}

/// Factors of a product of n x n matrices in some number type.
template <typename Number>
struct Factors {
  explicit Factors(std::size_t size) : n(size) {
    const auto left = random_values(n * n, 1);
    const auto right = random_values(n * n, 2);
    a.assign(left.begin(), left.end());
    b.assign(right.begin(), right.end());
  }
  std::size_t n;
  std::vector<Number> a, b;
};

template <typename Number>
void openblas(const Factors<Number>& f, std::vector<Number>& c) {
  const auto n = static_cast<int>(f.n);
  if constexpr (sizeof(Number) == sizeof(double)) {
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, n, n, 1, f.a.data(), n, f.b.data(), n, 0, c.data(), n);
  } else {
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, n, n, 1, f.a.data(), n, f.b.data(), n, 0, c.data(), n);
  }
}

/// CLBlast with its matrices on our device; the transfers are not timed.
template <typename Number>
class ClBlast {
 public:
  ClBlast(const lobe::Device& device, const Factors<Number>& f)
      : queue_(device.implementation().queue),
        n_(f.n),
        bytes_(n_ * n_ * sizeof(Number)),
        a_(device.implementation().context, CL_MEM_READ_ONLY, bytes_),
        b_(device.implementation().context, CL_MEM_READ_ONLY, bytes_),
        c_(device.implementation().context, CL_MEM_READ_WRITE, bytes_) {
    queue_.enqueueWriteBuffer(a_, CL_TRUE, 0, bytes_, f.a.data());
    queue_.enqueueWriteBuffer(b_, CL_TRUE, 0, bytes_, f.b.data());
  }

  void multiply() {
    cl_command_queue queue = queue_();
    const auto status =
        clblast::Gemm<Number>(clblast::Layout::kRowMajor, clblast::Transpose::kNo, clblast::Transpose::kNo, n_, n_, n_,
                              Number{1}, a_(), 0, n_, b_(), 0, n_, Number{0}, c_(), 0, n_, &queue);
    if (status != clblast::StatusCode::kSuccess) {
      throw std::runtime_error(fmt::format("CLBlast fails with status {}", static_cast<int>(status)));
    }
    queue_.finish();
  }

  void read(std::vector<Number>& c) { queue_.enqueueReadBuffer(c_, CL_TRUE, 0, bytes_, c.data()); }

 private:
  cl::CommandQueue queue_;
  std::size_t n_;
  std::size_t bytes_;
  cl::Buffer a_, b_, c_;
};

/// The product as programs write it that keep matrices as vectors of rows.
class Nested {
 public:
  explicit Nested(const Factors<double>& f) : a_(rows(f.a, f.n)), b_(rows(f.b, f.n)), c_(a_) {}

  void multiply() {
    const std::size_t n = a_.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        double sum = 0;
        for (std::size_t x = 0; x < n; ++x) sum += a_[i][x] * b_[x][j];
        c_[i][j] = sum;
      }
    }
  }

 private:
  using Rows = std::vector<std::vector<double>>;

  static Rows rows(const std::vector<double>& values, std::size_t n) {
    Rows result;
    for (auto row = values.begin(); row != values.end(); row += static_cast<std::ptrdiff_t>(n)) {
      result.emplace_back(row, row + static_cast<std::ptrdiff_t>(n));
    }
    return result;
  }

  Rows a_, b_, c_;
};

/// Contenders that are not the same product would be compared in vain.
template <typename Number>
void expect_same(const std::string& peer, const std::vector<Number>& c, const std::vector<double>& ours) {
  const double tolerance = sizeof(Number) == sizeof(double) ? 1e-12 : 1e-4;
  for (std::size_t i = 0; i < ours.size(); i += 97) {
    if (std::abs(static_cast<double>(c[i]) - ours[i]) > tolerance * ours[i]) {
      throw std::runtime_error(fmt::format("{} and lobe differ in entry {}", peer, i));
    }
  }
}

/// The product in our matrices of doubles, which also the arithmetic in single precision starts from and ends in.
template <typename Number>
std::vector<Timing> measure_size(const lobe::Device& device, std::size_t n, bool smoke) {
  const Factors<Number> factors(n);
  const std::vector<double> a(factors.a.begin(), factors.a.end());
  const std::vector<double> b(factors.b.begin(), factors.b.end());
  const std::vector<double> ones(n, 1.0);
  std::vector<double> ours(n * n);
  std::vector<Number> blas(n * n);
  std::vector<Number> eigen(n * n);
  std::vector<Number> clblast(n * n);
  ClBlast<Number> on_device(device, factors);
  const auto precision =
      sizeof(Number) == sizeof(double) ? lobe::Precision::double_precision : lobe::Precision::single_precision;

  constexpr int kSlow = 1;
  std::vector<Contender> contenders{
      {"lobe",
       [&] {
         lobe::multiply(device, {a.data(), n, n, n}, {b.data(), n, n, n}, ones, {ours.data(), n, n, n}, precision);
       }},
      {"OpenBLAS", [&] { openblas(factors, blas); }},
      {"Eigen", [&] { peers::multiply(factors.a.data(), factors.b.data(), n, eigen.data()); }},
      {"CLBlast", [&] { on_device.multiply(); }, kSlow}};
  std::vector<Nested> nested;
  if constexpr (sizeof(Number) == sizeof(double)) {
    constexpr std::size_t kLargest = 512;
    if (n <= kLargest) {
      nested.emplace_back(factors);
      contenders.push_back({"vector<vector>", [&] { nested.front().multiply(); }, kSlow});
    }
  }
  const int rounds = smoke ? 1 : n < 2000 ? 15 : n < 4000 ? 7 : 5;
  auto timings = measure_together(contenders, rounds);
  on_device.read(clblast);
  expect_same("OpenBLAS", blas, ours);
  expect_same("Eigen", eigen, ours);
  expect_same("CLBlast", clblast, ours);
  return timings;
}

template <typename Number>
void run_precision(const lobe::Device& device, const std::vector<std::size_t>& sizes, bool smoke) {
  Table table("GFLOP/s");
  std::vector<double> lengths;
  std::vector<double> seconds;
  for (const std::size_t n : sizes) {
    const auto length = static_cast<double>(n);
    const auto timings = measure_size<Number>(device, n, smoke);
    lengths.push_back(length);
    seconds.push_back(timings.front().seconds);
    table.add(fmt::format("N = {}", n), 2 * length * length * length / 1e9, timings);
  }
  table.print();
  fmt::print("exponent of lobe's time in N: {:.2f}; expected 3\n", fitted_exponent(lengths, seconds));
}

}  // namespace

void run_dense(const lobe::Device& device, bool smoke) {
  openblas_set_num_threads(static_cast<int>(device.info().compute_units));
  const std::vector<std::size_t> sizes =
      smoke ? std::vector<std::size_t>{48, 100} : std::vector<std::size_t>{512, 1152, 2304, 4608};
  fmt::print(
      "\nProduct of N x N matrices; medians, in brackets the time over lobe's in the same round (above 1: lobe is "
      "faster)\nOpenBLAS with {} kernels, {} threads; Eigen with OpenMP; CLBlast on lobe's device\n",
      openblas_get_corename(), openblas_get_num_threads());
  fmt::print("\nDouble precision\n");
  run_precision<double>(device, sizes, smoke);
  fmt::print("\nSingle precision (lobe: matrices of doubles, products in float)\n");
  run_precision<float>(device, sizes, smoke);
}

}  // namespace bench
