// Holds what the library says of measured files against independent readers and integrals, a line per number.
// Readers: neural encodings, RGL tensor files, Fourier tables, Zernike polynomials, ALTA slices; Klems matrices and
// tensor trees of three dimensions, whose numbers are sums over cells. Files of samples at scattered directions are
// interpolated by the library: their samples are read independently, and integrals are those of its interpolation,
// without the errors of that.
// usage: lobe_error_table [--every N] [--from K] [--angles DEGREES,...] [--no-means] [--claim] FILE...
//   --every N    every N-th of the files
//   --from K     from the K-th on, counted from 0
//   --angles     of incidence, default 0,5,15,30,45,60,75,85
//   --no-means   no mean albedos
//   --largest    also the largest albedo that a check of plausibility states, against a scan over angles up to 89.99
//                degrees
//   --norms      also norms and the product of each file with the next, over directions up to 80 degrees
//   --cells      also, of luminances, averages over pairs of cells and the mean albedo of the table on klems:145, and
//                the mean albedo of that on gauss:64x128
//   --composed   also, of luminances, self-compositions: mean albedo and norm of the file's and of its table's on
//                gauss:64x128, and values at ten pairs of directions
//   --grid GRID  that of the self-compositions instead
//   --pairs N    of directions instead of ten
//   --points N   of each of eight samples behind the reference's means and norms, instead of 100000
//   --claim      exit status 1 where stated errors do not hold: more than 1 % off by more than they state, one by more
//                than twice, half of ten and more stated more than 20 times too large, or a file not read
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/energy/plausibility.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/composition.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/table.hpp"
#include "reference/cell_averages.hpp"
#include "reference/file_formats.hpp"
#include "reference/measured_files.hpp"

namespace {

using lobe::BrdfFunction;
using lobe::Estimate;
using lobe::reference::MeasuredFile;
using lobe::reference::RgbIntegral;

constexpr double kShare = 0.1;          // of what is stated, to which the reference finds albedos
constexpr double kFinest = 2e-7;        // at least, absolute
constexpr double kCoarsest = 1e-3;      // at most, absolute
constexpr double kReferenceSafety = 3;  // of what these state: two rules may agree by accident
constexpr std::size_t kFew = 10;        // numbers, whose median tells little
constexpr double kSigmas = 3;           // of the reference's means, which are sampled
constexpr double kNarrow = 0.02;        // half-vector width that the sampling follows, radians
constexpr std::size_t kShifts = 8;

struct Options {
  std::size_t every = 1;
  std::size_t from = 0;
  std::vector<double> angles{0, 5, 15, 30, 45, 60, 75, 85};
  bool with_means = true;
  bool with_largest = false;
  bool with_norms = false;
  bool with_cells = false;
  bool with_compositions = false;
  std::string grid = "gauss:64x128";  // of compositions
  std::size_t pairs = 10;
  std::size_t points = 100000;  // of one shift of the reference's means
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
    } else if (word == "--from" && k + 1 < count) {
      options.from = static_cast<std::size_t>(numbers_in(words[++k]).at(0));
    } else if (word == "--angles" && k + 1 < count) {
      options.angles = numbers_in(words[++k]);
    } else if (word == "--no-means") {
      options.with_means = false;
    } else if (word == "--largest") {
      options.with_largest = true;
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
    } else if (word == "--points" && k + 1 < count) {
      options.points = static_cast<std::size_t>(numbers_in(words[++k]).at(0));
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
  std::size_t unknown = 0;        // errors that are not known, which the library says
  double worst = 0;               // the largest share of the stated error
  std::vector<double> tightness;  // stated over true error, where the reference knows the latter
};

class Table {
 public:
  /// \param is_tight whether what is stated shall not be far too large, either
  void add(const std::string& file, const std::string& kind, const std::string& number, const Estimate& ours,
           double value, double unsure, bool is_tight = true) {
    const double off = std::abs(ours.value - value);
    const double share = std::max(off - unsure, 0.0) / std::max(ours.error, 1e-300);
    Kind& all = kinds_[kind];
    ++all.count;
    if (std::isnan(ours.error)) ++all.unknown;
    if (share > 1) ++all.above;
    if (share > 2) ++all.above_twice;
    all.worst = std::max(all.worst, share);
    // What the reference knows less well than a difference is at least this tight: its bounds are ten times its errors
    // and more, as a rule.
    if (is_tight && ours.error > 0) all.tightness.push_back(ours.error / std::max(off, unsure / 10));
    fmt::print("{:32} {:24} {:.8f} ± {:.1e}   {:.8f} ± {:.1e}   {:.3g}{}\n", file, number, ours.value, ours.error,
               value, unsure, share, share > 1 ? "  <--" : "");
    std::fflush(stdout);  // what is stopped half-way leaves what it found
  }

  /// \return whether all hold
  bool summarise() {
    bool holds = true;
    fmt::print("\n{:24} {:>7} {:>7} {:>7} {:>8} {:>10} {:>22}\n", "", "numbers", "unknown", "above", "above 2x",
               "worst", "stated/true, at least");
    for (auto& [name, kind] : kinds_) {
      std::string median = "-";
      bool is_tight = true;
      if (!kind.tightness.empty()) {
        const auto middle = kind.tightness.begin() + static_cast<std::ptrdiff_t>(kind.tightness.size() / 2);
        std::nth_element(kind.tightness.begin(), middle, kind.tightness.end());
        median = fmt::format("{:.1f}", *middle);
        is_tight = *middle <= 20 || kind.tightness.size() < kFew;
      }
      fmt::print("{:24} {:7} {:7} {:7} {:8} {:10.2f} {:>22}\n", name, kind.count, kind.unknown, kind.above,
                 kind.above_twice, kind.worst, median);
      holds &= 100 * kind.above <= kind.count && kind.worst <= 2 && is_tight;
    }
    return holds;
  }

 private:
  std::map<std::string, Kind> kinds_;
};

/// A file as the library and as the reference read it.
struct Subject {
  std::filesystem::path path;
  lobe::ReadOptions options;
  BrdfFunction function;
  MeasuredFile file;
  bool is_interpolated = false;  // between scattered samples, by the library alone
};

bool contains(const std::filesystem::path& path, std::string_view text) {
  std::ifstream stream(path, std::ios::binary);
  std::string head(1U << 16, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head.find(text) != std::string::npos;
}

bool is_xml(const std::filesystem::path& path) {
  return path.extension() == ".xml" || path.extension() == ".XML";
}

/// The library's interpolation without its errors, of which the reference's integrals know nothing.
BrdfFunction bare(BrdfFunction function) {
  function.at = [at = function.at](std::span<const lobe::Directions> pairs) {
    return lobe::BrdfValues{at(pairs).value, {}};
  };
  return function;
}

MeasuredFile interpolated(const BrdfFunction& function) {
  MeasuredFile file;
  file.name = function.name;
  file.is_even = function.is_bilateral;
  file.channels = function.channels.size();
  file.f = [at = function.at](double theta_in, double theta_out, double delta_phi) {
    const lobe::Directions pair{theta_in, theta_out, delta_phi};
    const auto values = at({&pair, 1}).value;
    lobe::reference::Rgb f{};
    for (Eigen::Index c = 0; c < 3; ++c) f[static_cast<std::size_t>(c)] = values(0, std::min(c, values.cols() - 1));
    return f;
  };
  return file;
}

constexpr double kWavelength = 550;  // nm, of polynomials that depend on it

Subject subject_of(const std::filesystem::path& path) {
  Subject subject{path, {}, {}, {}};
  if (path.extension() == ".h5") {
    subject.file = lobe::reference::read_nbrdf(path);
  } else if (path.extension() == ".gz" || contains(path, "SCATFUN")) {
    subject.file = lobe::reference::read_scatfun(path);
  } else if (contains(path, std::string_view("tensor_file\0", 12))) {
    subject.file = lobe::reference::read_rgl(path);
  } else if (path.extension() == ".csv" && !contains(path, "lambda")) {
    subject.file = lobe::reference::read_zernike(path, kWavelength / 1000);
    if (lobe::reference::depends_on_wavelength(path)) subject.options.wavelengths = {kWavelength};
  } else if (contains(path, "COS_TH")) {
    subject.file = lobe::reference::read_alta_slice(path);
  } else {
    subject.is_interpolated = true;
    subject.options.channels = {"1"};
  }
  subject.function = lobe::load_measured(path, subject.options);
  if (subject.is_interpolated) {
    subject.function = bare(subject.function);
    subject.file = interpolated(subject.function);
  }
  return subject;
}

void add_albedos(Table& table, const BrdfFunction& function, const MeasuredFile& file, const Options& options) {
  std::vector<double> angles;
  for (const double angle : options.angles) angles.push_back(angle * lobe::kDegree);
  const auto ours = lobe::albedo(lobe::Device::on_demand(), function, angles);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    double stated = kCoarsest;
    for (const auto& channel : ours) stated = std::min(stated, channel[k].error);
    const RgbIntegral expected = lobe::reference::albedo(file, angles[k], std::max(kShare * stated, kFinest));
    for (std::size_t c = 0; c < file.channels; ++c) {
      table.add(file.name, "albedo", fmt::format("albedo {} {}", options.angles[k], function.channels[c]), ours[c][k],
                expected.value[c], kReferenceSafety * expected.error[c]);
    }
  }
}

/// Albedos of the reference at angles of incidence, each computed once.
class ReferenceScan {
 public:
  ReferenceScan(const MeasuredFile& file, double tolerance) : file_(file), tolerance_(tolerance) {}

  const RgbIntegral& at(double theta) {
    const auto known = found_.find(theta);
    if (known != found_.end()) return known->second;
    return found_.emplace(theta, lobe::reference::albedo(file_, theta, tolerance_)).first->second;
  }

  /// The largest albedo of a channel: steps of a degree, then between the neighbours of the highest.
  Estimate largest(std::size_t channel) {
    constexpr double kLast = 89.99 * lobe::kDegree;
    constexpr int kSteps = 90;
    constexpr int kRounds = 5;
    std::vector<double> angles;
    for (int k = 0; k <= kSteps; ++k) angles.push_back(kLast * k / kSteps);
    for (int round = 0;; ++round) {
      const auto value = [&](double theta) { return at(theta).value[channel]; };
      const auto top = static_cast<std::size_t>(std::ranges::max_element(angles, {}, value) - angles.begin());
      const double low = angles[top == 0 ? 0 : top - 1];
      const double middle = angles[top];
      const double high = angles[std::min(top + 1, angles.size() - 1)];
      if (round == kRounds) {
        // Between the last angles an albedo that bends down is higher by no more than it falls to the next.
        const double fall = value(middle) - std::min(value(low), value(high));
        return {value(middle), kReferenceSafety * at(middle).error[channel] + fall};
      }
      angles = {low, (low + middle) / 2, middle, (middle + high) / 2, high};
    }
  }

 private:
  const MeasuredFile& file_;
  double tolerance_;
  std::map<double, RgbIntegral> found_;
};

void add_largest(Table& table, const BrdfFunction& function, const MeasuredFile& file) {
  constexpr double kFinestOfScans = 2e-5;  // absolute
  const auto found =
      lobe::check_plausibility(lobe::Device::on_demand(), function, {.with_mean_albedo = false}).channels;
  double stated = kCoarsest;
  for (const auto& channel : found) stated = std::min(stated, channel.albedo.largest.error);
  ReferenceScan scan(file, std::max(kShare * stated, kFinestOfScans));
  for (std::size_t c = 0; c < file.channels; ++c) {
    const Estimate expected = scan.largest(c);
    table.add(file.name, "largest albedo", fmt::format("largest albedo {}", function.channels[c]),
              found[c].albedo.largest, expected.value, expected.error);
  }
}

void add_means(Table& table, const BrdfFunction& function, const MeasuredFile& file, std::size_t points) {
  const auto ours = lobe::mean_albedo(lobe::Device::on_demand(), function);
  const auto expected = lobe::reference::pair_means(file, std::numbers::pi / 2, kNarrow, points, kShifts, 1).albedo;
  for (std::size_t c = 0; c < file.channels; ++c) {
    table.add(file.name, "mean albedo", fmt::format("mean albedo {}", function.channels[c]), ours[c], expected.value[c],
              kSigmas * expected.error[c]);
  }
}

constexpr double kDomain = 80 * lobe::kDegree;

/// Norms squared and the product with another file, by channel.
/// \param points of the reference, of one shift
void add_norms(Table& table, const Subject& subject, const Subject* other, std::size_t points) {
  std::vector<BrdfFunction> functions{subject.function};
  if (other != nullptr) functions.push_back(other->function);
  const auto ours = lobe::measure(lobe::Device::choose(), functions, lobe::Lighting::point(),
                                  {.theta_max = kDomain, .route = lobe::Route::functions});
  const auto metric_of = [&](std::size_t c) -> const lobe::Metric& {
    return ours.channels.empty() ? ours.combined : ours.channels[c];
  };
  const RgbIntegral first = lobe::reference::pair_means(subject.file, kDomain, kNarrow, points, kShifts, 1).square;
  for (std::size_t c = 0; c < subject.file.channels; ++c) {
    const lobe::Metric& metric = metric_of(c);
    table.add(subject.file.name, "squared norm", fmt::format("squared norm {}", subject.function.channels[c]),
              {metric.gram(0, 0), metric.gram_error(0, 0)}, first.value[c], kSigmas * first.error[c]);
  }
  if (other == nullptr) return;
  const RgbIntegral product =
      lobe::reference::pair_means(subject.file, kDomain, kNarrow, points, kShifts, 1, &other->file).square;
  for (std::size_t c = 0; c < subject.file.channels; ++c) {
    const lobe::Metric& metric = metric_of(c);
    table.add(subject.file.name, "product",
              fmt::format("product {} {}", other->file.name, subject.function.channels[c]),
              {metric.gram(0, 1), metric.gram_error(0, 1)}, product.value[c], kSigmas * product.error[c]);
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

void add_cells(Table& table, const BrdfFunction& function, const MeasuredFile& file, std::size_t points) {
  const auto mean = lobe::reference::pair_means(file, std::numbers::pi / 2, kNarrow, points, kShifts, 1).albedo;
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

constexpr std::size_t kSamples = 100;     // of a file, at most, that are looked at
constexpr double kApart = 0.005;          // radians, from samples that count as one with another
constexpr double kSampleRounding = 1e-6;  // of an interpolation at its samples, relative
constexpr double kDark = 1e-3;            // sr^-1, of which the same holds for samples that are 0

/// What the library finds at samples that stand alone. Its interpolation has to pass through them, whatever error it
/// states there.
void add_samples(Table& table, const Subject& subject) {
  const auto samples = lobe::reference::read_samples(subject.path, 0);
  const bool is_isotropic = subject.function.is_isotropic;
  for (const auto& sample : lobe::reference::lonely(samples, is_isotropic, kApart, kSamples)) {
    const double delta_phi = sample.phi_out - sample.phi_in;
    const lobe::Directions pair{sample.theta_in, sample.theta_out, delta_phi, sample.phi_in};
    const auto found = subject.function.at({&pair, 1});
    table.add(subject.file.name, "sample",
              fmt::format("at {:.2f} {:.2f} {:.2f}", sample.theta_in / lobe::kDegree, sample.theta_out / lobe::kDegree,
                          delta_phi / lobe::kDegree),
              {found.value(0, 0), kSampleRounding * (std::abs(sample.value) + kDark)}, sample.value, 0, false);
  }
}

const std::string kOfTables = "cells: table's mean albedo";  // no sum: it has an error that can be too large
constexpr double kSumRounding = 1e-12;                       // of the reference's sums, relative
constexpr double kInside = 1 * lobe::kDegree;                // of angles, which else lie on edges of cells

double rounding(double value) {
  return kSumRounding * std::abs(value);
}

std::vector<double> angles_of(const Options& options) {
  std::vector<double> angles;
  for (const double angle : options.angles) angles.push_back(angle * lobe::kDegree);
  return angles;
}

/// Numbers of an operator that is constant on pairs of cells, all of which are sums.
void add_klems(Table& table, const std::filesystem::path& path, const std::optional<std::filesystem::path>& next,
               const Options& options) {
  const auto file = lobe::reference::read_klems(path);
  const BrdfFunction function = lobe::load_measured(path);
  const auto device = lobe::Device::choose();
  std::vector<double> angles = angles_of(options);
  for (double& angle : angles) angle += kInside;
  const auto albedos = lobe::albedo(device, function, angles);
  const auto means = lobe::mean_albedo(device, function);
  const auto composed = lobe::reference::self_composition(file);
  const auto ours = lobe::self_compose(device, *function.cells);
  const auto of_ours = lobe::row_albedos(ours);
  std::optional<lobe::TableAlbedo> on_gauss;
  if (options.with_cells) {
    const auto grid = lobe::HemisphereGrid::parse("gauss:64x128");
    on_gauss = lobe::row_albedos(lobe::tabulate(device, function, grid, {.allow_unresolved = true}));
  }
  std::vector<BrdfFunction> functions{function};
  std::optional<lobe::reference::CellFile> other;
  if (next) {
    other = lobe::reference::read_klems(*next);
    if (other->channels == file.channels) functions.push_back(lobe::load_measured(*next));
  }
  const auto products = lobe::measure(device, functions, lobe::Lighting::point(), {});
  const auto near = lobe::measure(device, functions, lobe::Lighting::point(), {.theta_max = 75 * lobe::kDegree});
  for (std::size_t c = 0; c < file.channels.size(); ++c) {
    const auto add = [&](const std::string& kind, const std::string& number, const Estimate& estimate, double value) {
      table.add(file.name, kind, number + " " + file.channels[c], estimate, value, rounding(value), kind == kOfTables);
    };
    for (std::size_t k = 0; k < angles.size(); ++k) {
      add("cells: albedo", fmt::format("albedo {}", angles[k] / lobe::kDegree), albedos[c][k],
          lobe::reference::albedo(file, c, file.cell_at(angles[k], 0)));
    }
    const double mean = lobe::reference::mean_albedo(file, c);
    add("cells: mean albedo", "mean albedo", means[c], mean);
    if (on_gauss) add(kOfTables, "mean albedo on gauss:64x128", on_gauss->mean[c], mean);
    const auto add_product = [&](const lobe::MetricResult& result, double theta_max, const std::string& where) {
      const lobe::Metric& metric = result.channels.empty() ? result.combined : result.channels[c];
      add("cells: squared norm", "squared norm" + where, {metric.gram(0, 0), metric.gram_error(0, 0)},
          lobe::reference::product(file, file, c, theta_max));
      if (functions.size() < 2) return;
      add("cells: product", "product " + other->name + where, {metric.gram(0, 1), metric.gram_error(0, 1)},
          lobe::reference::product(file, *other, c, theta_max));
    };
    add_product(products, std::numbers::pi / 2, "");
    add_product(near, 75 * lobe::kDegree, " to 75");
    add("cells: composed mean", "mean albedo of C", of_ours.mean[c], lobe::reference::mean_albedo(composed, c));
    std::mt19937 random(20);
    const std::size_t cells = file.measure.size();
    for (std::size_t k = 0; k < options.pairs; ++k) {
      const std::size_t in = random() % cells;
      const std::size_t out = random() % cells;
      const auto& node_in = ours.grid.directions()[in];
      const auto& node_out = ours.grid.directions()[out];
      const std::size_t rings = ours.grid.rings().size();
      const auto matrix = static_cast<std::size_t>(ours.grid.nodes() * ours.grid.nodes());
      const Estimate estimate{ours.values[c * matrix + in * cells + out],
                              ours.error[c * rings * rings + ours.grid.ring_of(in) * rings + ours.grid.ring_of(out)]};
      add("cells: composed value", fmt::format("C at cells {} {}", in, out), estimate,
          composed.values[c][file.cell_at(node_in.theta, node_in.phi) * cells +
                             file.cell_at(node_out.theta, node_out.phi)]);
    }
  }
}

void add_tree(Table& table, const std::filesystem::path& path, const Options& options) {
  const auto file = lobe::reference::read_tensor_tree3(path);
  const BrdfFunction function = lobe::load_measured(path);
  const auto device = lobe::Device::choose();
  std::vector<double> angles = angles_of(options);
  for (double& angle : angles) angle += kInside;
  const auto add = [&](const std::string& kind, const std::string& number, const Estimate& estimate, double value) {
    table.add(file.name, kind, number, estimate, value, rounding(value), kind == kOfTables);
  };
  const auto albedos = lobe::albedo(device, function, angles).front();
  for (std::size_t k = 0; k < angles.size(); ++k) {
    add("cells: albedo", fmt::format("albedo {}", angles[k] / lobe::kDegree), albedos[k],
        lobe::reference::albedo(file, angles[k]));
  }
  const double mean = lobe::reference::mean_albedo(file);
  add("cells: mean albedo", "mean albedo", lobe::mean_albedo(device, function).front(), mean);
  const auto norm = lobe::measure(device, std::vector{function}, lobe::Lighting::point(), {}).combined;
  add("cells: squared norm", "squared norm", {norm.gram(0, 0), norm.gram_error(0, 0)},
      lobe::reference::squared_norm(file));
  if (!options.with_cells) return;
  for (const char* name : {"klems:145", "gauss:64x128"}) {
    const auto of_grid =
        lobe::tabulate(device, function, lobe::HemisphereGrid::parse(name), {.allow_unresolved = true});
    add(kOfTables, fmt::format("mean albedo on {}", name), mean_of(of_grid), mean);
  }
}

/// Everything that is asked of one file.
void add_file(Table& table, const std::filesystem::path& path, const std::optional<std::filesystem::path>& next,
              const Options& options) {
  if (is_xml(path)) {
    if (contains(path, "TensorTree3")) return add_tree(table, path, options);
    const bool is_pair = next && is_xml(*next) && !contains(*next, "TensorTree3");
    return add_klems(table, path, is_pair ? next : std::nullopt, options);
  }
  const Subject subject = subject_of(path);
  if (subject.is_interpolated) add_samples(table, subject);
  if (!subject.function.is_isotropic) return;
  if (!options.angles.empty()) add_albedos(table, subject.function, subject.file, options);
  if (options.with_largest) add_largest(table, subject.function, subject.file);
  if (options.with_means) add_means(table, subject.function, subject.file, options.points);
  if (options.with_cells || options.with_compositions) {
    const bool is_single = subject.file.channels == 1;
    const BrdfFunction bright = is_single ? subject.function : lobe::load_measured(path, luminance());
    const MeasuredFile expected = is_single ? subject.file : lobe::reference::luminance_of(subject.file);
    if (options.with_cells) add_cells(table, bright, expected, options.points);
    if (options.with_compositions) add_compositions(table, lobe::Device::choose(), bright, expected, options);
  }
  if (!options.with_norms) return;
  std::optional<Subject> other;
  if (next && !is_xml(*next)) other = subject_of(*next);
  const bool is_pair = other && other->file.channels == subject.file.channels && other->function.is_isotropic;
  add_norms(table, subject, is_pair ? &*other : nullptr, options.points);
}

}  // namespace

int main(int count, char** words) {
  const Options options = options_of(count, words);
  Table table;
  bool has_refused = false;
  for (std::size_t k = options.from; k < options.files.size(); k += options.every) {
    std::optional<std::filesystem::path> next;
    if (k + options.every < options.files.size()) next = options.files[k + options.every];
    try {
      add_file(table, options.files[k], next, options);
    } catch (const std::exception& error) {  // files of transmission alone, for example
      fmt::print("{}: {}\n", options.files[k].filename().string(), error.what());
      has_refused = true;
    }
  }
  const bool holds = table.summarise() && !has_refused;
  return holds || !options.is_claim ? 0 : 1;
}
