#include "measure.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <thread>

namespace bench {
namespace {

double now(Clock clock) {
  ::timespec time{};
  ::clock_gettime(clock == Clock::wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Seconds of a run; short ones are repeated until they are well above the clock's and the scheduler's resolution.
double timed(const Contender& contender, Clock clock) {
  constexpr double kLongEnough = 0.01;
  const double start = now(clock);
  double seconds = 0;
  int runs = 0;
  while (seconds < kLongEnough) {
    contender.run();
    seconds = now(clock) - start;
    ++runs;
  }
  return seconds / runs;
}

/// Worker threads of BLAS and OpenMP wait busily for some time after their work: they must not disturb the next.
void let_threads_sleep() {
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
}

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Timing> measure_together(const std::vector<Contender>& contenders, int rounds, Clock clock) {
  for (const auto& contender : contenders) contender.run();
  std::vector<std::vector<double>> seconds(contenders.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      if (round >= contenders[i].rounds) continue;
      if (clock == Clock::wall) let_threads_sleep();
      seconds[i].push_back(timed(contenders[i], clock));
    }
  }
  std::vector<Timing> timings;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < seconds[i].size(); ++round) {
      ratios.push_back(seconds[i][round] / seconds[0][round]);
    }
    const double ratio = median(ratios);
    for (double& each : ratios) each = std::abs(each - ratio);
    timings.push_back({contenders[i].name, median(seconds[i]), ratio, median(ratios), seconds[i]});
  }
  return timings;
}

double fitted_exponent(std::span<const double> sizes, std::span<const double> seconds) {
  const auto count = static_cast<double>(sizes.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    mean_x += std::log(sizes[i]) / count;
    mean_y += std::log(seconds[i]) / count;
  }
  double xy = 0;
  double xx = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]) - mean_x;
    xy += x * (std::log(seconds[i]) - mean_y);
    xx += x * x;
  }
  return xy / xx;
}

void Table::add(const std::string& row, double work, std::vector<Timing> timings) {
  rows_.push_back({row, work, std::move(timings)});
}

void Table::print() const {
  if (rows_.empty()) return;
  fmt::print("{:<16}", rate_unit_);
  for (const auto& timing : rows_.front().timings) fmt::print("{:>24}", timing.name);
  fmt::print("\n");
  for (const auto& row : rows_) {
    fmt::print("{:<16}", row.name);
    for (std::size_t i = 0; i < row.timings.size(); ++i) {
      const auto& timing = row.timings[i];
      const std::string ratio =
          i == 0 ? "" : fmt::format(" ({:.2f} ± {:.2f}x)", timing.ratio_to_first, timing.ratio_spread);
      fmt::print("{:>24}", fmt::format("{:.3g}{}", row.work / timing.seconds, ratio));
    }
    fmt::print("\n");
  }
  std::fflush(stdout);  // the next table takes minutes
}

void let_openblas_choose(char** argv) {
  if (std::getenv("OPENBLAS_CORETYPE") == nullptr && std::getenv("OPENBLAS_L2_SIZE") == nullptr) return;
  ::unsetenv("OPENBLAS_CORETYPE");
  ::unsetenv("OPENBLAS_L2_SIZE");
  ::execv("/proc/self/exe", argv);  // returns only where it fails; then the choice stays as it was
}

std::string run_python(const std::string& arguments) {
  const char* const chosen = std::getenv("LOBE_BENCH_PYTHON");
  const std::string command =
      fmt::format("'{}' {} 2>/dev/null", chosen == nullptr || *chosen == '\0' ? "python3" : chosen, arguments);
  std::string output;
  if (std::FILE* pipe = ::popen(command.c_str(), "r")) {
    std::array<char, 256> buffer{};
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
    ::pclose(pipe);
  }
  return output;
}

void print_setting(const std::string& device, const std::string& driver) {
  double load = 0;
  const bool known = ::getloadavg(&load, 1) == 1;
  fmt::print("{} ({}), {} processors, load {}\n", device, driver, std::thread::hardware_concurrency(),
             known ? fmt::format("{:.1f}", load) : "unknown");
}

}  // namespace bench
