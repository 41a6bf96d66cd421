#include "plot/colour_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lobe {

std::string ColourRange::note() const {
  return logarithmic ? fmt::format("logarithmic colours; 0 and all below {:.2g} in the darkest", low)
                     : "linear colours";
}

ColourRange colour_range(const Eigen::MatrixXd& distance) {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < distance.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (distance(i, j) > 0 && std::isfinite(distance(i, j))) values.push_back(distance(i, j));
    }
  }
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  const double high = values.back();
  if (high <= 30 * quantile(0.1)) return {0, high, false};
  return {std::max(quantile(0.005), high * 1e-4), high, true};
}

}  // namespace lobe
