#include "view/scenes.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <variant>

#include "view_files.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBuiltIn = "lobe-view.toml";

/// What a comparison replaces, else the material of the first thing that is no plane.
std::size_t replaced_in(const SceneFile& file) {
  if (file.comparison) return file.comparison->material;
  const auto& shapes = file.scene.shapes;
  const auto is_thing = [](const SceneShape& shape) { return !std::holds_alternative<PlaneShape>(shape.geometry); };
  const auto thing = std::ranges::find_if(shapes, is_thing);
  return thing != shapes.end() ? thing->material : shapes.front().material;
}

ShownScene shown_scene(SceneFile file, const std::string& word) {
  std::string name = file.scene.title.empty() ? fs::path(word).stem().string() : file.scene.title;
  const std::size_t replaced = replaced_in(file);
  return {std::move(name), word, std::move(file), replaced};
}

}  // namespace

ShownScenes::ShownScenes(std::span<const std::string> paths) {
  for (const std::string& path : paths) scenes_.push_back(shown_scene(load_scene(path), path));
  scenes_.push_back(shown_scene(parse_scene(std::string(view_files::scene_toml), kBuiltIn), kBuiltIn));
  scenes_.back().text = view_files::scene_toml;
}

SceneRendering& ShownScenes::rendering(const std::string& key, const std::function<SceneRendering()>& make) {
  constexpr std::size_t kMost = 4;
  const auto found = std::ranges::find(renderings_, key, [](const auto& one) { return one.first; });
  if (found != renderings_.end()) {
    renderings_.splice(renderings_.begin(), renderings_, found);
  } else {
    renderings_.emplace_front(key, make());
    if (renderings_.size() > kMost) renderings_.pop_back();
  }
  return renderings_.front().second;
}

}  // namespace lobe::cli
