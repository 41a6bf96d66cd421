// The cost of a study is measured: the study itself is run for a few of its materials, for up to four times as many,
// and so on while there is time, and what each stage took grows from there by the power of the number of materials that
// it has to.
#include "lobe/study/study_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "compare/comparison_tiles.hpp"
#include "core/files.hpp"
#include "core/stopwatch.hpp"
#include "energy/prepare.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "hemisphere/refinement.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "metric/lighting_traits.hpp"
#include "model/lobes.hpp"
#include "plot/picture_files.hpp"
#include "study/run/picture_stems.hpp"
#include "study/run/study_operands.hpp"
#include "study/run/study_units.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFirstTrial = 2;
/// An estimate may be off by this factor, and by one that grows with what was not measured (docs/study-files.md).
constexpr double kNoise = 1.5;
constexpr double kGrowth = 0.25;

/// The share of a study that a trial has.
struct Trial {
  std::size_t materials = 0;
  std::map<std::string, double> seconds;       ///< by stage of run_study()
  std::map<std::string, std::uint64_t> nodes;  ///< by metric
};

/// By what power of the number of materials a stage grows: nodes are shared, and each is evaluated for every material.
/// Work on pairs also takes some time for each material, which dominates in small trials.
double power_of(std::string_view stage) {
  if (stage.ends_with(": nodes")) return 0;
  if (stage.ends_with(": values") || stage == "preparation" || stage == "reading" || stage == "curves") return 1;
  return 1.5;
}

/// The materials, where all are formulas whose lobes are known as they stand.
std::optional<std::vector<Material>> plain_formulas(const Study& study) {
  std::vector<Material> all = formulas(study);
  if (all.size() < study.materials.size() || std::ranges::any_of(all, needs_preparation)) return {};
  return all;
}

double width_of(const StudyMaterial& material) {
  const Material* formula = material.formula();
  if (formula == nullptr || needs_preparation(*formula)) return 1;
  return make_lobe_set(std::span(formula, 1), {.with_deltas = true, .with_anisotropic = true}).sharpest();
}

/// Places of `count` of `all`, evenly spaced, the first and the last among them.
std::vector<std::size_t> spread(std::size_t count, std::size_t all) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back(count == 1 ? 0 : i * (all - 1) / (count - 1));
  return places;
}

/// A study of some of the materials, the one with the sharpest lobe among them: rules follow that one.
Study trial_of(const Study& study, std::size_t count, std::size_t sharpest) {
  Study trial = study;
  trial.materials.clear();
  trial.published.clear();
  trial.charts.clear();
  trial.clustering.clusters = std::min(study.clustering.clusters, count);
  auto places = spread(count, study.materials.size());
  if (std::ranges::find(places, sharpest) == places.end()) {
    *std::ranges::min_element(places, {}, [&](std::size_t place) {
      return place > sharpest ? place - sharpest : sharpest - place;
    }) = sharpest;
  }
  for (const auto place : places) trial.materials.push_back(study.materials[place]);
  return trial;
}

std::size_t sharpest_of(const Study& study) {
  std::vector<double> widths;
  for (const auto& material : study.materials) widths.push_back(width_of(material));
  return static_cast<std::size_t>(std::ranges::min_element(widths) - widths.begin());
}

/// The result, and none where it takes too long.
std::optional<StudyResult> run_in_time(const Device& device, const Study& study, double deadline_seconds,
                                       const PlanOptions& options) {
  bool is_late = false;
  Stopwatch watch;
  double elapsed = 0;
  try {
    return run_study(device, study, [&](std::string_view, double) {
      elapsed += watch.lap();
      is_late = elapsed > deadline_seconds;
      return !is_late && (!options.progress || options.progress("trial", 0));
    });
  } catch (const Cancelled&) {
    if (!is_late) throw;
    return {};
  }
}

Trial trial_from(const StudyResult& result) {
  Trial trial{result.study.materials.size(), {}, {}};
  for (const auto& stage : result.stages) trial.seconds[stage.stage] += stage.seconds;
  for (const auto& metric : result.metrics) trial.nodes[metric.lighting.name()] = metric.work.nodes;
  for (const auto& comparison : result.comparisons) {
    trial.nodes[std::string(to_string(comparison.metric))] = comparison.work.nodes;
  }
  return trial;
}

/// Time of a stage for so many materials, from the two largest trials: a constant part, and one that grows.
double extrapolated(const std::string& stage, const std::vector<Trial>& trials, std::size_t materials) {
  const auto seconds_of = [&](const Trial& trial) {
    const auto found = trial.seconds.find(stage);
    return found == trial.seconds.end() ? 0 : found->second;
  };
  const Trial& last = trials.back();
  const double measured = seconds_of(last);
  if (last.materials == materials) return measured;
  const double power = power_of(stage);
  const auto size = [&](std::size_t count) { return std::pow(static_cast<double>(count), power); };
  const double in_proportion = measured * size(materials) / size(last.materials);
  if (trials.size() < 2 || power == 0) return in_proportion;
  const Trial& before = trials[trials.size() - 2];
  const double slope = (measured - seconds_of(before)) / (size(last.materials) - size(before.materials));
  return std::clamp(measured + slope * (size(materials) - size(last.materials)), measured, in_proportion);
}

/// Whether ranks leave a stage to the first of them.
bool is_alone(std::string_view stage) {
  return stage.ends_with(": embedding") || stage.ends_with(": clustering") || stage.ends_with(" approximations");
}

/// "point: values" belongs to "point".
std::string metric_of(const std::string& stage) {
  return stage.substr(0, stage.rfind(": "));
}

std::string method_of(const RouteChoice& choice, const Lighting& lighting, std::optional<std::size_t> slabs) {
  if (choice.grid) return fmt::format("tables on {}, {} nodes", choice.grid->name(), choice.grid->nodes());
  if (choice.route == Route::functions) return "as functions, two levels of quadrature and more";
  const LightingTraits& traits = traits_of(lighting);
  std::string method(traits.rule);
  if (traits.has_slabs) method += fmt::format(", {} slabs", slabs.value_or(0));
  if (!traits.has_operator) {
    method += fmt::format(", up to {} nodes per panel and axis, as products ask for", kNodesPerPanel.back());
  }
  return method;
}

/// \param share of the whole that was measured
void count(StudyPlan& plan, double seconds, double share) {
  const double factor = kNoise * (1 - kGrowth * std::log2(share));
  plan.seconds += seconds;
  // Lobes of one model share work, which a few materials do not show.
  plan.seconds_low += seconds / factor * std::sqrt(share);
  plan.seconds_high += seconds * factor;
}

void add(StudyPlan& plan, std::string name, double seconds, double share) {
  if (seconds <= 0) return;
  plan.stages.push_back({.name = std::move(name), .seconds = seconds});
  count(plan, seconds, share);
}

/// Metrics in the order of the study, then what else there is.
void add_stages(StudyPlan& plan, const Study& study, const ReflectanceList& reflectances,
                const std::vector<Trial>& trials, const PlanOptions& options) {
  std::map<std::string, double> seconds;
  std::map<std::string, double> alone;
  for (const auto& [stage, measured] : trials.back().seconds) {
    const double expected = extrapolated(stage, trials, plan.materials);
    seconds[metric_of(stage)] += expected;
    if (is_alone(stage)) alone[metric_of(stage)] += expected;
  }
  const auto take = [&](const std::string& name) {
    const auto node = seconds.extract(name);
    return node.empty() ? 0 : node.mapped();
  };
  const auto nodes = [&](const std::string& name) {
    const auto found = trials.back().nodes.find(name);
    return found == trials.back().nodes.end() ? 0 : found->second;
  };
  const double share = static_cast<double>(plan.tried) / static_cast<double>(plan.materials);
  const auto add_metric = [&](PlannedStage stage) {
    if (!stage.is_kept) count(plan, stage.seconds, share);
    plan.stages.push_back(std::move(stage));
  };
  std::optional<std::size_t> slabs;
  if (const auto all = plain_formulas(study); all && !study.grid) {
    slabs = HalfDifferenceRule(make_lobe_set(*all, {.with_deltas = true, .with_anisotropic = true}).extent()).slabs();
  }
  const MetricOptions metric = metric_options(study);
  for (const auto& lighting : study.lightings) {
    const std::string& name = lighting.name();
    const bool is_kept = options.checkpoint != nullptr && options.checkpoint->find(lighting).has_value();
    add_metric({name, method_of(choose_route(reflectances, lighting, metric), lighting, slabs), nodes(name), take(name),
                is_kept, alone[name]});
  }
  for (const auto comparison : study.comparison_metrics) {
    const std::string name(to_string(comparison));
    const bool is_kept = options.checkpoint != nullptr && options.checkpoint->find(comparison).has_value();
    add_metric({name, "refined slab by slab", nodes(name), take(name), is_kept});
  }
  for (const auto& [name, left] : seconds) add(plan, name, left, share);
}

/// How many materials the next trial has; none where what it is expected to take is not left. Much of what few
/// materials take is the same for many, so that steps are as large as there is time for.
std::optional<std::size_t> next_count(const std::vector<Trial>& trials, std::size_t all, double seconds_left) {
  const std::size_t last = trials.back().materials;
  for (const std::size_t factor : {4U, 2U}) {
    const std::size_t count = std::min(factor * last, all);
    // One trial alone does not tell what grows from what does not.
    if (trials.size() == 1) return count;
    double seconds = 0;
    for (const auto& [stage, measured] : trials.back().seconds) seconds += extrapolated(stage, trials, count);
    if (seconds <= seconds_left) return count;
  }
  return {};
}

/// The ladder of trials. Empty where not even the first is in time.
std::vector<Trial> run_trials(const Device& device, const Study& study, const PlanOptions& options) {
  constexpr double kRoughly = 1e-2;
  std::vector<Trial> trials;
  if (study.materials.empty()) return trials;
  const std::size_t sharpest = sharpest_of(study);
  const std::size_t all = study.materials.size();
  // Kernels are built or loaded beforehand, which may take longer than the trial does, and once only.
  constexpr double kBuilding = 30;
  Stopwatch watch;
  double spent = 0;
  std::optional<std::size_t> count = std::min(kFirstTrial, all);
  while (count) {
    const Study trial = trial_of(study, *count, sharpest);
    Study rough = trial;
    rough.tolerance = rough.patch_tolerance = rough.comparison_tolerance = kRoughly;
    rough.function_tolerance = std::max(rough.function_tolerance, kRoughly);
    if (!run_in_time(device, rough, options.deadline_seconds + kBuilding, options)) break;
    static_cast<void>(watch.lap());
    const auto result = run_in_time(device, trial, options.deadline_seconds, options);
    if (!result) break;
    spent += watch.lap();
    trials.push_back(trial_from(*result));
    count = *count == all ? std::nullopt : next_count(trials, all, options.trial_seconds - spent);
  }
  return trials;
}

/// Time for `all` things, extrapolated from some of them, evenly spread, as many as there is time for, but one at
/// least.
struct Measured {
  double seconds = 0;
  double share = 1;
};
template <typename One>
Measured measured_seconds(std::size_t all, double limit, const One& one) {
  std::vector<std::size_t> order;
  for (std::size_t step = std::bit_ceil(all); step > 0; step /= 2) {
    for (std::size_t k = 0; k < all; k += step) {
      if (std::ranges::find(order, k) == order.end()) order.push_back(k);
    }
  }
  Stopwatch watch;
  double spent = 0;
  std::size_t done = 0;
  for (; done < all && (done == 0 || spent < limit); ++done) {
    one(order[done]);
    spent += watch.lap();
  }
  const double share = static_cast<double>(done) / static_cast<double>(all);
  return {spent / share, share};
}

/// Quantities differ in what they take much more than figures of one quantity do.
void add_figures(StudyPlan& plan, const Device& device, const Study& study, const PlanOptions& options) {
  std::map<PublishedQuantity, std::vector<PublishedFigure>> quantities;
  for (const auto& figure : study.published) quantities[figure.quantity].push_back(figure);
  Measured all{0, 0};
  for (const auto& [quantity, figures] : quantities) {
    const double limit = options.trial_seconds / static_cast<double>(quantities.size());
    const Measured measured = measured_seconds(figures.size(), limit, [&, &some = figures](std::size_t k) {
      static_cast<void>(check_published(device, std::span(&some[k], 1), study.tolerance, options.progress));
    });
    all.seconds += measured.seconds;
    all.share += measured.seconds * measured.share;
  }
  if (all.seconds > 0) add(plan, "published figures", all.seconds, all.share / all.seconds);
}

/// A curve of a chart at a few of its abscissae, the one in the middle if at one.
Chart thinned(const Chart& chart, const ChartCurve& curve, std::size_t points) {
  Chart few = chart;
  few.curves = {curve};
  if (chart.x.size() <= points) return few;
  few.x.clear();
  if (!is_over_angle(chart.quantity)) few.curves.front().materials.clear();
  for (const auto place : points == 1 ? std::vector{chart.x.size() / 2} : spread(points, chart.x.size())) {
    few.x.push_back(chart.x[place]);
    if (!is_over_angle(chart.quantity)) few.curves.front().materials.push_back(curve.materials.at(place));
  }
  return few;
}

/// Time for curves of a quantity.
struct CurveCost {
  double first_point = 0;  ///< with what is prepared for the curve
  double other_point = 0;
  double share = 1;  ///< of the curves that were measured
};

/// The mean of as many curves as there is time for.
CurveCost cost_of_curves(const std::vector<std::pair<const Chart*, const ChartCurve*>>& curves, double limit,
                         const std::function<void(const Chart&)>& compute) {
  constexpr std::size_t kPoints = 3;
  CurveCost sum;
  double count = 0;
  const Measured measured = measured_seconds(curves.size(), limit, [&](std::size_t k) {
    const auto& [chart, curve] = curves[k];
    const Chart one = thinned(*chart, *curve, 1);
    const Chart few = thinned(*chart, *curve, kPoints);
    Stopwatch watch;
    compute(one);
    sum.first_point += watch.lap();
    compute(one);  // again, as kernels are loaded now
    const double seconds_one = watch.lap();
    compute(few);
    const double others = static_cast<double>(few.x.size()) - 1;
    if (others > 0) sum.other_point += std::max(watch.lap() - seconds_one, 0.0) / others;
    ++count;
  });
  return {sum.first_point / count, sum.other_point / count, measured.share};
}

void add_charts(StudyPlan& plan, const Device& device, const Study& study, const PlanOptions& options) {
  std::map<ChartQuantity, std::vector<std::pair<const Chart*, const ChartCurve*>>> quantities;
  for (const auto& chart : study.charts) {
    for (const auto& curve : chart.curves) quantities[chart.quantity].emplace_back(&chart, &curve);
  }
  const double limit = options.trial_seconds / static_cast<double>(std::max<std::size_t>(quantities.size(), 1));
  std::map<ChartQuantity, CurveCost> costs;
  for (const auto& [quantity, curves] : quantities) {
    costs[quantity] = cost_of_curves(curves, limit, [&](const Chart& chart) {
      static_cast<void>(compute_chart(device, chart, study.tolerance, options.progress));
    });
  }
  for (const auto& chart : study.charts) {
    const CurveCost& cost = costs.at(chart.quantity);
    const double of_curve = cost.first_point + cost.other_point * static_cast<double>(chart.x.size() - 1);
    add(plan, fmt::format("chart {}", chart.name), of_curve * static_cast<double>(chart.curves.size()), cost.share);
  }
}

/// A folder of its own, which goes.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((fs::temp_directory_path() / "lobe-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) throw IoError("cannot create a folder in " + path_ + "; set TMPDIR");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] fs::path path() const { return path_; }

 private:
  std::string path_;
};

/// Time that gnuplot needs for an almost empty picture; 0 without gnuplot.
double picture_seconds() {
  const TemporaryFolder folder;
  write_text(folder.path() / "line.gp", false, gnuplot::preamble("line", "a line", 640, 480) + "plot x\n");
  Stopwatch watch;
  return gnuplot::render(folder.path(), "line").empty() ? watch.lap() : 0;
}

/// Matrices of products and distances with their errors, of channels and combined.
std::uint64_t result_bytes(const Study& study) {
  const std::uint64_t n = study.materials.size();
  const std::uint64_t channels = std::max<std::size_t>(study.channels.size(), 1);
  const std::uint64_t parts = channels == 1 ? 1 : channels + 1;
  return 4 * sizeof(double) * n * n * parts * (study.lightings.size() + study.comparison_metrics.size());
}

/// While products of one lighting are refined: three levels of those of lobes, and what of slabs is kept of the first
/// pass; and tables and files.
struct WorkBytes {
  std::uint64_t products;  ///< of lightings and metrics of the literature
  std::uint64_t operands;
};
constexpr std::uint64_t kOnTheWay = std::uint64_t{64} << 20;  // values between host and device

WorkBytes bytes_of_work(const Study& study, const ReflectanceList& reflectances) {
  constexpr std::uint64_t kKept = std::uint64_t{256} << 20;  // as integrate_point_products() keeps
  constexpr std::uint64_t kSlabs = 24;                       // about as many as there are
  const std::uint64_t n = study.materials.size();
  std::uint64_t lobes = n;
  if (const auto all = plain_formulas(study); all && n > 0) {
    lobes = make_lobe_set(*all, {.with_deltas = true, .with_anisotropic = true}).lobes();
  }
  const std::uint64_t square = lobes * lobes * sizeof(double);
  std::uint64_t comparing = 0;
  if (!study.comparison_metrics.empty()) {
    // Integrals and their errors, of the slabs of a tile, and of all pairs.
    const bool has_tiles = choose_route(reflectances, literature_options(study)).route == Route::formulas;
    const std::uint64_t in_tile = has_tiles ? std::min<std::uint64_t>(n, kTileMaterials) : n;
    comparing =
        2 * (kSlabs * in_tile * in_tile + n * n) * sizeof(double) * std::max<std::size_t>(study.channels.size(), 1);
  }
  WorkBytes bytes{std::max(std::min(kSlabs * square, kKept) + 6 * square, comparing), 0};
  for (const auto& lighting : study.lightings) {
    const auto grid = choose_route(reflectances, lighting, metric_options(study)).grid;
    if (!grid) continue;
    const std::uint64_t nodes = grid->nodes();
    bytes.operands =
        std::max(bytes.operands, n * (grid->is_product() ? grid->rings().size() : nodes) * nodes * sizeof(double));
  }
  for (const auto& material : study.materials) {
    std::error_code ignored;
    if (const MaterialFile* file = material.file()) bytes.operands += 2 * fs::file_size(file->path, ignored);
  }
  return bytes;
}

/// Numbers are compressed and written as text.
double writing_seconds(const Study& study) {
  constexpr double kBytesPerSecond = 25e6;
  return static_cast<double>(result_bytes(study)) / kBytesPerSecond;
}

}  // namespace

void check_files(const Study& study) {
  for (const auto& material : study.materials) {
    const MaterialFile* file = material.file();
    if (file == nullptr) continue;
    std::ifstream stream(file->path, std::ios::binary);
    if (stream.get() == std::ifstream::traits_type::eof()) {
      throw IoError(fmt::format("cannot read {}: it is empty, or may not be read", file->path.string()));
    }
    if (!is_table_file(file->path) && !is_measured_file(file->path)) {
      throw IoError(fmt::format("cannot read {}: it is of no known format", file->path.string()),
                    {.fault = Fault::unknown_format, .path = file->path.string()});
    }
  }
}

StudyPlan plan_study(const Device& device, const Study& study, const PlanOptions& options) {
  check_files(study);
  StudyPlan plan;
  plan.materials = study.materials.size();
  plan.pairs = plan.materials * (plan.materials - std::min<std::size_t>(plan.materials, 1)) / 2;
  for (const auto& material : study.materials) {
    const auto known = std::ranges::find(plan.families, material.family(), &std::pair<std::string, std::size_t>::first);
    if (known == plan.families.end()) {
      plan.families.emplace_back(material.family(), 1);
    } else {
      ++known->second;
    }
  }
  plan.files = {study.name + ".h5"};
  for (auto& name : csv_names(study)) plan.files.push_back(std::move(name));
  for (auto& name : page_names(study)) plan.files.push_back(std::move(name));
  for (const auto& stem : picture_stems(study)) plan.pictures.push_back(stem + ".png");
  const StudyOperands operands = study_operands(study, options.progress);
  const WorkBytes work = bytes_of_work(study, operands.reflectances);
  plan.unit_bytes = kOnTheWay + work.products + work.operands;
  // At the peak: the results, and beside them the file that holds them, or the work.
  plan.work_bytes = result_bytes(study) + kOnTheWay + std::max(result_bytes(study), work.products) + work.operands;

  const auto trials = run_trials(device, study, options);
  const bool is_late = trials.empty() && plan.materials > 0;
  if (is_late) {
    plan.seconds_low = options.deadline_seconds;
  } else if (plan.materials > 0) {
    plan.tried = trials.back().materials;
    add_stages(plan, study, operands.reflectances, trials, options);
  }
  add_figures(plan, device, study, options);
  add_charts(plan, device, study, options);
  // Pictures take about twice as long as the one that is measured, which shows next to nothing.
  constexpr double kShare = 0.5;
  add(plan, "files and pictures",
      writing_seconds(study) + picture_seconds() / kShare * static_cast<double>(plan.pictures.size()), kShare);
  if (is_late) plan.seconds_high = std::numeric_limits<double>::infinity();
  return plan;
}

}  // namespace lobe
