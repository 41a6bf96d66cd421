// Holds what the library says of measured files against independent readers and integrals, a line per number.
// usage: lobe_error_table [--every N] [--angles DEGREES,...] [--no-means] [--claim] FILE...
//   --every N    every N-th of the files
//   --angles     of incidence, default 0,5,15,30,45,60,75,85
//   --no-means   no mean albedos
//   --norms      also norms and the product of each file with the next, over directions up to 80 degrees
//   --claim      exit status 1 where stated errors do not hold: more than 1 % off by more than they state, one by more
//                than twice, or half of them stated more than 20 times too large
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/energy.hpp"
#include "lobe/function_metric.hpp"
#include "lobe/measured.hpp"
#include "reference/measured_files.hpp"

namespace {

using lobe::BrdfFunction;
using lobe::Estimate;
using lobe::reference::MeasuredFile;
using lobe::reference::RgbIntegral;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTolerance = 5e-6;      // of the reference's albedos
constexpr double kSigmas = 3;            // of the reference's means, which are sampled
constexpr double kNarrow = 0.02;         // half-vector width that the sampling follows, radians
constexpr std::size_t kPoints = 100000;  // of one shift
constexpr std::size_t kShifts = 8;

struct Options {
  std::size_t every = 1;
  std::vector<double> angles{0, 5, 15, 30, 45, 60, 75, 85};
  bool with_means = true;
  bool with_norms = false;
  bool is_claim = false;
  std::vector<std::filesystem::path> files;
};

std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  while (!text.empty()) {
    double number = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (code != std::errc()) break;
    numbers.push_back(number);
    text.remove_prefix(std::min(text.size(), static_cast<std::size_t>(end - text.data()) + 1));
  }
  return numbers;
}

Options options_of(int count, char** words) {
  Options options;
  for (int k = 1; k < count; ++k) {
    const std::string_view word = words[k];
    if (word == "--every" && k + 1 < count) {
      options.every = static_cast<std::size_t>(numbers_in(words[++k]).at(0));
    } else if (word == "--angles" && k + 1 < count) {
      options.angles = numbers_in(words[++k]);
    } else if (word == "--no-means") {
      options.with_means = false;
    } else if (word == "--norms") {
      options.with_norms = true;
    } else if (word == "--claim") {
      options.is_claim = true;
    } else {
      options.files.emplace_back(word);
    }
  }
  return options;
}

/// What is known of one kind of number.
struct Kind {
  std::size_t count = 0;
  std::size_t above = 0;          // off by more than stated and more than the reference is unsure of
  double worst = 0;               // the largest share of the stated error
  std::vector<double> tightness;  // stated over true error, where the reference knows the latter
};

class Table {
 public:
  void add(const std::string& file, const std::string& kind, const std::string& number, const Estimate& ours,
           double value, double unsure) {
    const double off = std::abs(ours.value - value);
    const double share = std::max(off - unsure, 0.0) / std::max(ours.error, 1e-300);
    Kind& all = kinds_[kind];
    ++all.count;
    if (share > 1) ++all.above;
    all.worst = std::max(all.worst, share);
    if (off > 3 * unsure) all.tightness.push_back(ours.error / off);
    // What the reference cannot tell is at least this tight.
    if (off <= 3 * unsure && ours.error > unsure) all.tightness.push_back(ours.error / (3 * unsure));
    fmt::print("{:32} {:24} {:.8f} ± {:.1e}   {:.8f} ± {:.1e}   {:.3f}{}\n", file, number, ours.value, ours.error,
               value, unsure, share, share > 1 ? "  <--" : "");
  }

  /// \return whether all hold
  bool summarise() {
    bool holds = true;
    fmt::print("\n{:24} {:>7} {:>7} {:>10} {:>22}\n", "", "numbers", "above", "worst", "stated/true (median)");
    for (auto& [name, kind] : kinds_) {
      double median = 0;
      if (!kind.tightness.empty()) {
        const auto middle = kind.tightness.begin() + static_cast<std::ptrdiff_t>(kind.tightness.size() / 2);
        std::nth_element(kind.tightness.begin(), middle, kind.tightness.end());
        median = *middle;
      }
      fmt::print("{:24} {:7} {:7} {:10.2f} {:22.1f}\n", name, kind.count, kind.above, kind.worst, median);
      holds &= 100 * kind.above <= kind.count && kind.worst <= 2 && median <= 20;
    }
    return holds;
  }

 private:
  std::map<std::string, Kind> kinds_;
};

MeasuredFile reference_of(const std::filesystem::path& path) {
  return path.extension() == ".h5" ? lobe::reference::read_nbrdf(path) : lobe::reference::read_rgl(path);
}

void add_albedos(Table& table, const BrdfFunction& function, const MeasuredFile& file, const Options& options) {
  std::vector<double> angles;
  for (const double angle : options.angles) angles.push_back(angle * kDegree);
  const auto ours = lobe::albedo(function, angles);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const RgbIntegral expected = lobe::reference::albedo(file, angles[k], kTolerance);
    for (std::size_t c = 0; c < 3; ++c) {
      table.add(file.name, "albedo", fmt::format("albedo {} {}", options.angles[k], function.channels[c]), ours[c][k],
                expected.value[c], expected.error[c]);
    }
  }
}

void add_means(Table& table, const BrdfFunction& function, const MeasuredFile& file) {
  const auto ours = lobe::mean_albedo(function);
  const auto expected = lobe::reference::pair_means(file, std::numbers::pi / 2, kNarrow, kPoints, kShifts, 1).albedo;
  for (std::size_t c = 0; c < 3; ++c) {
    table.add(file.name, "mean albedo", fmt::format("mean albedo {}", function.channels[c]), ours[c], expected.value[c],
              kSigmas * expected.error[c]);
  }
}

constexpr double kDomain = 80 * kDegree;

/// Norms squared and the product, by channel, with what the reference is unsure of: f.g from |f + g|^2 and both
/// squares.
void add_norms(Table& table, const std::vector<BrdfFunction>& functions, const std::vector<MeasuredFile>& files) {
  const auto ours = lobe::measure(functions, lobe::Lighting::point(), {.theta_max = kDomain});
  const auto square_of = [](const MeasuredFile& file) {
    return lobe::reference::pair_means(file, kDomain, kNarrow, kPoints, kShifts, 1).square;
  };
  const RgbIntegral first = square_of(files[0]);
  for (std::size_t c = 0; c < 3; ++c) {
    const lobe::Metric& metric = ours.channels[c];
    table.add(files[0].name, "squared norm", fmt::format("squared norm {}", functions[0].channels[c]),
              {metric.gram(0, 0), metric.gram_error(0, 0)}, first.value[c], kSigmas * first.error[c]);
  }
  if (files.size() < 2) return;
  const RgbIntegral second = square_of(files[1]);
  MeasuredFile sum = files[0];
  sum.is_even = files[0].is_even && files[1].is_even;
  sum.f = [&](double theta_in, double theta_out, double delta_phi) {
    auto f = files[0].f(theta_in, theta_out, delta_phi);
    const auto g = files[1].f(theta_in, theta_out, delta_phi);
    for (std::size_t c = 0; c < 3; ++c) f[c] += g[c];
    return f;
  };
  const RgbIntegral both = square_of(sum);
  for (std::size_t c = 0; c < 3; ++c) {
    const lobe::Metric& metric = ours.channels[c];
    table.add(files[0].name, "product", fmt::format("product {} {}", files[1].name, functions[0].channels[c]),
              {metric.gram(0, 1), metric.gram_error(0, 1)}, (both.value[c] - first.value[c] - second.value[c]) / 2,
              kSigmas * (both.error[c] + first.error[c] + second.error[c]) / 2);
  }
}

}  // namespace

int main(int count, char** words) {
  const Options options = options_of(count, words);
  Table table;
  for (std::size_t k = 0; k < options.files.size(); k += options.every) {
    const MeasuredFile file = reference_of(options.files[k]);
    const BrdfFunction function = lobe::load_measured(options.files[k]);
    if (!options.angles.empty()) add_albedos(table, function, file, options);
    if (options.with_means) add_means(table, function, file);
    if (!options.with_norms) continue;
    std::vector<BrdfFunction> functions{function};
    std::vector<MeasuredFile> files{file};
    if (k + options.every < options.files.size()) {
      functions.push_back(lobe::load_measured(options.files[k + options.every]));
      files.push_back(reference_of(options.files[k + options.every]));
    }
    add_norms(table, functions, files);
  }
  return table.summarise() || !options.is_claim ? 0 : 1;
}
