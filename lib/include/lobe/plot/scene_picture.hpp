#pragma once

#include <string>

#include "lobe/render/render_scene.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Factor on radiances with which 98 % of the numbers in a picture are at most the display's white; 1 for black ones.
[[nodiscard]] double scene_exposure(const SceneImage& image);

/// Content of a PNG file of a picture, in sRGB.
/// \param exposure factor on radiances; what is then above 1 is white
[[nodiscard]] std::string scene_png(const SceneImage& image, double exposure);

/// Content of an OpenEXR file of a picture: channels R, G and B, the radiance, and variance.R, variance.G and
/// variance.B, the variance of its mean in each pixel, as numbers of 32 bits; `samples` is an attribute.
[[nodiscard]] std::string scene_exr(const SceneImage& image);

}  // namespace lobe
