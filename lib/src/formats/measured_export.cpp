#include "lobe/formats/measured_export.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "formats/format.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/as_function.hpp"

namespace lobe {
namespace {

std::vector<Directions> random_pairs() {
  constexpr std::size_t kPairs = 4000;
  constexpr double kLargest = 75 * kDegree;
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> theta(0, kLargest);
  std::uniform_real_distribution<double> phi(-std::numbers::pi, std::numbers::pi);
  std::vector<Directions> pairs(kPairs);
  for (Directions& pair : pairs) pair = {theta(engine), theta(engine), phi(engine), phi(engine)};
  return pairs;
}

}  // namespace

bool holds_cells(std::string_view format) {
  return std::ranges::any_of(formats(),
                             [&](const Format* known) { return known->name == format && known->holds_cells; });
}

bool holds_deviations(std::string_view format) {
  return std::ranges::any_of(formats(),
                             [&](const Format* known) { return known->name == format && known->holds_deviations; });
}

Deviation deviation(const Device& device, const Reflectance& original, const Reflectance& read) {
  const BrdfFunction exact = as_function(device, original);
  const BrdfFunction found = as_function(device, read);
  if (found.channels.size() < exact.channels.size()) {
    throw NumericError("'" + found.name + "' has fewer channels than '" + exact.name + "'; expected at least as many");
  }
  const auto pairs = random_pairs();
  const Eigen::ArrayXXd expected = exact.at(pairs).value.array();
  const Eigen::ArrayXXd seen = found.at(pairs).value.leftCols(expected.cols()).array();
  std::vector<double> relative;
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    const double value = std::abs(expected(i));
    if (value > 0) relative.push_back(std::abs(seen(i) - expected(i)) / value);
  }
  Deviation result;
  if (relative.empty()) return result;
  const auto middle = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2);
  std::nth_element(relative.begin(), middle, relative.end());
  result.median = *middle;
  result.rms = std::sqrt((seen - expected).square().sum() / expected.square().sum());
  result.largest = (seen - expected).abs().maxCoeff() / expected.abs().maxCoeff();
  return result;
}

}  // namespace lobe
