#include "fuzz/fuzz_texts.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include "core/text.hpp"
#include "lobe/compare/judgement.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/direction_pairs.hpp"
#include "lobe/lut/lut.hpp"
#include "lobe/lut/lut_file.hpp"
#include "lobe/model/material.hpp"
#include "lobe/render/scene.hpp"
#include "lobe/study/material_file.hpp"
#include "lobe/study/scene_file.hpp"
#include "lobe/study/study.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestComplaint = 2000;  // it may quote the user

[[noreturn]] void fail(std::string_view what, std::string_view detail) {
  std::fprintf(stderr, "lobe_fuzz: %.*s: %.*s\n", static_cast<int>(what.size()), what.data(),
               static_cast<int>(detail.size()), detail.data());
  std::abort();
}

void expect_clear(std::string_view complaint, std::string_view place) {
  if (complaint.size() > kLongestComplaint) fail("a complaint is too long", complaint);
  if (has_control_characters(complaint)) fail("a complaint is no plain line", complaint);
  if (complaint.find(place) == complaint.npos) fail("a complaint without the file", complaint);
}

/// A file with a text, in a folder of its own.
class Written {
 public:
  Written(const char* name, std::string_view text)
      : folder_(fs::temp_directory_path() / ("lobe-fuzz-" + std::to_string(::getpid()))), path_(folder_ / name) {
    fs::create_directories(folder_);
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~Written() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Written(const Written&) = delete;
  Written& operator=(const Written&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path folder_, path_;
};

/// Reads, or refuses in one clear line.
template <typename Read>
void read_or_refuse(std::string_view place, const Read& read) {
  try {
    read();
  } catch (const IoError& error) {
    expect_clear(error.what(), place);
  } catch (const ArgumentError& error) {
    expect_clear(error.what(), place);
  }
}

/// A lookup table of 2 x 3 entries of somebody else.
void read_lut_of(const char* name, std::string_view content) {
  const Written file(name, content);
  LutRequest request{.reflectance = make_material("lambert")};
  for (const std::size_t count : {2U, 3U})
    request.axes.push_back({.name = count == 2 ? "alpha" : "theta", .count = count});
  read_or_refuse(name, [&] {
    if (read_lut(file.path(), request).values.size() != 6) fail("a table of another size", content);
  });
}

}  // namespace

void fuzz_study(std::string_view text) {
  const Written file("study.toml", text);
  read_or_refuse("", [&] {
    const Study study = load_study(file.path());
    if (study.materials.empty() && study.published.empty() && study.charts.empty()) fail("a study", "of nothing");
    for (const Material& material : formulas(study)) {
      if (has_control_characters(material.name)) fail("a name has control characters", material.name);
    }
  });
}

void fuzz_material_file(std::string_view text) {
  const Written file("material.toml", text);
  read_or_refuse("", [&] {
    const Material material = load_material_file(file.path());
    // Writing it again gives the same text.
    const std::string written = material_toml(material);
    const Written again("again.toml", written);
    if (material_toml(load_material_file(again.path())) != written) fail("another material", written);
  });
}

void fuzz_scene(std::string_view text) {
  const Written file("scene.toml", text);
  read_or_refuse("", [&] {
    const SceneFile read = load_scene(file.path());
    for (const SceneShape& shape : read.scene.shapes) {
      if (shape.material >= read.scene.materials.size()) fail("a shape", "of no material");
    }
  });
}

void fuzz_mesh(std::string_view text) {
  const Written file("mesh.obj", text);
  read_or_refuse("", [&] {
    const MeshShape mesh = load_mesh(file.path());
    const auto is_there = [](const auto& list, std::size_t count) {
      return std::ranges::all_of(
          list, [&](const auto& three) { return std::ranges::all_of(three, [&](auto k) { return k < count; }); });
    };
    if (!is_there(mesh.triangles, mesh.vertices.size())) fail("a triangle", "without a corner");
    if (!is_there(mesh.triangle_normals, mesh.normals.size())) fail("a triangle", "without a normal");
    if (!mesh.triangle_normals.empty() && mesh.triangle_normals.size() != mesh.triangles.size()) {
      fail("a mesh", "with other normals than triangles");
    }
  });
}

void fuzz_specification(std::string_view text) {
  read_or_refuse("", [&] {
    const Material material = parse_material(text);
    if (material.terms.empty()) fail("a material of nothing", text);
  });
}

void fuzz_judgements(std::string_view text) {
  read_or_refuse("", [&] { (void)parse_judgements(text); });
}

void fuzz_pairs(std::string_view text) {
  const Written file("pairs.csv", text);
  BrdfFunction brdf;
  brdf.name = "matt";
  brdf.channels = {"value"};
  brdf.at = [](std::span<const Directions> pairs) {
    return BrdfValues{Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(pairs.size()), 1, 0.25), {}};
  };
  read_or_refuse("pairs.csv", [&] {
    std::string answers;
    const PairSummary summary = evaluate_pairs(Device::on_demand(), brdf, file.path(), answers);
    const auto lines = static_cast<std::size_t>(std::count(answers.begin(), answers.end(), '\n'));
    if (lines != summary.pairs + 1) fail("pairs without an answer", answers);
  });
}

void fuzz_lut_axis(std::string_view text) {
  read_or_refuse("", [&] {
    const Reflectance ggx = make_material("ggx", {{"alpha", 0.5}, {"f0", 1}});
    const LutAxis axis = parse_lut_axis(text, ggx);
    // Written out it is read as the same, and its entries lie within its range.
    if (parse_lut_axis(to_string(axis), ggx) != axis) fail("another axis", to_string(axis));
    for (std::size_t i = 0; i < axis.count; i += 1 + axis.count / 4) {
      const double value = axis.value(axis.coordinate(i));
      const double slack = 1e-9 * (std::abs(axis.from) + std::abs(axis.to));
      if (!(value >= std::min(axis.from, axis.to) - slack && value <= std::max(axis.from, axis.to) + slack)) {
        fail("an entry beyond the range", to_string(axis));
      }
    }
  });
}

void fuzz_lut_image(std::string_view bytes) {
  read_lut_of("lut.png", bytes);
}

void fuzz_lut_exr(std::string_view bytes) {
  read_lut_of("lut.exr", bytes);
}

void fuzz_lut_ktx2(std::string_view bytes) {
  read_lut_of("lut.ktx2", bytes);
}

void fuzz_lut_array(std::string_view text) {
  for (const char* name : {"lut.h", "lut.spi1d", "lut.csv"}) read_lut_of(name, text);
}

}  // namespace lobe::test
