// Tabulation and Gram accumulation against peers in the same run: Eigen/OpenMP on the host, OpenBLAS dsyrk, NumPy.
// Usage: bench_gram [--smoke | --sizes N,N,...] [google-benchmark options, such as --benchmark_out=FILE]
// --sizes: numbers of materials of the tables of growth (100,400,1600).
#include <benchmark/benchmark.h>
#include <cblas.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/accumulate_gram.hpp"
#include "gram_growth.hpp"
#include "gram_peers.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "lobe/lobe.hpp"
#include "measure.hpp"
#include "model/lobes.hpp"
#include "peers/eigen_host.hpp"

namespace {

/// Everything the benchmarks share.
struct Setting {
  lobe::Device device = lobe::Device::choose();
  lobe::Study study = lobe::load_study(LOBE_STUDIES "/merl-fits.toml");
  lobe::LobeSet lobes;                      ///< distinct lobes of all fits
  std::vector<peers::HostLobe> host_lobes;  ///< the same for the peers
  bench::NodeRows nodes;
  std::size_t block = 0;  ///< nodes per block, as the library chooses it
};

Setting make_setting(bool smoke) {
  Setting s;
  if (smoke) s.study.materials.erase(s.study.materials.begin() + 40, s.study.materials.end());
  s.lobes = lobe::make_lobe_set(formulas(s.study));
  s.host_lobes = bench::host_lobes(s.lobes);
  s.block = lobe::LobeEvaluator::suggested_capacity(s.lobes.lobes());
  s.nodes = bench::collect_nodes(lobe::HalfDifferenceRule(s.lobes.extent()), smoke ? 0 : 1);
  if (smoke) s.nodes = s.nodes.leftCols(std::min<Eigen::Index>(s.nodes.cols(), 4096)).eval();
  return s;
}

lobe::NodeBlock block_of(const Setting& s, Eigen::Index first) {
  lobe::NodeBlock block(s.block);
  const Eigen::Index last = std::min(first + static_cast<Eigen::Index>(s.block), s.nodes.cols());
  for (Eigen::Index node = first; node < last; ++node) {
    lobe::NodeBlock::Node column;
    for (std::size_t row = 0; row < column.size(); ++row) column[row] = s.nodes(static_cast<Eigen::Index>(row), node);
    block.push(column);
  }
  return block;
}

std::vector<lobe::NodeBlock> blocks_of(const Setting& s) {
  std::vector<lobe::NodeBlock> blocks;
  for (Eigen::Index first = 0; first < s.nodes.cols(); first += static_cast<Eigen::Index>(s.block)) {
    blocks.push_back(block_of(s, first));
  }
  return blocks;
}

void tabulate_lobe(benchmark::State& state, const Setting& s, const std::vector<lobe::LobeBatch>& batches) {
  lobe::LobeEvaluator evaluator(s.device, batches, lobe::Precision::double_precision, s.block);
  const lobe::NodeBlock block = block_of(s, 0);
  for (auto _ : state) {
    evaluator.evaluate(block);
    lobe::finish(s.device);
  }
  state.counters["Meval/s"] = benchmark::Counter(static_cast<double>(block.size() * evaluator.rows().size()) / 1e6,
                                                 benchmark::Counter::kIsIterationInvariantRate);
}

/// The first block of nodes, for the peers.
peers::Nodes first_nodes(const Setting& s) {
  const auto stride = static_cast<std::size_t>(s.nodes.cols());
  return {s.nodes.data(), stride, std::min(s.block, stride)};
}

void tabulate_eigen(benchmark::State& state, const Setting& s, const std::vector<peers::HostLobe>& lobes) {
  const peers::Nodes nodes = first_nodes(s);
  std::vector<double> samples(nodes.count * lobes.size());
  for (auto _ : state) {
    peers::tabulate(nodes, lobes, samples.data());
    benchmark::DoNotOptimize(samples.data());
  }
  state.counters["Meval/s"] =
      benchmark::Counter(static_cast<double>(samples.size()) / 1e6, benchmark::Counter::kIsIterationInvariantRate);
}

void set_flops(benchmark::State& state, double lobes, double nodes) {
  state.counters["GFLOP/s"] =
      benchmark::Counter(lobes * (lobes + 1) * nodes / 1e9, benchmark::Counter::kIsIterationInvariantRate);
}

void accumulate_lobe(benchmark::State& state, const Setting& s) {
  lobe::LobeEvaluator evaluator(s.device, s.lobes.batches, lobe::Precision::double_precision, s.block);
  lobe::GramAccumulator gram(evaluator, 0, evaluator.padded_lobes());
  const lobe::NodeBlock block = block_of(s, 0);
  evaluator.evaluate(block);
  for (auto _ : state) {
    gram.add(block.size());
    lobe::finish(s.device);
  }
  set_flops(state, static_cast<double>(evaluator.rows().size()), static_cast<double>(block.size()));
}

void accumulate_dsyrk(benchmark::State& state, const Setting& s) {
  const peers::Nodes nodes = first_nodes(s);
  const auto n = static_cast<int>(s.lobes.lobes());
  const auto k = static_cast<int>(nodes.count);
  std::vector<double> samples(nodes.count * s.lobes.lobes());
  peers::tabulate(nodes, s.host_lobes, samples.data());
  std::vector<double> gram(s.lobes.lobes() * s.lobes.lobes());
  for (auto _ : state) {
    cblas_dsyrk(CblasColMajor, CblasUpper, CblasTrans, n, k, 1.0, samples.data(), k, 1.0, gram.data(), n);
    benchmark::DoNotOptimize(gram.data());
  }
  set_flops(state, n, k);
}

void accumulate_eigen(benchmark::State& state, const Setting& s) {
  const peers::Nodes nodes = first_nodes(s);
  std::vector<double> samples(nodes.count * s.lobes.lobes());
  peers::tabulate(nodes, s.host_lobes, samples.data());
  std::vector<double> gram(s.lobes.lobes() * s.lobes.lobes());
  for (auto _ : state) {
    peers::accumulate(samples.data(), nodes.count, s.lobes.lobes(), gram.data());
    benchmark::DoNotOptimize(gram.data());
  }
  set_flops(state, static_cast<double>(s.lobes.lobes()), static_cast<double>(nodes.count));
}

void gram_lobe(benchmark::State& state, const Setting& s) {
  lobe::LobeEvaluator evaluator(s.device, s.lobes.batches, lobe::Precision::double_precision, s.block);
  lobe::GramAccumulator gram(evaluator, 0, evaluator.padded_lobes());
  const auto blocks = blocks_of(s);
  for (auto _ : state) {
    for (const auto& block : blocks) {
      evaluator.evaluate(block);
      gram.add(block.size());
    }
    auto sums = gram.take();
    benchmark::DoNotOptimize(sums.data());
  }
}

void gram_eigen(benchmark::State& state, const Setting& s) {
  const auto count = static_cast<std::size_t>(s.nodes.cols());
  std::vector<double> samples(s.block * s.lobes.lobes());
  for (auto _ : state) {
    std::vector<double> gram(s.lobes.lobes() * s.lobes.lobes());
    for (std::size_t first = 0; first < count; first += s.block) {
      const peers::Nodes nodes{s.nodes.data() + first, count, std::min(s.block, count - first)};
      peers::tabulate(nodes, s.host_lobes, samples.data());
      peers::accumulate(samples.data(), nodes.count, s.lobes.lobes(), gram.data());
    }
    benchmark::DoNotOptimize(gram.data());
  }
}

/// Median real time of a benchmark and the standard deviation of its repetitions, seconds.
struct Duration {
  double seconds = 0;
  double deviation = 0;
};
using Durations = std::map<std::string, Duration>;

/// Rows on standard error, and how long each benchmark took.
class Collector : public benchmark::ConsoleReporter {
 public:
  Collector() : ConsoleReporter(OO_Tabular) { SetOutputStream(&std::cerr); }

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const auto& run : runs) {
      const double seconds = run.GetAdjustedRealTime() / 1e3;
      auto& duration = durations[run.run_name.function_name];
      if (run.aggregate_name == "median" || run.repetitions <= 1) duration.seconds = seconds;
      if (run.aggregate_name == "stddev") duration.deviation = seconds;
    }
  }
  Durations durations;
};

/// A line of a comparison: the time of a peer over lobe's, with what the deviations of both make of it.
void print_ratio(const std::string& what, const Duration& peer, const Duration& ours) {
  const double ratio = peer.seconds / ours.seconds;
  const double spread = std::hypot(peer.deviation / peer.seconds, ours.deviation / ours.seconds);
  fmt::print("{:<44}{:>8.2f} ± {:.2f}\n", what, ratio, ratio * spread);
}

/// What was timed already, as benchmarks of their own: so it stands in the JSON file, too.
void register_record(const bench::Record& record) {
  auto next = std::make_shared<std::size_t>(0);
  const auto replay = [record, next](benchmark::State& state) {
    for (auto _ : state) state.SetIterationTime(record.seconds[(*next)++ % record.seconds.size()]);
    for (const auto& [name, value] : record.counters) state.counters[name] = value;
  };
  auto* item = benchmark::RegisterBenchmark(record.name.c_str(), replay);
  item->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(1);
  item->Repetitions(static_cast<int>(record.seconds.size()))->ReportAggregatesOnly(record.seconds.size() > 1);
}

/// "100,400,1600"
std::vector<std::size_t> parse_sizes(const std::string& text) {
  std::vector<std::size_t> sizes;
  std::istringstream in(text);
  for (std::string number; std::getline(in, number, ',');) sizes.push_back(std::stoul(number));
  if (sizes.size() < 2) throw std::invalid_argument("expected at least two sizes");
  return sizes;
}

void compare_on_fits(const Setting& s, Durations& durations) {
  const auto numpy = bench::run_numpy(s.nodes, s.host_lobes);
  const double evaluations = static_cast<double>(s.nodes.cols()) * static_cast<double>(s.lobes.lobes());
  fmt::print("\nSame nodes, same lobes; medians with standard deviations of 5 repetitions; above 1: lobe is faster\n");
  print_ratio("tabulation, Eigen/OpenMP / lobe", durations["tabulate_all/eigen"], durations["tabulate_all/lobe"]);
  print_ratio("Gram accumulation, OpenBLAS dsyrk / lobe", durations["accumulate/dsyrk"], durations["accumulate/lobe"]);
  print_ratio("Gram accumulation, Eigen/OpenMP / lobe", durations["accumulate/eigen"], durations["accumulate/lobe"]);
  print_ratio("whole Gram matrix, Eigen/OpenMP / lobe", durations["gram/eigen"], durations["gram/lobe"]);
  if (numpy) {  // once: without a spread
    const double ours_evaluate = durations["tabulate_all/lobe"].seconds *
                                 std::max(1.0, static_cast<double>(s.nodes.cols()) / static_cast<double>(s.block));
    fmt::print("{:<44}{:>8.2f}   NumPy {:.0f} Meval/s\n", "tabulation, NumPy / lobe", numpy->evaluate / ours_evaluate,
               evaluations / numpy->evaluate / 1e6);
    fmt::print("{:<44}{:>8.2f}\n", "whole Gram matrix, NumPy / lobe",
               (numpy->evaluate + numpy->products) / durations["gram/lobe"].seconds);
  } else {
    fmt::print("NumPy: not installed, left out\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  bench::let_openblas_choose(argv);
  const std::string first = argc > 1 ? argv[1] : "";
  const bool smoke = first == "--smoke";
  try {
    if (first == "--peak" && argc == 4) {
      bench::measure_peak(std::stoul(argv[2]), std::stod(argv[3]));
      return 0;
    }
    const auto sizes = parse_sizes(smoke ? "12,24" : first == "--sizes" && argc > 2 ? argv[2] : "100,400,1600");
    const Setting s = make_setting(smoke);
    bench::print_setting(s.device.info().name, s.device.info().driver);
    benchmark::Initialize(&argc, argv);
    for (const auto& record : bench::run_growth(s.device, {sizes, smoke ? 0.3 : 0.02, smoke})) register_record(record);
    fmt::print("\nThe published fits: {} lobes of {} materials, {} nodes\n", s.lobes.lobes(), s.study.materials.size(),
               s.nodes.cols());
    std::vector<benchmark::internal::Benchmark*> list;
    for (std::size_t b = 0; b < s.lobes.batches.size(); ++b) {
      const auto& batch = s.lobes.batches[b];
      std::vector<peers::HostLobe> peer;
      for (const auto& lobe : s.host_lobes) {
        if (lobe.model == batch.kernel.model) peer.push_back(lobe);
      }
      const std::string name = fmt::format("tabulate_{}", batch.kernel.model);
      list.push_back(benchmark::RegisterBenchmark((name + "/lobe").c_str(), tabulate_lobe, s, std::vector{batch}));
      list.push_back(benchmark::RegisterBenchmark((name + "/eigen").c_str(), tabulate_eigen, s, peer));
    }
    list.push_back(benchmark::RegisterBenchmark("tabulate_all/lobe", tabulate_lobe, s, s.lobes.batches));
    list.push_back(benchmark::RegisterBenchmark("tabulate_all/eigen", tabulate_eigen, s, s.host_lobes));
    list.push_back(benchmark::RegisterBenchmark("accumulate/lobe", accumulate_lobe, s));
    list.push_back(benchmark::RegisterBenchmark("accumulate/dsyrk", accumulate_dsyrk, s));
    list.push_back(benchmark::RegisterBenchmark("accumulate/eigen", accumulate_eigen, s));
    list.push_back(benchmark::RegisterBenchmark("gram/lobe", gram_lobe, s));
    list.push_back(benchmark::RegisterBenchmark("gram/eigen", gram_eigen, s));
    for (auto* item : list) {
      item->UseRealTime()->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
      if (smoke) {
        item->Iterations(1);
      } else {
        item->Repetitions(5)->ReportAggregatesOnly(true);
      }
    }
    Collector collector;
    benchmark::RunSpecifiedBenchmarks(&collector);

    compare_on_fits(s, collector.durations);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_gram: {}\n", error.what());
    return 1;
  }
}
