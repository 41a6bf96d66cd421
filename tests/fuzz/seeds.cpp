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

#include "io/npy.hpp"
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

/// What is fuzzed beside the formats.
struct Other {
  const char* name;
  void (*write)(const std::filesystem::path& directory);
};
constexpr std::array kOthers{Other{"npy", write_arrays}, Other{"formula", write_formulas}};

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
