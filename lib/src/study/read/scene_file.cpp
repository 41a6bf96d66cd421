#include "lobe/study/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/chosen_file.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "render/scene_geometry.hpp"
#include "render/scene_surface.hpp"
#include "study/read/material_reader.hpp"
#include "study/read/study_path.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;
namespace reader = toml_reader;

using Keys = std::span<const std::string_view>;

constexpr std::array<std::string_view, 11> kSceneTables{"scene", "camera",   "materials", "sky",  "light",     "sphere",
                                                        "box",   "cylinder", "plane",     "mesh", "comparison"};

/// A table of a scene file, whose keys are checked.
class SceneTable {
 public:
  SceneTable(const toml::table& table, std::string where, Keys keys) : table_(table), where_(std::move(where)) {
    reader::require_known_keys(table_, keys, where_);
  }

  [[nodiscard]] const toml::node* find(std::string_view key) const { return table_.get(key); }
  [[nodiscard]] const toml::node& at(std::string_view key) const { return reader::require(table_, key, where_); }
  [[nodiscard]] const toml::table& table() const { return table_; }

  /// Three numbers.
  [[nodiscard]] SpaceVector vector(std::string_view key) const { return numbers<3>(key, "three numbers, [x, y, z]"); }
  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(std::string_view key, std::string_view expected) const {
    const toml::node& node = at(key);
    const std::vector<double> values = reader::numbers(node, key);
    std::array<double, N> array{};
    if (values.size() != N) {
      reader::fail(node, fmt::format("{} has {} values; expected {}", key, values.size(), expected));
    }
    std::ranges::copy(values, array.begin());
    return array;
  }
  /// A number that has to be above 0.
  [[nodiscard]] double length(std::string_view key) const {
    const double value = reader::number(at(key), key);
    if (!(value > 0)) reader::fail(at(key), fmt::format("{} is {}; expected a value above 0", key, shortest(value)));
    return value;
  }
  /// A number, or three of red, green and blue; none below 0.
  [[nodiscard]] LinearColour colour(std::string_view key) const {
    const toml::node& node = at(key);
    LinearColour colour{};
    if (node.is_number()) {
      colour.fill(reader::number(node, key));
    } else {
      colour = numbers<3>(key, "one number, or three, of red, green and blue");
    }
    if (std::ranges::any_of(colour, [](double x) { return x < 0; })) {
      reader::fail(node, fmt::format("{} has a value below 0; expected values of at least 0", key));
    }
    return colour;
  }
  /// A whole number.
  [[nodiscard]] std::size_t count(std::string_view key, std::size_t least, std::size_t most) const {
    return count_of(at(key), key, least, most);
  }
  [[nodiscard]] static std::size_t count_of(const toml::node& node, std::string_view what, std::size_t least,
                                            std::size_t most) {
    const auto* count = node.as_integer();
    if (count == nullptr || count->get() < static_cast<std::int64_t>(least) ||
        count->get() > static_cast<std::int64_t>(most)) {
      const std::string given = node.is_number() ? shortest(reader::number(node, what)) : reader::kind_of(node);
      reader::fail(node, fmt::format("{} is {}; expected a whole number from {} to {}", what, given, least, most));
    }
    return static_cast<std::size_t>(count->get());
  }
  [[nodiscard]] std::string text(std::string_view key) const { return reader::text(at(key), key); }
  /// Degrees as radians; 0 without the key.
  [[nodiscard]] double angle(std::string_view key) const {
    const toml::node* node = find(key);
    return node == nullptr ? 0 : reader::number(*node, key) * kDegree;
  }

 private:
  const toml::table& table_;
  std::string where_;
};

/// Whether a text that is no file looks like the name of one: names of models have no slash or point before a value.
bool names_file(std::string_view text) {
  const std::size_t mark = text.find_first_of("/.");
  return mark != std::string_view::npos && text.find_first_of(":=") > mark;
}

/// Adds the place in the scene to what is wrong with a file that it names.
template <typename Call>
auto located_file(const toml::node& place, const Call& call) {
  try {
    return located(place, call);
  } catch (const IoError& error) {
    const toml::source_region& source = place.source();
    const std::string where = source.path ? *source.path : std::string();
    throw IoError(fmt::format("{}:{}:{}: {}", where, source.begin.line, source.begin.column, error.what()),
                  {.fault = error.fault(), .path = error.path()});
  }
}

Reflectance read_reflectance(const toml::node& node, std::string_view what, const fs::path& directory) {
  const std::string written = reader::text(node, what);
  return located_file(node, [&]() -> Reflectance {
    ChosenFile file = parse_file(written);
    const fs::path path = directory / expanded_path(node, file.path.string());
    std::error_code ignored;
    const bool is_file = fs::is_regular_file(path, ignored) || file.has_brackets || names_file(file.path.string());
    if (!is_file) return parse_material(written);
    file.path = path;
    return load_reflectance(file);
  });
}

/// A MeshShape of the file that a table names, in its place.
MeshShape read_mesh(const SceneTable& table, const fs::path& directory) {
  const toml::node& node = table.at("file");
  const fs::path path = directory / expanded_path(node, reader::text(node, "file"));
  MeshShape mesh = located_file(node, [&] { return load_mesh(path); });
  const SpaceVector position = table.find("position") != nullptr ? table.vector("position") : SpaceVector{};
  const double scale = table.find("scale") != nullptr ? table.length("scale") : 1;
  const double turn = table.angle("turn");
  const auto turned = [&](const SpaceVector& v) -> SpaceVector {
    return {std::cos(turn) * v[0] - std::sin(turn) * v[1], std::sin(turn) * v[0] + std::cos(turn) * v[1], v[2]};
  };
  for (SpaceVector& vertex : mesh.vertices) {
    vertex = turned(vertex);
    for (std::size_t k = 0; k < 3; ++k) vertex.at(k) = position.at(k) + scale * vertex.at(k);
  }
  for (SpaceVector& normal : mesh.normals) normal = turned(normal);
  return mesh;
}

/// Reads a scene from its table.
class SceneReading {
 public:
  explicit SceneReading(const fs::path& path) : directory_(path.parent_path()) {}

  [[nodiscard]] SceneFile read(const toml::table& root) {
    reader::require_known_keys(root, kSceneTables, "a scene file");
    read_settings(root);
    read_camera(table_of(root, "camera"));
    read_materials(table_of(root, "materials"));
    read_sky(root);
    for_each(root, "light", [&](const toml::table& table) { read_light(table); });
    for (const std::string_view form : {"sphere", "box", "cylinder", "plane", "mesh"}) {
      for_each(root, form, [&](const toml::table& table) { read_shape(table, form); });
    }
    if (file_.scene.shapes.empty()) {
      reader::fail(root,
                   "the scene has no shapes; expected a [[sphere]], [[box]], [[cylinder]], [[plane]] or [[mesh]]");
    }
    read_comparison(root);
    located(root, [&] {
      require_valid(file_.scene);
      return true;
    });
    return std::move(file_);
  }

 private:
  static const toml::table& table_of(const toml::table& root, std::string_view key) {
    return reader::table(reader::require(root, key, "a scene file"), key);
  }

  template <typename Work>
  static void for_each(const toml::table& root, std::string_view key, const Work& work) {
    const toml::node* node = root.get(key);
    if (node == nullptr) return;
    if (!node->is_array() || !node->is_array_of_tables()) {
      reader::fail(*node, fmt::format("'{0}' is {1}; expected tables headed [[{0}]]", key, reader::kind_of(*node)));
    }
    for (const auto& entry : *node->as_array()) work(*entry.as_table());
  }

  void read_settings(const toml::table& root) {
    const toml::node* node = root.get("scene");
    if (node == nullptr) return;
    constexpr std::array<std::string_view, 5> kKeys{"title", "bounces", "samples", "strategy", "exposure"};
    const SceneTable table(reader::table(*node, "scene"), "[scene]", kKeys);
    if (table.find("title") != nullptr) file_.scene.title = table.text("title");
    if (table.find("bounces") != nullptr) file_.scene.bounces = table.count("bounces", 0, kMostBounces);
    constexpr std::size_t kMostSamples = 1'000'000;
    if (table.find("samples") != nullptr) file_.samples = table.count("samples", 2, kMostSamples);
    if (table.find("exposure") != nullptr) file_.exposure = table.length("exposure");
    if (table.find("strategy") == nullptr) return;
    const std::string strategy = table.text("strategy");
    if (strategy != "importance" && strategy != "cosine") {
      reader::fail(table.at("strategy"),
                   fmt::format("strategy is '{}'; expected \"importance\" or \"cosine\"", excerpt(strategy)));
    }
    file_.strategy = strategy == "cosine" ? SamplingStrategy::cosine : SamplingStrategy::tailored;
  }

  void read_camera(const toml::table& given) {
    constexpr std::array<std::string_view, 5> kKeys{"position", "target", "up", "field_of_view", "size"};
    const SceneTable table(given, "[camera]", kKeys);
    SceneCamera& camera = file_.scene.camera;
    camera.position = table.vector("position");
    camera.target = table.vector("target");
    if (table.find("up") != nullptr) camera.up = table.vector("up");
    if (const toml::node* node = table.find("field_of_view")) {
      const double degrees = reader::number(*node, "field_of_view");
      if (!(degrees > 0 && degrees < 180)) {
        reader::fail(*node,
                     fmt::format("field_of_view is {} degrees; expected a value between 0 and 180", shortest(degrees)));
      }
      camera.field_of_view = degrees * kDegree;
    }
    if (const toml::node* node = table.find("size")) {
      const toml::array& sizes = reader::array(*node, "size");
      if (sizes.size() != 2) {
        reader::fail(*node, fmt::format("size has {} values; expected two, of width and height", sizes.size()));
      }
      constexpr std::size_t kLargest = 8192;
      for (std::size_t k = 0; k < 2; ++k) {
        camera.size.at(k) = SceneTable::count_of(*sizes.get(k), "an entry of size", 1, kLargest);
      }
    }
  }

  void read_materials(const toml::table& given) {
    for (const auto& [key, node] : given) {
      const std::string name(key.str());
      file_.scene.materials.push_back({name, read_reflectance(node, "a material", directory_)});
      require_colours(node, file_.scene.materials.back());
    }
  }

  static void require_colours(const toml::node& node, const SceneMaterial& material) {
    located(node, [&] { (void)scene_colours(material); });
  }

  [[nodiscard]] std::size_t material_of(const SceneTable& table, std::string_view key) const {
    const std::string name = table.text(key);
    const auto& materials = file_.scene.materials;
    const auto found = std::ranges::find(materials, name, &SceneMaterial::name);
    if (found != materials.end()) return static_cast<std::size_t>(found - materials.begin());
    std::vector<std::string_view> names;
    for (const SceneMaterial& material : materials) names.push_back(material.name);
    reader::fail(table.at(key), fmt::format("there is no material '{}'{}", excerpt(name), did_you_mean(name, names)));
  }

  void read_sky(const toml::table& root) {
    const toml::node* node = root.get("sky");
    if (node == nullptr) return;
    constexpr std::array<std::string_view, 2> kKeys{"kind", "radiance"};
    const SceneTable table(reader::table(*node, "sky"), "[sky]", kKeys);
    file_.scene.sky.radiance = table.colour("radiance");
    if (table.find("kind") == nullptr) return;
    const std::string kind = table.text("kind");
    if (kind != "uniform" && kind != "overcast") {
      reader::fail(table.at("kind"), fmt::format("kind is '{}'; expected \"uniform\" or \"overcast\"", excerpt(kind)));
    }
    file_.scene.sky.kind = kind == "overcast" ? SkyKind::overcast : SkyKind::uniform;
  }

  void read_light(const toml::table& given) {
    constexpr std::array<std::string_view, 2> kKeys{"position", "intensity"};
    const SceneTable table(given, "[[light]]", kKeys);
    file_.scene.lights.push_back({table.vector("position"), table.colour("intensity")});
  }

  void read_shape(const toml::table& given, std::string_view form) {
    static constexpr std::array<std::string_view, 3> kSphere{"material", "centre", "radius"};
    static constexpr std::array<std::string_view, 4> kBox{"material", "centre", "size", "turn"};
    static constexpr std::array<std::string_view, 4> kCylinder{"material", "base", "axis", "radius"};
    static constexpr std::array<std::string_view, 4> kPlane{"material", "centre", "normal", "size"};
    static constexpr std::array<std::string_view, 5> kMesh{"material", "file", "position", "scale", "turn"};
    const std::string where = fmt::format("[[{}]]", form);
    SceneShape shape;
    const auto begin = [&](Keys keys) {
      SceneTable table(given, where, keys);
      shape.material = material_of(table, "material");
      return table;
    };
    if (form == "sphere") {
      const SceneTable table = begin(kSphere);
      shape.geometry = SphereShape{table.vector("centre"), table.length("radius")};
    } else if (form == "box") {
      const SceneTable table = begin(kBox);
      shape.geometry = BoxShape{table.vector("centre"), table.vector("size"), table.angle("turn")};
    } else if (form == "cylinder") {
      const SceneTable table = begin(kCylinder);
      shape.geometry = CylinderShape{table.vector("base"), table.vector("axis"), table.length("radius")};
    } else if (form == "plane") {
      const SceneTable table = begin(kPlane);
      PlaneShape plane{.centre = table.vector("centre")};
      if (table.find("normal") != nullptr) plane.normal = table.vector("normal");
      if (table.find("size") != nullptr) plane.size = table.numbers<2>("size", "two, along the surface's x and y");
      shape.geometry = plane;
    } else {
      shape.geometry = read_mesh(begin(kMesh), directory_);
    }
    // What a table alone may get wrong is said where it stands.
    Scene alone;
    alone.materials = file_.scene.materials;
    alone.shapes.push_back(shape);
    located(given, [&] {
      require_valid(alone);
      return true;
    });
    file_.scene.shapes.push_back(std::move(shape));
  }

  void read_comparison(const toml::table& root) {
    const toml::node* node = root.get("comparison");
    if (node == nullptr) return;
    constexpr std::array<std::string_view, 2> kKeys{"material", "with"};
    const SceneTable table(reader::table(*node, "comparison"), "[comparison]", kKeys);
    SceneComparison comparison{material_of(table, "material"), {}};
    for (const auto& entry : reader::array(table.at("with"), "with")) {
      comparison.with.push_back(
          {reader::text(entry, "an entry of with"), read_reflectance(entry, "an entry of with", directory_)});
      require_colours(entry, comparison.with.back());
    }
    if (comparison.with.empty()) reader::fail(table.at("with"), "with is empty; expected at least one reflectance");
    file_.comparison = std::move(comparison);
  }

  fs::path directory_;
  SceneFile file_;
};

}  // namespace

SceneFile load_scene(const fs::path& path) {
  return parse_scene(read_text(path), path);
}

SceneFile parse_scene(const std::string& text, const fs::path& path) {
  return SceneReading(path).read(reader::parse(text, path));
}

}  // namespace lobe
