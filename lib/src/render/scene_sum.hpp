#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "lobe/render/render_scene.hpp"

namespace lobe {

/// Adds samples to means and to sums of squared differences from them (Welford 1962).
class SceneSum {
 public:
  /// \param rounding relative rounding of radiances
  SceneSum(std::size_t pixels, double rounding)
      : mean_(Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(pixels))), squares_(mean_), rounding_(rounding) {}

  void add(const Eigen::Matrix3Xd& radiances) {
    const Eigen::Index pixels = mean_.cols();
    for (Eigen::Index first = 0; first < radiances.cols(); first += pixels) {
      ++samples_;
      const auto sample = radiances.middleCols(first, pixels);
      const Eigen::Matrix3Xd difference = sample - mean_;
      mean_ += difference / static_cast<double>(samples_);
      squares_ += difference.cwiseProduct(sample - mean_);
    }
  }

  [[nodiscard]] SceneImage image(const SceneCamera& camera, double seconds) const {
    const double freedom = static_cast<double>(samples_) - 1;
    return {camera.size, mean_, squares_ / std::max(freedom, 1.0), samples_, seconds, rounding_};
  }
  [[nodiscard]] std::size_t samples() const { return samples_; }

 private:
  Eigen::Matrix3Xd mean_;
  Eigen::Matrix3Xd squares_;
  double rounding_;
  std::size_t samples_ = 0;
};

}  // namespace lobe
