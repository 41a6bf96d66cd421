#pragma once

#include <Eigen/Core>
#include <string>

namespace lobe {

/// Range of the colours in a distance matrix.
struct ColourRange {
  double low = 0;
  double high = 1;
  bool logarithmic = false;

  /// In words.
  [[nodiscard]] std::string note() const;
};

/// Linear from 0, or, when most of the picture would be one colour otherwise, logarithmic over at most four decades, of
/// which the smallest distances in two hundred may fall short.
[[nodiscard]] ColourRange colour_range(const Eigen::MatrixXd& distance);

}  // namespace lobe
