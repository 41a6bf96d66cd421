#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobe/model/sampling_strategy.hpp"
#include "lobe/render/scene.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A comparison of sampling strategies that a scene file asks for.
struct SceneComparison {
  std::size_t material = 0;         ///< index of the material that is replaced
  std::vector<SceneMaterial> with;  ///< reflectances that take its place, in turn
};

/// A scene file: the scene, and how it is to be rendered.
struct SceneFile {
  Scene scene;                                               ///< shapes, lights, camera
  std::size_t samples = 64;                                  ///< samples per pixel
  SamplingStrategy strategy = SamplingStrategy::tailored;    ///< distribution that directions are drawn from
  std::optional<double> exposure = std::nullopt;             ///< factor on radiances for display; none: by the picture
  std::optional<SceneComparison> comparison = std::nullopt;  ///< reflectances to compare strategies with
};

/// Reads a scene file (docs/render.md), and the files that it names.
/// \throws IoError for files that cannot be read; ArgumentError "FILE:LINE:COLUMN: ..." for any mistake in it
[[nodiscard]] SceneFile load_scene(const std::filesystem::path& path);

/// Reads the text of a scene file.
/// \param path what messages call it; files that it names lie in its folder
/// \throws as load_scene()
[[nodiscard]] SceneFile parse_scene(const std::string& text, const std::filesystem::path& path);

}  // namespace lobe
