#include "lobe/plot/scene_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lobe/core/colour.hpp"
#include "lut/exr.hpp"
#include "plot/png.hpp"

namespace lobe {

double scene_exposure(const SceneImage& image) {
  constexpr double kShare = 0.98;
  std::vector<double> numbers(image.radiance.data(), image.radiance.data() + image.radiance.size());
  if (numbers.empty()) return 1;
  const auto place = static_cast<std::ptrdiff_t>(kShare * static_cast<double>(numbers.size() - 1));
  std::ranges::nth_element(numbers, numbers.begin() + place);
  const double white = numbers[static_cast<std::size_t>(place)];
  return white > 0 ? 1 / white : 1;
}

std::string scene_png(const SceneImage& image, double exposure) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(image.radiance.size()));
  for (Eigen::Index pixel = 0; pixel < image.radiance.cols(); ++pixel) {
    for (const double radiance : image.radiance.col(pixel)) {
      const double shown = encode_srgb(std::clamp(exposure * radiance, 0.0, 1.0));
      rgb.push_back(static_cast<std::uint8_t>(std::lround(255 * shown)));
    }
  }
  return png_file(image.size[0], image.size[1], rgb);
}

std::string scene_exr(const SceneImage& image) {
  FloatImage picture{.width = image.size[0],
                     .height = image.size[1],
                     .channels = {"R", "G", "B", "variance.R", "variance.G", "variance.B"},
                     .values = {}};
  // Numbers of 32 bits add their own rounding, which is even within half a unit of the last place.
  constexpr double kHalfUnit = 0x1p-24;
  const Eigen::Matrix3Xd variance =
      image.variance_of_mean() + ((kHalfUnit * image.radiance).array().square() / 3).matrix();
  for (Eigen::Index pixel = 0; pixel < image.radiance.cols(); ++pixel) {
    for (const double value : image.radiance.col(pixel)) picture.values.push_back(static_cast<float>(value));
    for (const double value : variance.col(pixel)) picture.values.push_back(static_cast<float>(value));
  }
  constexpr int kBits = 32;
  return exr_content(picture, kBits, {{"samples", std::to_string(image.samples)}});
}

}  // namespace lobe
