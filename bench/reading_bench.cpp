// Loading binary files of measurements, against a plain fread of the same files in the same run.
// Usage: bench_reading [--smoke]
// MERL and UTIA files are written for it; those of RGL and of the neural encodings are read where LOBE_DATA_DIR has
// them.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobe/formats/measured.hpp"
#include "measure.hpp"

namespace {

namespace fs = std::filesystem;

/// A reflectance without a file: lobes about the mirror direction.
lobe::BrdfFunction some_lobes() {
  lobe::BrdfFunction brdf;
  brdf.name = "lobes";
  brdf.channels = {"red", "green", "blue"};
  brdf.at = [](std::span<const lobe::Directions> pairs) {
    lobe::BrdfValues values{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), 3), {}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& [in, out, delta_phi, phi] = pairs[i];
      const double cosine = std::cos(in) * std::cos(out) - std::sin(in) * std::sin(out) * std::cos(delta_phi);
      for (int c = 0; c < 3; ++c) {
        values.value(static_cast<Eigen::Index>(i), c) = 0.1 + std::pow(std::max(cosine, 0.0), 10 * (c + 1));
      }
    }
    return values;
  };
  return brdf;
}

struct File {
  std::string format;
  fs::path path;
};

/// A folder of its own that goes with the program.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / fmt::format("lobe-reading-{}", ::getpid())) {
    fs::create_directory(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] File written(const std::string& format) const {
    lobe::save_measured(lobe::Device::on_demand(), some_lobes(), format, path_ / format);
    return {format, path_ / format};
  }

 private:
  fs::path path_;
};

std::vector<File> shared_files() {
  std::vector<File> files;
  const char* data = std::getenv("LOBE_DATA_DIR");
  if (data == nullptr) return files;
  for (const auto& [format, name] :
       {std::pair("rgl", "rgl_bsdf/cc_green_malachite_rgb.bsdf"), std::pair("nbrdf", "nbrdf/merl/pink-felt.h5")}) {
    if (fs::exists(fs::path(data) / name)) files.push_back({format, fs::path(data) / name});
  }
  return files;
}

void read_plainly(const fs::path& path) {
  const std::size_t size = fs::file_size(path);
  const std::unique_ptr<char[]> content(new char[size]);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file || std::fread(content.get(), 1, size, file.get()) != size) {
    throw std::runtime_error("cannot read " + path.string());
  }
}

void run(bool is_smoke) {
  bench::print_setting("files in the page cache", "fread");
  const Folder folder;
  std::vector<File> files{folder.written("merl"), folder.written("utia")};
  std::ranges::copy(shared_files(), std::back_inserter(files));
  bench::Table table("MB/s");
  for (const auto& [format, path] : files) {
    table.add(format, static_cast<double>(fs::file_size(path)) / 1e6,
              bench::measure_together({{"load", [&at = path] { (void)lobe::load_measured(at); }},
                                       {"fread", [&at = path] { read_plainly(at); }}},
                                      is_smoke ? 1 : 21));
  }
  table.print();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 && std::string_view(argv[1]) == "--smoke");
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_reading: {}\n", error.what());
    return 1;
  }
}
