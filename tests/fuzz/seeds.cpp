// Writes seeds for fuzzing, cut small from samples of each format.
// usage: lobe_fuzz_seeds                     names the formats
//        lobe_fuzz_seeds FORMAT DIRECTORY    writes into it
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "formats/npy.hpp"
#include "fuzz/fuzz_checkpoint.hpp"
#include "fuzz/fuzz_shard.hpp"
#include "lobe/lut/lut_file.hpp"
#include "support/format_samples.hpp"
#include "support/hostile_formulas.hpp"

namespace {

using namespace lobe;

constexpr std::size_t kLargest = std::size_t{4} << 20;            // bytes of a sample
constexpr std::size_t kCostly = std::size_t{8} << 20;             // of samples that take long with sanitizers
constexpr std::array<std::size_t, 3> kCuts{256, 4096, 1U << 16};  // bytes of what is made of it

void write_seeds(const Format& format, const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  const auto samples = test::samples_of(format, kLargest);
  for (const auto& [name, content, cost] : samples) {
    if (cost > kCostly && samples.size() > 1) continue;
    for (const std::size_t cut : kCuts) {
      std::ofstream(directory / (name + "." + std::to_string(cut)), std::ios::binary) << content.substr(0, cut);
      if (cut >= content.size()) break;
    }
  }
}

/// Arrays of NumPy, which are no format of reflectances of their own.
void write_arrays(const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  const std::array<double, 6> values{0, 0.5, 1, 1e300, -2, 3};
  const std::array<std::size_t, 2> shape{2, 3};
  const std::string content = npy_content(shape, values);
  std::ofstream(directory / "rows", std::ios::binary) << content;
  std::string columns = content;
  columns.replace(columns.find("False"), 5, "True ");
  std::ofstream(directory / "columns", std::ios::binary) << columns;
}

/// Formulas that are understood, and those that are not.
void write_formulas(const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  std::vector<std::string> texts = test::hostile_formulas();
  for (const char* text :
       {"user_n * (user_exp + 2) / (2 * pi) * exp(user_n * log_rv)\n / fmax(cos_i, cos_o)",
        "where(cos_lv > 0.7 && !(cos_i <= 1e-3 || theta_o != 0.5), 1.0, -.5) / pi",
        "exp(-(half_x * half_x / 0.04 + half_y * half_y / 0.25) / (cos_h * cos_h)) / sqrt(cos_i * cos_o)",
        "fresnel(cos_d, 1.5, 0) * pow(1 - cos_d, 5.0) + clamp(tan2_h, 0, 1) * atan2(in_x, in_y)"}) {
    texts.emplace_back(text);
  }
  for (std::size_t k = 0; k < texts.size(); ++k) {
    std::ofstream(directory / std::to_string(k), std::ios::binary) << texts[k];
  }
}

void write_all(const std::filesystem::path& directory, const std::vector<std::string>& texts) {
  std::filesystem::create_directories(directory);
  for (std::size_t k = 0; k < texts.size(); ++k) {
    std::ofstream(directory / std::to_string(k), std::ios::binary) << texts[k];
  }
}

void write_studies(const std::filesystem::path& directory) {
  write_all(directory, {R"([study]
name = "s"
lightings = ["point", "patch:0.5"]
tolerance = 1e-3
[[family]]
name = "P"
model = "phong"
n = {linspace = [2, 9], count = 3}
)",
                        R"([study]
channels = ["red", "green"]
channel_weights = [1, 2]
comparison_metrics = ["ngan-l2"]
clusters = 2
[[material]]
name = "a"
family = "F"
terms = [{model = "lambert", weight = [0.5, 0.2]}, {model = "ward", m = 0.2, factors = ["cos_max"]}]
[[material]]
name = "b"
model = "custom"
formula = "n / pi"
n = 0.5
)",
                        R"([[family]]
name = "W"
model = "ward"
m = {geomspace = [0.1, 0.9], count = 4}
[[chart]]
name = "c"
title = "t"
quantity = "albedo"
curves = [{material = "W"}]
)",
                        R"([[measured]]
file = "a.binary"
[[published]]
name = "t"
[study.domain]
theta_max_deg = 80
)"});
}

void write_material_files(const std::filesystem::path& directory) {
  write_all(directory,
            {"model = \"ward\"\nm = 0.2\nscale = 0.5\n",
             "name = \"x\"\nterms = [{model = \"lambert\", weight = 0.3}, {model = \"phong\", n = [2, 3, 4]}]\n",
             "model = \"custom\"\nformula = '''\nrho / pi * cos_i\n'''\nrho = 0.5\n",
             "model = \"profile\"\npoints = [[0, 1], [0.5, 0.2], [2, 0]]\n"});
}

void write_scenes(const std::filesystem::path& directory) {
  write_all(
      directory,
      {"[camera]\nposition = [0, -6, 2]\nsize = [12, 8]\n[materials]\na = \"lambert\"\nb = \"phong:n=5\"\n[sky]\n"
       "radiance = 0.5\n[[light]]\nposition = [-3, -4, 6]\nintensity = [1, 2, 3]\n[[sphere]]\nmaterial = \"a\"\n"
       "[comparison]\nmaterial = \"a\"\nwith = [\"lambert\"]\n",
       "[scene]\nbounces = 2\n[materials]\na = \"lambert\"\n[[box]]\nmaterial = \"a\"\nturn = 20\n[[cylinder]]\n"
       "material = \"a\"\n[[plane]]\nmaterial = \"a\"\nsize = [1, 2]\n[[mesh]]\nmaterial = \"a\"\nfile = \"x.obj\"\n"});
}

void write_meshes(const std::filesystem::path& directory) {
  write_all(directory, {"# four\no pyramid\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1e0\nf 1 2 3 4\nf -1 1 2\n",
                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 2//1 3//1\n"});
}

void write_specifications(const std::filesystem::path& directory) {
  write_all(directory,
            {"phong:n=20", "lambert:scale=0.5+ward:m=0.2,factor=lacquer", "ward_anisotropic:m_x=0.1,m_y=0.3@mirror",
             "metal_phong:n=5@pumped:controlled*2", "cook_torrance:m=0.3"});
}

void write_judgements(const std::filesystem::path& directory) {
  write_all(directory, {"first,second,distance\na,b,0.5\nb,c,1.5\n", "a,b,c,d,chosen\n1,2,3,4,1\n", "a b 3\n# x\n"});
}

void write_pairs(const std::filesystem::path& directory) {
  write_all(directory, {"theta_in,theta_out,delta_phi\n10,20,30\n0,0,0\n", "30 40 180\n10 0 5\n",
                        "x_in,y_in,z_in,x_out,y_out,z_out\n0,0,1,0.5,0,0.5\n",
                        "theta_in_rad,phi_in,theta_out,phi_out\n1,2,3,4\n"});
}

void write_lut_axes(const std::filesystem::path& directory) {
  write_all(directory, {"alpha:count=3,map=sqrt,entries=nodes", "cos_theta", "theta:from=90,to=0,map=square",
                        "f0:from=0.1,to=1,map=log", "ggx.alpha:count=2"});
}

/// A table of 2 x 3 entries in a format.
std::string lut_text(LutFormat format, bool is_curve, const LutFileOptions& given = {}) {
  Lut lut{.request = {.reflectance = make_material("lambert")}, .columns = {"albedo"}, .values = {}, .errors = {}};
  lut.request.axes = {{.name = "alpha", .count = 2}, {.name = "theta", .count = 3}};
  if (is_curve) lut.request.axes = {{.name = "theta", .count = 6, .entries = AxisEntries::nodes}};
  lut.values = {0, 0.1, 0.2, 0.3, 0.4, 0.5};
  LutFileOptions options = given;
  options.format = format;
  return lut_file(as_stored(lut, options), std::nullopt, options);
}

void write_lut_images(const std::filesystem::path& directory) {
  write_all(directory, {lut_text(LutFormat::png, false)});
}

void write_lut_exrs(const std::filesystem::path& directory) {
  write_all(directory, {lut_text(LutFormat::exr, false), lut_text(LutFormat::exr, false, {.bits = 16})});
}

void write_lut_textures(const std::filesystem::path& directory) {
  write_all(directory, {lut_text(LutFormat::ktx2, false), lut_text(LutFormat::ktx2, false, {.is_float = true}),
                        lut_text(LutFormat::ktx2, true, {.bits = 8})});
}

void write_lut_arrays(const std::filesystem::path& directory) {
  write_all(directory, {lut_text(LutFormat::c, false), lut_text(LutFormat::glsl, false),
                        lut_text(LutFormat::spi1d, true), lut_text(LutFormat::csv, false)});
}

/// Lists of changes to a file.
void write_changes(const std::filesystem::path& directory) {
  write_all(directory,
            {std::string("\1\3\5\0\2\7\4\2\1\1\1", 11), std::string("\0\10\3\0\1\13", 6), "abcdefghijklmnop"});
}

void write_checkpoints(const std::filesystem::path& directory) {
  write_all(directory, test::checkpoint_seeds());
}

void write_shards(const std::filesystem::path& directory) {
  write_all(directory, test::shard_seeds());
}

/// What is fuzzed beside the formats.
struct Other {
  const char* name;
  void (*write)(const std::filesystem::path& directory);
};
constexpr std::array kOthers{Other{"npy", write_arrays},
                             Other{"formula", write_formulas},
                             Other{"study", write_studies},
                             Other{"material-file", write_material_files},
                             Other{"scene", write_scenes},
                             Other{"mesh", write_meshes},
                             Other{"specification", write_specifications},
                             Other{"judgements", write_judgements},
                             Other{"pairs", write_pairs},
                             Other{"lut-axis", write_lut_axes},
                             Other{"lut-image", write_lut_images},
                             Other{"lut-array", write_lut_arrays},
                             Other{"lut-exr", write_lut_exrs},
                             Other{"lut-ktx2", write_lut_textures},
                             Other{"table", write_changes},
                             Other{"results", write_changes},
                             Other{"modes", write_changes},
                             Other{"checkpoint", write_checkpoints},
                             Other{"shard", write_shards}};

}  // namespace

int main(int count, char** arguments) {
  for (const Format* format : formats()) {
    const std::string name(format->name);
    if (count < 3)
      std::puts(name.c_str());
    else if (name == arguments[1])
      write_seeds(*format, arguments[2]);
  }
  for (const Other& other : kOthers) {
    if (count < 3)
      std::puts(other.name);
    else if (std::string(arguments[1]) == other.name)
      other.write(arguments[2]);
  }
}
