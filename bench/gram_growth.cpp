#include "gram_growth.hpp"

#include <cblas.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "core/stopwatch.hpp"
#include "device/accumulate_gram.hpp"
#include "gram_peers.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "lobe/core/error.hpp"
#include "lobe/lobe.hpp"
#include "measure.hpp"
#include "model/lobes.hpp"

namespace bench {
namespace {

/// A lighting that takes longer than so many times the time of point light, or so many seconds, is given up.
constexpr double kGiveUp = 8;
constexpr double kGiveUpSeconds = 60;

/// k-th point of an even sequence in (0, 1), whatever the number of points.
double evenly(std::size_t k, double irrational) {
  const double at = (static_cast<double>(k) + 0.5) * irrational;
  return at - std::floor(at);
}

/// Single normalised lobes: nine families in turn, widths spread evenly by their logarithm. Basic patches are left out:
/// each of their radii is an edge that the quadrature follows for all of the materials.
std::vector<lobe::Material> make_materials(std::size_t count, double narrowest) {
  constexpr double kWidest = 0.5;
  std::vector<lobe::Material> materials;
  for (std::size_t k = 0; k < count; ++k) {
    const double share = evenly(k, 0.6180339887498949);   // golden section
    const double other = evenly(k, 0.41421356237309503);  // root of two
    const double width = narrowest * std::pow(kWidest / narrowest, share);
    const double exponent = 1 / (2 * width * width);
    const auto make = [&] {
      switch (k % 9) {
        case 0:
          return lobe::make_material("phong", {{"n", exponent}});
        case 1:
          return lobe::make_material("ward", {{"m", width}});
        case 2:
          return lobe::make_material("cook_torrance", {{"m", width}, {"f0", other}});
        case 3:
          return lobe::make_material("blinn", {{"n", 4 * exponent}});
        case 4:
          return lobe::make_material("oren_nayar", {{"sigma", share}});
        case 5:
          return lobe::make_material("metal_phong", {{"n", exponent}});
        case 6:
          return lobe::make_material("exponential_patch", {{"s", 1 / (2 * width)}});
        case 7:
          return lobe::make_material("lafortune_ngan", {{"c_xy", -1}, {"c_z", 0.8 + 0.2 * other}, {"n", exponent}});
        default:
          return lobe::make_material("minnaert", {{"k", 2 * share}});
      }
    };
    materials.push_back(make());
    materials.back().name = fmt::format("{} {}", k, materials.back().name);
  }
  return materials;
}

/// What the same study takes under each lighting.
const std::vector<std::string>& other_lightings() {
  static const std::vector<std::string> list{"daylight", "mean-albedo", "patch:0.1", "patch:0.5",
                                             "mixture:0.1=0.5,0.5=0.5"};
  return list;
}

double flops(std::size_t lobes, std::size_t nodes) {
  return static_cast<double>(lobes) * static_cast<double>(lobes + 1) * static_cast<double>(nodes);
}

/// Peers compute the same products, to what one level of the quadrature is worth.
void expect_same_products(const lobe::LobeSet& lobes, const Eigen::MatrixXd& ours, const std::vector<double>& theirs) {
  const auto n = static_cast<Eigen::Index>(lobes.lobes());
  const Eigen::Map<const Eigen::MatrixXd> of_lobes(theirs.data(), n, n);
  const Eigen::MatrixXd half = lobes.mix.front() * of_lobes;
  const Eigen::MatrixXd of_materials = lobes.mix.front() * half.transpose();
  const Eigen::VectorXd norm = ours.diagonal().cwiseSqrt();
  const double worst = ((ours - of_materials).array() / (norm * norm.transpose()).array()).abs().maxCoeff();
  if (!(worst <= 1e-4)) throw std::runtime_error(fmt::format("products of Eigen and lobe differ by {:.1g}", worst));
}

void expect_same_trace(double ours, double theirs) {
  if (!(std::abs(theirs - ours) <= 1e-4 * ours)) {
    throw std::runtime_error(fmt::format("traces of NumPy and lobe differ: {} and {}", theirs, ours));
  }
}

/// GFLOP/s of the accumulation of a block of samples, and of dsyrk of the same shape.
std::vector<Timing> time_accumulation(const lobe::Device& device, const lobe::LobeSet& lobes, const NodeRows& nodes,
                                      std::size_t& block_size, int rounds) {
  const std::size_t count = lobes.lobes();
  const auto capacity = lobe::LobeEvaluator::suggested_capacity(count);
  lobe::NodeBlock block(capacity);
  for (Eigen::Index k = 0; k < nodes.cols() && !block.full(); ++k) {
    lobe::NodeBlock::Node node;
    for (std::size_t row = 0; row < node.size(); ++row) node[row] = nodes(static_cast<Eigen::Index>(row), k);
    block.push(node);
  }
  block_size = block.size();
  lobe::LobeEvaluator evaluator(device, lobes.batches, lobe::Precision::double_precision, capacity);
  lobe::GramAccumulator accumulator(evaluator, 0, evaluator.padded_lobes());
  evaluator.evaluate(block);

  // Samples of an equal number of lobes and nodes, as the peer wants them.
  std::vector<double> samples(block.size() * count);
  peers::tabulate({nodes.data(), static_cast<std::size_t>(nodes.cols()), block.size()}, host_lobes(lobes),
                  samples.data());
  std::vector<double> gram(count * count);
  const auto n = static_cast<int>(count);
  const auto k = static_cast<int>(block.size());
  return measure_together({{"lobe",
                            [&] {
                              accumulator.add(block.size());
                              lobe::finish(device);
                            }},
                           {"dsyrk",
                            [&] {
                              cblas_dsyrk(CblasColMajor, CblasUpper, CblasTrans, n, k, 1.0, samples.data(), k, 1.0,
                                          gram.data(), n);
                            }}},
                          rounds);
}

/// Peak memory of a process that measures so many materials, MiB.
double peak_of(std::size_t count, double narrowest) {
  const std::string command = fmt::format("/proc/{}/exe --peak {} {}", ::getpid(), count, narrowest);
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  double peak = 0;
  const bool is_read = pipe != nullptr && std::fscanf(pipe, "%lf", &peak) == 1;
  if (pipe == nullptr || ::pclose(pipe) != 0 || !is_read) throw std::runtime_error("cannot measure peak memory");
  return peak;
}

/// Seconds of a study; nothing where it takes longer than `limit`.
std::optional<double> time_study(const lobe::Device& device, const std::vector<lobe::Material>& materials,
                                 const lobe::Lighting& lighting, double limit) {
  lobe::Stopwatch watch;
  double seconds = 0;
  lobe::MetricOptions options;
  options.progress = [&](std::string_view, double) {
    seconds += watch.lap();
    return seconds <= limit;
  };
  try {
    (void)lobe::measure(device, materials, lighting, options);
  } catch (const lobe::Cancelled&) {
    return std::nullopt;
  }
  return seconds + watch.lap();
}

/// One number of materials.
struct Growth {
  std::size_t materials = 0;
  lobe::WorkDone work;  ///< of the study
  Timing study, eigen;
  std::vector<Timing> accumulation;
  std::size_t block = 0;
  std::optional<double> numpy;
  double numpy_evaluate_share = 0;
  double peak = 0;  ///< MiB
};

Growth measure_growth(const lobe::Device& device, std::size_t count, double narrowest, int rounds) {
  const auto materials = make_materials(count, narrowest);
  const auto lobes = lobe::make_lobe_set(materials);
  // Most slabs stop at this level.
  const NodeRows nodes = collect_nodes(lobe::HalfDifferenceRule(lobes.extent()), 1);
  const auto node_count = static_cast<std::size_t>(nodes.cols());
  const auto list = host_lobes(lobes);
  const std::size_t block = lobe::LobeEvaluator::suggested_capacity(count);

  lobe::MetricResult result;
  std::vector<double> gram;
  const auto eigen = [&] {
    std::vector<double> samples(block * count);
    gram.assign(count * count, 0);
    for (std::size_t first = 0; first < node_count; first += block) {
      const peers::Nodes some{nodes.data() + first, node_count, std::min(block, node_count - first)};
      peers::tabulate(some, list, samples.data());
      peers::accumulate(samples.data(), some.count, count, gram.data());
    }
    std::vector<double> distance(count * count);
    peers::find_distances(gram.data(), count, distance.data());
  };
  auto timings = measure_together(
      {{"lobe", [&] { result = lobe::measure(device, materials, lobe::Lighting::point()); }}, {"Eigen/OpenMP", eigen}},
      rounds);
  expect_same_products(lobes, result.combined.gram, gram);

  // The study visits coarse nodes for its error estimates, too: so do the peers, in proportion.
  const double share = static_cast<double>(result.work.nodes) / static_cast<double>(node_count);
  Growth growth;
  growth.materials = count;
  growth.work = result.work;
  growth.study = timings[0];
  growth.eigen = timings[1];
  growth.eigen.seconds *= share;
  growth.eigen.ratio_to_first *= share;
  growth.eigen.ratio_spread *= share;
  for (double& seconds : growth.eigen.rounds) seconds *= share;
  if (const auto numpy = run_numpy(nodes, list)) {
    expect_same_trace(result.combined.gram.trace(), numpy->trace);
    growth.numpy = numpy->seconds() * share;
    growth.numpy_evaluate_share = numpy->evaluate / numpy->seconds();
  }
  growth.accumulation = time_accumulation(device, lobes, nodes, growth.block, std::max(rounds, 5));
  growth.peak = peak_of(count, narrowest);
  return growth;
}

void print_growth(const std::vector<Growth>& list, double base) {
  fmt::print(
      "\nGram and distance matrix under point light, measure() as a whole; peers: the same lobes at as many nodes, "
      "given to them. Medians; (peer / lobe)\n{:>9}{:>12}{:>12}{:>22}{:>20}{:>18}{:>24}{:>12}\n",
      "materials", "nodes", "lobe, s", "Eigen/OpenMP, s", "NumPy, s", "Gram, GFLOP/s", "dsyrk, GFLOP/s", "peak, MiB");
  for (const Growth& g : list) {
    const std::string numpy =
        g.numpy ? fmt::format("{:.4g} ({:.2f}x)", *g.numpy, *g.numpy / g.study.seconds) : "no NumPy";
    const double work = flops(g.materials, g.block) / 1e9;
    fmt::print("{:>9}{:>12}{:>12.4g}{:>22}{:>20}{:>18.1f}{:>24}{:>12.0f}\n", g.materials, g.work.nodes, g.study.seconds,
               fmt::format("{:.4g} ({:.2f} ± {:.2f}x)", g.eigen.seconds, g.eigen.ratio_to_first, g.eigen.ratio_spread),
               numpy, work / g.accumulation[0].seconds,
               fmt::format("{:.1f} ({:.2f} ± {:.2f}x)", work / g.accumulation[1].seconds,
                           g.accumulation[1].ratio_to_first, g.accumulation[1].ratio_spread),
               g.peak);
  }
  fmt::print("where lobe's time goes, %: placing nodes, evaluation, products, host\n");
  for (const Growth& g : list) {
    const auto& w = g.work;
    const double all = (w.seconds_nodes + w.seconds_values + w.seconds_gram + w.seconds_host) / 100;
    fmt::print("{:>9}{:>12.0f}{:>12.0f}{:>12.0f}{:>12.0f}\n", g.materials, w.seconds_nodes / all,
               w.seconds_values / all, w.seconds_gram / all, w.seconds_host / all);
  }
  std::vector<double> sizes;
  std::vector<double> seconds;
  std::vector<double> per_node;
  std::vector<double> memory;
  for (const Growth& g : list) {
    sizes.push_back(static_cast<double>(g.materials));
    seconds.push_back(g.study.seconds);
    per_node.push_back(g.study.seconds / static_cast<double>(g.work.nodes));
    memory.push_back(g.peak - base);
  }
  fmt::print("exponents in the number of materials: time {:.2f}, time per node {:.2f}, memory {:.2f}\n",
             fitted_exponent(sizes, seconds), fitted_exponent(sizes, per_node), fitted_exponent(sizes, memory));
  fmt::print(
      "peak memory: VmHWM of a process of its own; the exponent is that of what it has above {:.0f} MiB, the "
      "peak for two materials\n",
      base);
  std::fflush(stdout);
}

/// Prints a row of ratios to point light, or what they are above, and records the times.
void compare_lightings(const lobe::Device& device, std::size_t count, double narrowest, int rounds,
                       std::vector<Record>& records) {
  const auto materials = make_materials(count, narrowest);
  const auto names = other_lightings();
  std::vector<std::vector<double>> seconds(names.size());
  std::vector<std::vector<double>> ratios(names.size());
  std::vector<double> above(names.size());  // where it was given up, times of point light
  for (const auto& name : names) {          // kernels are built before the clock starts
    (void)lobe::measure(device, make_materials(2, 0.5), lobe::parse_lighting(name));
  }
  for (int round = 0; round < rounds; ++round) {
    const double point = *time_study(device, materials, lobe::Lighting::point(), 1e9);
    const double limit = std::min(kGiveUp * point, kGiveUpSeconds);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (above[k] > 0) continue;
      if (const auto taken = time_study(device, materials, lobe::parse_lighting(names[k]), limit)) {
        seconds[k].push_back(*taken);
        ratios[k].push_back(*taken / point);
      } else {
        above[k] = limit / point;
      }
    }
  }
  fmt::print("{:>9}", count);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (above[k] > 0) {
      fmt::print("{:>26}", fmt::format("> {:.2g}", above[k]));
      continue;
    }
    fmt::print("{:>26.2f}", median(ratios[k]));
    records.push_back({fmt::format("lighting/{}/{}", names[k], count),
                       std::move(seconds[k]),
                       {{"ratio_to_point", median(ratios[k])}}});
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void append_records(const Growth& g, std::vector<Record>& records) {
  const auto named = [&](const char* what) { return fmt::format("{}/{}", what, g.materials); };
  const double work = flops(g.materials, g.block) / 1e9;
  records.push_back({named("study/lobe"),
                     g.study.rounds,
                     {{"materials", static_cast<double>(g.materials)},
                      {"nodes", static_cast<double>(g.work.nodes)},
                      {"peak_MiB", g.peak}}});
  records.push_back({named("study/eigen"), g.eigen.rounds, {{"ratio_to_lobe", g.eigen.ratio_to_first}}});
  if (g.numpy) {
    records.push_back(
        {named("study/numpy"),
         {*g.numpy},
         {{"ratio_to_lobe", *g.numpy / g.study.seconds}, {"share_of_evaluation", g.numpy_evaluate_share}}});
  }
  for (const Timing& timing : g.accumulation) {
    records.push_back({named(("gram/" + timing.name).c_str()),
                       timing.rounds,
                       {{"GFLOP/s", work / timing.seconds}, {"ratio_to_lobe", timing.ratio_to_first}}});
  }
}

}  // namespace

std::vector<Record> run_growth(const lobe::Device& device, const GrowthOptions& options) {
  std::vector<Record> records;
  std::vector<Growth> list;
  const auto rounds_for = [&](std::size_t count) {
    return options.smoke ? 1 : count <= 100 ? 7 : count <= 400 ? 3 : 1;
  };
  for (const std::size_t count : options.sizes) {
    list.push_back(measure_growth(device, count, options.narrowest, rounds_for(count)));
    append_records(list.back(), records);
  }
  print_growth(list, peak_of(2, options.narrowest));

  fmt::print(
      "\nTime of measure() over that under point light, at the default tolerances (patch lights: 1e-5, else "
      "1e-6)\n{:>9}",
      "materials");
  for (const auto& name : other_lightings()) fmt::print("{:>26}", name);
  fmt::print("\n");
  for (const std::size_t count : options.sizes) {
    compare_lightings(device, count, options.narrowest, rounds_for(count), records);
  }
  return records;
}

void measure_peak(std::size_t count, double narrowest) {
  const auto device = lobe::Device::choose();
  (void)lobe::measure(device, make_materials(count, narrowest), lobe::Lighting::point());
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) fmt::print("{}\n", std::stod(line.substr(6)) / 1024);
  }
}

}  // namespace bench
