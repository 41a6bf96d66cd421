// What runs in threads and needs no device, for the thread sanitizer: tables of functions, their albedos, files written
// and read, samples interpolated, lists of directions answered, ranks.
#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/output_lock.hpp"
#include "core/parallel.hpp"
#include "core/unfinished.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/compare/rank_correlation.hpp"
#include "lobe/core/files.hpp"
#include "lobe/formats/direction_pairs.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/table/brdf_function.hpp"
#include "table/as_function.hpp"
#include "table/tabulate.hpp"

namespace {

using namespace lobe;
namespace fs = std::filesystem;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "lobe_threads: %s\n", what);
  std::exit(1);
}

void share_work() {
  std::vector<int> calls(1000);
  parallel_for(calls.size(), [&](std::size_t i) { parallel_for(2, [&](std::size_t) { ++calls[i]; }); });
  for (const int count : calls) require(count == 2, "work is done once");
  bool is_thrown = false;
  try {
    parallel_for(100, [](std::size_t i) {
      if (i % 7 == 3) throw std::runtime_error("planned");
    });
  } catch (const std::runtime_error&) {
    is_thrown = true;
  }
  require(is_thrown, "what is thrown arrives");
}

/// While some make files, another one asks for all that is unfinished to go, as the end of an interrupted command does.
void leave_unfinished(const fs::path& directory) {
  std::atomic<bool> ends = false;
  std::thread interrupter([&] {
    while (!ends) remove_unfinished();
  });
  parallel_for(64, [&](std::size_t i) {
    const fs::path path = directory / ("unfinished-" + std::to_string(i));
    Unfinished file(path);
    std::ofstream(path) << i;
    const OutputLock lock(directory / ("locked-" + std::to_string(i % 4)), "work");
    if (i % 2 == 0) file.finish();
  });
  ends = true;
  interrupter.join();
}

BrdfFunction glossy() {
  BrdfFunction brdf;
  brdf.name = "glossy";
  brdf.channels = {"red", "green"};
  brdf.is_bilateral = true;
  brdf.at = [](std::span<const Directions> pairs) {
    Eigen::MatrixXd values(static_cast<Eigen::Index>(pairs.size()), 2);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& at = pairs[i];
      const double mirrored = std::cos(at.theta_in) * std::cos(at.theta_out) -
                              std::sin(at.theta_in) * std::sin(at.theta_out) * std::cos(at.delta_phi);
      values.row(static_cast<Eigen::Index>(i)) << 0.2 / std::numbers::pi, std::pow(std::max(mirrored, 0.0), 3.0);
    }
    return BrdfValues{values, {}};
  };
  return brdf;
}

void make_tables(const fs::path& directory) {
  const BrdfTable table = tabulate(glossy(), HemisphereGrid::gauss(8, 16));
  save(table, directory / "t.h5");
  const BrdfTable again = load_table(directory / "t.h5");
  require(row_albedos(again).mean.size() == 2, "albedos of both channels");
  const BrdfTable other = resample(again, HemisphereGrid::gauss(6, 12));
  require(other.channels == 2, "both channels on another grid");
  std::ofstream(directory / "pairs.csv") << [] {
    std::string text = "theta_in,theta_out,delta_phi\n";
    for (int i = 0; i < 5000; ++i) text += std::to_string(i % 80) + "," + std::to_string(i % 71) + ",30\n";
    return text;
  }();
  std::string answers;
  (void)evaluate_pairs(Device::on_demand(), as_function(table), directory / "pairs.csv", answers);
  require(answers.size() > 5000, "answers to all pairs");
}

void interpolate_samples(const fs::path& directory) {
  std::string text = "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,red\n";
  for (int i = 0; i < 400; ++i) {
    const double theta_in = 5 + (i * 37) % 70;
    const double theta_out = 3 + (i * 53) % 75;
    const double phi = (i * 101) % 180;
    text += std::to_string(theta_in) + ",0," + std::to_string(theta_out) + "," + std::to_string(phi) + "," +
            std::to_string(0.3 + 0.1 * std::cos(phi)) + "\n";
  }
  std::ofstream(directory / "scattered.csv") << text;
  const BrdfFunction brdf = load_measured(directory / "scattered.csv");
  std::vector<Directions> pairs;
  for (int i = 0; i < 500; ++i) pairs.push_back({0.002 * i, 1 - 0.001 * i, 0.005 * i, 0});
  require(brdf.at(pairs).value.allFinite(), "values between samples");
}

void rank_metrics() {
  std::vector<Eigen::MatrixXd> distances;
  for (int metric = 0; metric < 6; ++metric) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(20, 20);
    for (int i = 0; i < 20; ++i) {
      for (int j = 0; j < i; ++j)
        matrix(i, j) = matrix(j, i) = std::abs(std::sin(i * 3.1 + metric) - std::sin(j * 3.1));
    }
    distances.push_back(matrix);
  }
  require(rank_agreement(distances).spearman.rows() == 6, "a correlation for each two metrics");
}

}  // namespace

int main() {
  const fs::path directory = fs::temp_directory_path() / ("lobe-threads-" + std::to_string(::getpid()));
  fs::create_directories(directory);
  share_work();
  leave_unfinished(directory);
  make_tables(directory);
  interpolate_samples(directory);
  rank_metrics();
  fs::remove_all(directory);
  std::puts("done");
  return 0;
}
