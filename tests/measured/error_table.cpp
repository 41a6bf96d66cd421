// Holds what the library says of measured files against independent readers and integrals, a line per number.
// usage: lobe_error_table [--every N] [--angles DEGREES,...] [--no-means] [--claim] FILE...
//   --every N    every N-th of the files
//   --angles     of incidence, default 0,5,15,30,45,60,75,85
//   --no-means   no mean albedos
//   --norms      also norms and the product of each file with the next, over directions up to 80 degrees
//   --cells      also, of luminances, averages over pairs of cells and the mean albedo of the table on klems:145, and
//                the mean albedo of that on gauss:64x128
//   --composed   also, of luminances, self-compositions: mean albedo and norm of the file's and of its table's on
//                gauss:64x128, and values at ten pairs of directions
//   --grid GRID  that of the self-compositions instead
//   --pairs N    of directions instead of ten
//   --claim      exit status 1 where stated errors do not hold: more than 1 % off by more than they state, one by more
//                than twice, or half of ten and more stated more than 20 times too large
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/composition.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/table.hpp"
#include "reference/cell_averages.hpp"
#include "reference/measured_files.hpp"

namespace {

using lobe::BrdfFunction;
using lobe::Estimate;
using lobe::reference::MeasuredFile;
using lobe::reference::RgbIntegral;

constexpr double kTolerance = 5e-6;      // of the reference's albedos
constexpr std::size_t kFew = 10;         // numbers, whose median tells little
constexpr double kSigmas = 3;            // of the reference's means, which are sampled
constexpr double kNarrow = 0.02;         // half-vector width that the sampling follows, radians
constexpr std::size_t kPoints = 100000;  // of one shift
constexpr std::size_t kShifts = 8;

struct Options {
  std::size_t every = 1;
  std::vector<double> angles{0, 5, 15, 30, 45, 60, 75, 85};
  bool with_means = true;
  bool with_norms = false;
  bool with_cells = false;
  bool with_compositions = false;
  std::string grid = "gauss:64x128";  // of compositions
  std::size_t pairs = 10;
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
    } else if (word == "--cells") {
      options.with_cells = true;
    } else if (word == "--composed") {
      options.with_compositions = true;
    } else if (word == "--grid" && k + 1 < count) {
      options.grid = words[++k];
    } else if (word == "--pairs" && k + 1 < count) {
      options.pairs = static_cast<std::size_t>(numbers_in(words[++k]).at(0));
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
  std::size_t above = 0;  // off by more than stated and more than the reference is unsure of
  std::size_t above_twice = 0;
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
    if (share > 2) ++all.above_twice;
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
    fmt::print("\n{:24} {:>7} {:>7} {:>8} {:>10} {:>22}\n", "", "numbers", "above", "above 2x", "worst",
               "stated/true (median)");
    for (auto& [name, kind] : kinds_) {
      double median = 0;
      if (!kind.tightness.empty()) {
        const auto middle = kind.tightness.begin() + static_cast<std::ptrdiff_t>(kind.tightness.size() / 2);
        std::nth_element(kind.tightness.begin(), middle, kind.tightness.end());
        median = *middle;
      }
      fmt::print("{:24} {:7} {:7} {:8} {:10.2f} {:22.1f}\n", name, kind.count, kind.above, kind.above_twice, kind.worst,
                 median);
      holds &= 100 * kind.above <= kind.count && kind.worst <= 2 && (kind.count < kFew || median <= 20);
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
  for (const double angle : options.angles) angles.push_back(angle * lobe::kDegree);
  const auto ours = lobe::albedo(lobe::Device::on_demand(), function, angles);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const RgbIntegral expected = lobe::reference::albedo(file, angles[k], kTolerance);
    for (std::size_t c = 0; c < 3; ++c) {
      table.add(file.name, "albedo", fmt::format("albedo {} {}", options.angles[k], function.channels[c]), ours[c][k],
                expected.value[c], expected.error[c]);
    }
  }
}

void add_means(Table& table, const BrdfFunction& function, const MeasuredFile& file) {
  const auto ours = lobe::mean_albedo(lobe::Device::on_demand(), function);
  const auto expected = lobe::reference::pair_means(file, std::numbers::pi / 2, kNarrow, kPoints, kShifts, 1).albedo;
  for (std::size_t c = 0; c < 3; ++c) {
    table.add(file.name, "mean albedo", fmt::format("mean albedo {}", function.channels[c]), ours[c], expected.value[c],
              kSigmas * expected.error[c]);
  }
}

constexpr double kDomain = 80 * lobe::kDegree;

/// Norms squared and the product, by channel, with what the reference is unsure of: f.g from |f + g|^2 and both
/// squares.
void add_norms(Table& table, const std::vector<BrdfFunction>& functions, const std::vector<MeasuredFile>& files) {
  const auto ours = lobe::measure(lobe::Device::choose(), functions, lobe::Lighting::point(),
                                  {.theta_max = kDomain, .route = lobe::Route::functions});
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

constexpr double kMeanTolerance = 5e-5;  // of the reference, relative to 1
constexpr std::size_t kCellPairs = 6;

lobe::ReadOptions luminance() {
  lobe::ReadOptions options;
  options.luminance = "rec709";
  return options;
}

Estimate mean_of(const lobe::BrdfTable& table) {
  return lobe::row_albedos(table).mean.front();
}

lobe::reference::PolarCell cell_of(const lobe::HemisphereGrid& grid, std::size_t node) {
  const lobe::Ring& ring = grid.rings()[grid.ring_of(node)];
  const double step = 2 * std::numbers::pi / static_cast<double>(ring.count);
  const double phi = grid.directions()[node].phi;
  return {ring.theta_low, ring.theta_high, phi - step / 2, phi + step / 2};
}

/// By rules of two orders.
Estimate reference_average(const MeasuredFile& file, const lobe::HemisphereGrid& grid, std::size_t in,
                           std::size_t out) {
  constexpr int kOrder = 10;
  using lobe::reference::Vector;
  const auto f = [&](const Vector& light, const Vector& view) {
    const auto theta = [](const Vector& v) {
      return std::atan2(std::hypot(static_cast<double>(v.x), static_cast<double>(v.y)), static_cast<double>(v.z));
    };
    const auto phi = [](const Vector& v) { return std::atan2(static_cast<double>(v.y), static_cast<double>(v.x)); };
    return lobe::reference::Real{file.f(theta(light), theta(view), phi(view) - phi(light))[0]};
  };
  const auto average = [&](int order) {
    return lobe::reference::cell_average(f, cell_of(grid, in), cell_of(grid, out), order);
  };
  const double value = average(2 * kOrder);
  return {value, std::abs(value - average(kOrder))};
}

void add_cells(Table& table, const BrdfFunction& function, const MeasuredFile& file) {
  const auto mean = lobe::reference::pair_means(file, std::numbers::pi / 2, kNarrow, kPoints, kShifts, 1).albedo;
  for (const char* name : {"klems:145", "gauss:64x128"}) {
    const auto of_grid = lobe::tabulate(lobe::Device::on_demand(), function, lobe::HemisphereGrid::parse(name),
                                        {.allow_unresolved = true});
    table.add(file.name, "table's mean albedo", fmt::format("mean albedo on {}", name), mean_of(of_grid), mean.value[0],
              kSigmas * mean.error[0]);
    if (!of_grid.grid.has_cells()) continue;
    std::mt19937 random(17);
    for (std::size_t k = 0; k < kCellPairs; ++k) {
      const std::size_t in = random() % of_grid.grid.nodes();
      const std::size_t out = k % 2 == 0 ? of_grid.grid.opposite(in) : random() % of_grid.grid.nodes();
      const Estimate expected = reference_average(file, of_grid.grid, in, out);
      const std::size_t rings = of_grid.grid.rings().size();
      const Estimate ours{of_grid.values[in * of_grid.grid.nodes() + out],
                          of_grid.error[of_grid.grid.ring_of(in) * rings + of_grid.grid.ring_of(out)]};
      table.add(file.name, "cell average", fmt::format("cells {} {}", in, out), ours, expected.value, expected.error);
    }
  }
}

void add_compositions(Table& table, const lobe::Device& device, const BrdfFunction& function, const MeasuredFile& file,
                      const Options& options) {
  constexpr double kLargest = 85 * lobe::kDegree;
  const auto grid = lobe::HemisphereGrid::parse(options.grid);
  const std::size_t nodes = grid.n_theta() * 3 / 2;  // of the reference's norm
  const auto of_file = lobe::compose(device, function, function, grid);
  const auto of_table = lobe::self_compose(device, lobe::tabulate(device, function, grid, {.allow_unresolved = true}));
  const RgbIntegral mean = lobe::reference::self_composition_mean(file, kMeanTolerance);
  const RgbIntegral square = lobe::reference::self_composition_square(file, nodes);
  for (const auto* composed : {&of_file, &of_table}) {
    const std::string whose = composed == &of_file ? "of file" : "of table";
    table.add(file.name, "composed mean " + whose, "mean albedo of C " + whose, mean_of(*composed), mean.value[0],
              mean.error[0]);
    const auto norm = lobe::scalar_product(device, *composed, *composed, lobe::Lighting::point());
    table.add(file.name, "composed norm " + whose, "squared norm of C " + whose, norm, square.value[0],
              square.error[0]);
  }
  std::mt19937 random(20);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<lobe::Directions> pairs;
  for (std::size_t k = 0; k < options.pairs; ++k) {
    const double theta_in = kLargest * uniform(random);
    const bool is_peak = k % 2 == 0;  // about the retro direction, where that of two highlights is
    const double theta_out = is_peak ? theta_in : kLargest * uniform(random);
    pairs.push_back({theta_in, theta_out, (is_peak ? 0.1 : 2 * std::numbers::pi) * uniform(random)});
  }
  const auto values = lobe::composition_at(device, function, function, pairs, {.tolerance = 1e-4}).front();
  for (std::size_t k = 0; k < options.pairs; ++k) {
    const auto [in, out, phi, unused] = pairs[k];
    const RgbIntegral expected = lobe::reference::self_composition(file, in, out, phi, 1e-4 * values[k].value);
    const std::string where =
        fmt::format("{:.1f} {:.1f} {:.1f}", in / lobe::kDegree, out / lobe::kDegree, phi / lobe::kDegree);
    table.add(file.name, "composed value", "C at " + where, values[k], expected.value[0], expected.error[0]);
  }
}

}  // namespace

int main(int count, char** words) {
  const Options options = options_of(count, words);
  Table table;
  const auto device = options.with_compositions ? std::optional(lobe::Device::choose()) : std::nullopt;
  for (std::size_t k = 0; k < options.files.size(); k += options.every) {
    const MeasuredFile file = reference_of(options.files[k]);
    const BrdfFunction function = lobe::load_measured(options.files[k]);
    if (!options.angles.empty()) add_albedos(table, function, file, options);
    if (options.with_means) add_means(table, function, file);
    if (options.with_cells || options.with_compositions) {
      const BrdfFunction bright = lobe::load_measured(options.files[k], luminance());
      const MeasuredFile expected = lobe::reference::luminance_of(file);
      if (options.with_cells) add_cells(table, bright, expected);
      if (device) add_compositions(table, *device, bright, expected, options);
    }
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
