#include "view/scenes.hpp"

#include <algorithm>
#include <fstream>
#include <utility>
#include <variant>

#include "lobe/core/error.hpp"
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

ShownScene shown_scene(const fs::path& path, std::string word) {
  SceneFile file = load_scene(path);
  std::string name = file.scene.title.empty() ? path.stem().string() : file.scene.title;
  const std::size_t replaced = replaced_in(file);
  return {std::move(name), std::move(word), std::move(file), replaced};
}

}  // namespace

ShownScenes::ShownScenes(std::span<const std::string> paths, const fs::path& folder) {
  for (const std::string& path : paths) scenes_.push_back(shown_scene(path, path));
  const fs::path path = folder / kBuiltIn;
  {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << view_files::scene_toml;
    if (!file.flush()) throw IoError(path.string() + " cannot be written", {.fault = Fault::no_space});
  }
  scenes_.push_back(shown_scene(path, kBuiltIn));
  scenes_.back().text = view_files::scene_toml;
  std::error_code ignored;
  fs::remove(path, ignored);
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
