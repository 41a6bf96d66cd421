#include "lobe/measurement.hpp"

#include <cmath>
#include <string>

#include "lobe/error.hpp"

namespace lobe {

std::size_t own_channels(const BrdfFunction& brdf) {
  return brdf.channels.size() / (1 + brdf.replicates);
}

std::vector<double> measurement_deviations(const BrdfFunction& brdf, std::span<const double> numbers) {
  if (numbers.size() != brdf.channels.size()) {
    throw ArgumentError("deviations of " + std::to_string(numbers.size()) + " numbers; expected one for each of the " +
                        std::to_string(brdf.channels.size()) + " channels of '" + brdf.name + "'");
  }
  std::vector<double> deviations;
  if (brdf.replicates < 2) return deviations;
  const std::size_t own = own_channels(brdf);
  const auto count = static_cast<double>(brdf.replicates);
  for (std::size_t c = 0; c < own; ++c) {
    double mean = 0;
    for (std::size_t k = own + c; k < numbers.size(); k += own) mean += numbers[k] / count;
    double squares = 0;
    for (std::size_t k = own + c; k < numbers.size(); k += own) squares += (numbers[k] - mean) * (numbers[k] - mean);
    deviations.push_back(std::sqrt(squares / (count - 1)));
  }
  return deviations;
}

}  // namespace lobe
