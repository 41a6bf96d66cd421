#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/files.hpp"
#include "lobe/render/scene.hpp"

namespace lobe {
namespace {

constexpr std::size_t kMostTriangles = 4'000'000;

/// A corner of a face: indices of its vertex and its normal.
struct FaceCorner {
  std::uint32_t vertex = 0;
  std::uint32_t normal = 0;
  bool has_normal = false;
};

/// Source: Wavefront Advanced Visualizer, appendix B1, "Object files".
class ObjReader {
 public:
  explicit ObjReader(std::string name) : name_(std::move(name)) {}

  [[nodiscard]] MeshShape read(std::string_view text) {
    std::string begun;  // of a line that goes on in the next one
    std::size_t lines = 0;
    for (const auto written : split(text, '\n')) {
      ++lines;
      if (begun.empty()) line_ = lines;
      std::string_view line = written.substr(0, written.find('#'));
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.ends_with('\\')) {
        line.remove_suffix(1);
        begun.append(line) += ' ';
        continue;
      }
      if (begun.empty()) {
        read_line(words_of(line));
        continue;
      }
      begun.append(line);
      read_line(words_of(begun));
      begun.clear();
    }
    if (!begun.empty()) fail("the file ends in a line that is to go on; expected no '\\' at its end");
    if (mesh_.triangles.empty()) {
      throw IoError(name_ + " has no faces; expected lines 'f' of vertices", {.fault = Fault::content, .path = name_});
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw IoError(fmt::format("{}:{}: {}", name_, line_, message), {.fault = Fault::content, .path = name_});
  }

  static std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    std::size_t at = 0;
    constexpr std::string_view kBlanks = " \t\r\v\f";
    while ((at = line.find_first_not_of(kBlanks, at)) != std::string_view::npos) {
      const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
      words.push_back(line.substr(at, end - at));
      at = end;
    }
    return words;
  }

  void read_line(const std::vector<std::string_view>& words) {
    if (words.empty()) return;
    const std::string_view key = words.front();
    if (key == "v") return mesh_.vertices.push_back(numbers_of(words, "vertex"));
    if (key == "vn") return read_normal(words);
    if (key == "f") return read_face(words);
    // Textures, groups, display attributes, and points and lines, which have no surface.
    for (const std::string_view passed :
         {"vt", "vp", "p", "l", "g", "o", "s", "mg", "usemtl", "mtllib", "usemap", "maplib", "bevel", "c_interp",
          "d_interp", "lod", "shadow_obj", "trace_obj"}) {
      if (key == passed) return;
    }
    fail(
        fmt::format("'{}' is no element of a mesh that lobe reads; expected v, vn or f, or p and l, which have no "
                    "surface",
                    excerpt(key)));
  }

  [[nodiscard]] SpaceVector numbers_of(const std::vector<std::string_view>& words, std::string_view what) const {
    SpaceVector numbers{};
    if (words.size() < numbers.size() + 1) fail(fmt::format("a {} of fewer than three numbers; expected three", what));
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (!parse_number(words[k + 1], numbers[k]) || !std::isfinite(numbers[k])) {
        fail(fmt::format("'{}' is no number; expected three numbers of a {}", excerpt(words[k + 1]), what));
      }
    }
    return numbers;
  }

  void read_normal(const std::vector<std::string_view>& words) {
    const SpaceVector normal = numbers_of(words, "normal");
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    if (!(length > 0) || !std::isfinite(length))
      fail("a normal without direction; expected numbers, not all of them 0");
    mesh_.normals.push_back(normal);
  }

  /// Index of an entry: from 1 on, or from the end backwards.
  [[nodiscard]] std::uint32_t index_of(std::string_view word, std::size_t count, std::string_view what) const {
    std::int64_t written = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), written);
    if (code != std::errc() || end != word.data() + word.size()) {
      fail(fmt::format("'{}' is no index of a {}; expected a whole number", excerpt(word), what));
    }
    const auto size = static_cast<std::int64_t>(count);
    const std::int64_t index = written < 0 ? size + written : written - 1;
    if (index < 0 || index >= size || index > std::numeric_limits<std::uint32_t>::max()) {
      fail(fmt::format("there is no {} {} before this line; expected one of {}", what, written, count));
    }
    return static_cast<std::uint32_t>(index);
  }

  /// "VERTEX", "VERTEX/TEXTURE", "VERTEX//NORMAL" or "VERTEX/TEXTURE/NORMAL".
  [[nodiscard]] FaceCorner corner_of(std::string_view word) const {
    const auto parts = split(word, '/');
    if (parts.size() > 3)
      fail(fmt::format("'{}' is no corner of a face; expected V, V/T, V//N or V/T/N", excerpt(word)));
    FaceCorner corner;
    corner.vertex = index_of(parts[0], mesh_.vertices.size(), "vertex");
    corner.has_normal = parts.size() == 3;
    if (corner.has_normal) corner.normal = index_of(parts[2], mesh_.normals.size(), "normal");
    return corner;
  }

  void read_face(const std::vector<std::string_view>& words) {
    std::vector<FaceCorner> corners;
    for (std::size_t k = 1; k < words.size(); ++k) corners.push_back(corner_of(words[k]));
    if (corners.size() < 3) fail(fmt::format("a face of {} corners; expected at least three", corners.size()));
    const bool has_normals = corners.front().has_normal;
    for (const FaceCorner& corner : corners) {
      if (corner.has_normal != has_normals) fail("a face with normals at some of its corners; expected all or none");
    }
    if (!mesh_.triangles.empty() && has_normals == mesh_.triangle_normals.empty()) {
      fail("faces with and without normals; expected the same for all faces");
    }
    if (mesh_.triangles.size() + corners.size() > kMostTriangles) {
      fail(fmt::format("more than {} triangles; expected a smaller mesh", kMostTriangles));
    }
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      const std::array three{corners[0], corners[k], corners[k + 1]};
      mesh_.triangles.push_back({three[0].vertex, three[1].vertex, three[2].vertex});
      if (has_normals) mesh_.triangle_normals.push_back({three[0].normal, three[1].normal, three[2].normal});
    }
  }

  std::string name_;
  std::size_t line_ = 0;
  MeshShape mesh_;
};

}  // namespace

MeshShape load_mesh(const std::filesystem::path& path) {
  return ObjReader(printable(path.string())).read(read_text(path));
}

}  // namespace lobe
