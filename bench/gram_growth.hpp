#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "lobe/device/device.hpp"

namespace bench {

/// Timings to be reported as a google benchmark: a repetition per round.
struct Record {
  std::string name;
  std::vector<double> seconds;
  std::map<std::string, double> counters;
};

struct GrowthOptions {
  std::vector<std::size_t> sizes;  ///< numbers of materials, rising
  double narrowest;                ///< half-vector width of the narrowest lobe, radians
  bool smoke;
};

/// How the cost of Gram and distance matrices grows with the number of materials: the whole of measure() under point
/// light, against peers on the same nodes; accumulation against dsyrk; peak memory; other lightings against point
/// light. Prints tables. Peak memory is that of this program run as measure_peak() asks.
[[nodiscard]] std::vector<Record> run_growth(const lobe::Device& device, const GrowthOptions& options);

/// Measures so many materials and prints the peak memory of the process in MiB: `bench_gram --peak COUNT NARROWEST`.
void measure_peak(std::size_t count, double narrowest);

}  // namespace bench
