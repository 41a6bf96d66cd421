#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobe/render/render_scene.hpp"
#include "lobe/study/scene_file.hpp"

namespace lobe::cli {

/// A scene that the page may show a material in.
struct ShownScene {
  std::string name;            ///< for people
  std::string word;            ///< as the command takes it
  SceneFile file;              ///< what it is
  std::size_t replaced;        ///< index of the material that is replaced at first
  std::string_view text = {};  ///< content of the file if it is built in, which the page can save; else empty
};

/// The scenes of the page: those that the command was given, and one that is built in; and their pictures, which more
/// samples refine. For one thread.
class ShownScenes {
 public:
  /// \param paths of scene files
  /// \throws as load_scene()
  explicit ShownScenes(std::span<const std::string> paths);

  [[nodiscard]] const std::vector<ShownScene>& scenes() const { return scenes_; }
  /// Whether the command was given a scene.
  [[nodiscard]] bool has_given() const { return scenes_.size() > 1; }

  /// The picture of a key, made where it is not known; those of few keys are kept.
  /// \throws what `make` throws
  [[nodiscard]] SceneRendering& rendering(const std::string& key, const std::function<SceneRendering()>& make);

 private:
  std::vector<ShownScene> scenes_;
  std::list<std::pair<std::string, SceneRendering>> renderings_;  ///< the latest used first
};

}  // namespace lobe::cli
