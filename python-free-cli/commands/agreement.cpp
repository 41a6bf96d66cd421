#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/measuring.hpp"
#include "interface/operand_list.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/reading.hpp"
#include "lobe/compare/judgement.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/files.hpp"
#include "lobe/reflectance/as_function.hpp"

namespace lobe::cli {
namespace {

constexpr Texts kAgreementFamily{"family"};
constexpr Text kJudgements{"JUDGEMENTS"};
constexpr Texts kAgreementMetric{"metric"};
constexpr Text kReferences{"references"};
constexpr Count kAgreementSeed{"seed"};

constexpr double kDomain = 80;  // degrees
constexpr double kTolerance = 1e-2;

/// A lighting or a comparison metric.
struct Metrics {
  std::vector<Lighting> lightings;
  std::vector<LiteratureMetric> comparisons;

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> list;
    for (const auto& lighting : lightings) list.push_back(lighting.name());
    for (const auto comparison : comparisons) list.emplace_back(to_string(comparison));
    return list;
  }
};

Metrics metrics_of(const Arguments& arguments) {
  Metrics metrics;
  for (const auto& name : arguments.texts(kAgreementMetric)) {
    const LiteratureMetric comparison = parse_literature_metric(name);
    if (std::ranges::find(metrics.comparisons, comparison) != metrics.comparisons.end()) {
      throw ArgumentError("--metric " + name + " is given twice; give it once");
    }
    metrics.comparisons.push_back(comparison);
  }
  if (arguments.has(option::lighting)) metrics.lightings = lightings_of(arguments);
  for (const auto& lighting : metrics.lightings) {
    if (takes_tables(lighting)) {
      throw ArgumentError("--lighting " + lighting.name() + " takes tables; expected point, daylight or mean-albedo");
    }
  }
  if (!metrics.names().empty()) return metrics;
  metrics.lightings = {Lighting::point(), Lighting::daylight(), Lighting::mean_albedo()};
  metrics.comparisons.assign(literature_metrics().begin(), literature_metrics().end());
  return metrics;
}

double domain_of_agreement(const Arguments& arguments) {
  return arguments.has(option::domain_theta_max) ? domain_of(arguments) : kDomain * kDegree;
}

/// "ward alum-bronze", by which approximations are found.
std::string key_of(const Judgement& judgement) {
  return lowercase(judgement.method + " " + judgement.material);
}

/// Materials by name; of files also by the stems of their paths.
std::map<std::string, const Operand*> by_name(std::span<const Operand> operands) {
  std::map<std::string, const Operand*> found;
  const auto add = [&](const std::string& name, const Operand& operand) {
    const auto [place, is_new] = found.emplace(lowercase(name), &operand);
    if (!is_new && place->second != &operand) {
      throw ArgumentError("two materials are called '" + name + "'; expected one of them");
    }
  };
  for (const auto& operand : operands) {
    add(operand.label(), operand);
    if (!operand.is_formula()) add(std::filesystem::path(operand.label()).stem().string(), operand);
  }
  return found;
}

/// Files of a folder by their stems.
std::map<std::string, std::filesystem::path> files_of(const std::string& folder) {
  std::map<std::string, std::filesystem::path> files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    if (entry.is_regular_file()) files.emplace(lowercase(entry.path().stem().string()), entry.path());
  }
  if (failure)
    throw IoError("cannot read the folder " + folder + ": " + failure.message(), {.fault = fault_of(failure)});
  return files;
}

/// A pair that is judged and computed.
struct JudgedPair {
  Judgement judgement;
  std::vector<Estimate> distance;  ///< by metric
  std::vector<Estimate> relative;  ///< to the size of the reference
};

/// Judgements on one material that can be computed.
struct Group {
  std::string material;
  std::vector<Judgement> judgements;
  std::vector<const Operand*> approximations;
};

Estimate ratio(const Estimate& a, const Estimate& b) {
  const double value = a.value / b.value;
  return {value, (a.error + std::abs(value) * b.error) / std::max(b.value - b.error, 0.0)};
}

void add_distances(std::vector<JudgedPair>& pairs, const Eigen::MatrixXd& distance, const Eigen::MatrixXd& error,
                   const Estimate& size) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k + 1);
    pairs[k].distance.push_back({distance(row, 0), error(row, 0)});
    pairs[k].relative.push_back(ratio(pairs[k].distance.back(), size));
  }
}

/// Distances of the approximations of one material from it, which is the first of the functions.
std::vector<JudgedPair> computed(const Device& device, const Group& group, std::span<const BrdfFunction> functions,
                                 const Metrics& metrics, const std::vector<double>& channel_weights, double tolerance,
                                 double theta_max, const ProgressCallback& progress) {
  std::vector<JudgedPair> pairs;
  for (const auto& judgement : group.judgements) pairs.push_back({judgement, {}, {}});
  for (const auto& lighting : metrics.lightings) {
    const auto result = measure(device, functions, lighting,
                                {.channel_weights = channel_weights,
                                 .theta_max = theta_max,
                                 .progress = progress,
                                 .route = Route::functions,
                                 .function_tolerance = tolerance});
    const Metric& metric = result.combined;
    add_distances(pairs, metric.distance, metric.distance_error, {metric.norm(0), metric.norm_error(0)});
  }
  for (const auto comparison : metrics.comparisons) {
    LiteratureOptions options;
    options.tolerance = tolerance;
    options.channel_weights = channel_weights;
    options.theta_max = theta_max;
    options.progress = progress;
    options.route = Route::functions;
    const LiteratureMatrix matrix = compare(device, functions, comparison, options).combined;
    add_distances(pairs, matrix.distance, matrix.distance_error, {matrix.size(0), matrix.size_error(0)});
  }
  return pairs;
}

/// A metric's correlations with what was judged.
struct Row {
  std::string metric;
  bool is_relative = false;
  double median_error = 0;  ///< of the distances, relative
  JudgementCorrelation over_materials;
  JudgementCorrelation over_pairs;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Row> correlations(const std::vector<JudgedPair>& pairs, const std::vector<std::string>& names,
                              const BootstrapOptions& options) {
  std::vector<double> judged;
  std::vector<std::string> materials;
  for (const auto& pair : pairs) {
    judged.push_back(pair.judgement.distance);
    materials.push_back(pair.judgement.material);
  }
  std::vector<Row> rows;
  for (std::size_t m = 0; m < names.size(); ++m) {
    for (const bool is_relative : {false, true}) {
      std::vector<double> distances;
      std::vector<double> errors;
      for (const auto& pair : pairs) {
        const Estimate& distance = (is_relative ? pair.relative : pair.distance)[m];
        distances.push_back(distance.value);
        errors.push_back(distance.error / distance.value);
      }
      rows.push_back({names[m], is_relative, median(errors),
                      judgement_correlation(distances, judged, materials, options),
                      judgement_correlation(distances, judged, {}, options)});
    }
  }
  return rows;
}

/// Which pairs were computed, by method.
struct Coverage {
  std::string method;
  std::size_t judged = 0;
  std::size_t used = 0;
};

std::vector<Coverage> coverage_of(const std::vector<Judgement>& judgements, const std::vector<JudgedPair>& pairs) {
  std::vector<Coverage> list;
  const auto of = [&](const std::string& method) -> Coverage& {
    const auto found = std::ranges::find(list, method, &Coverage::method);
    return found != list.end() ? *found : list.emplace_back(Coverage{method});
  };
  for (const auto& judgement : judgements) ++of(judgement.method).judged;
  for (const auto& pair : pairs) ++of(pair.judgement.method).used;
  return list;
}

std::size_t materials_of(const std::vector<JudgedPair>& pairs) {
  std::set<std::string> materials;
  for (const auto& pair : pairs) materials.insert(pair.judgement.material);
  return materials.size();
}

std::string answer_text(const std::vector<Row>& rows, const std::vector<Coverage>& coverage,
                        const std::vector<JudgedPair>& pairs, std::size_t judged, double share, bool color) {
  std::string text = fmt::format("{} of {} judged pairs, of {} materials:", pairs.size(), judged, materials_of(pairs));
  std::string separator = " ";
  for (const auto& method : coverage) {
    if (method.used == 0) continue;
    text += fmt::format("{}{} {}", separator, method.method, method.used);
    separator = ", ";
  }
  text += "\n\n";
  const std::string interval = fmt::format("{}%", shortest(100 * share));
  std::vector<std::vector<std::string>> table{{"metric", "distance", "spearman", interval, "kendall", interval}};
  const auto range = [](const Interval& of) { return fmt::format("{:.2f} to {:.2f}", of.low, of.high); };
  for (const auto& row : rows) {
    const auto& found = row.over_materials;
    table.push_back({row.metric, row.is_relative ? "relative" : "absolute", fmt::format("{:.2f}", found.spearman.value),
                     range(found.spearman), fmt::format("{:.2f}", found.kendall.value), range(found.kendall)});
  }
  return text + format_table(table, 2, color);
}

std::string answer_csv(const std::vector<Row>& rows) {
  std::string text =
      "metric,distance,spearman,spearman_low,spearman_high,spearman_low_pairs,spearman_high_pairs,kendall,kendall_low,"
      "kendall_high,kendall_low_pairs,kendall_high_pairs,median_relative_error\n";
  for (const auto& row : rows) {
    text += csv_field(row.metric) + (row.is_relative ? ",relative" : ",absolute");
    for (const auto quantity : {&JudgementCorrelation::spearman, &JudgementCorrelation::kendall}) {
      const Interval& materials = row.over_materials.*quantity;
      const Interval& pairs = row.over_pairs.*quantity;
      for (const double x : {materials.value, materials.low, materials.high, pairs.low, pairs.high}) {
        text += "," + shortest(x);
      }
    }
    text += "," + shortest(row.median_error) + "\n";
  }
  return text;
}

/// Every pair with its distances.
std::string pairs_csv(const std::vector<JudgedPair>& pairs, const std::vector<std::string>& names) {
  std::string text = "method,brdf,judged,metric,distance,distance_error,relative,relative_error\n";
  for (const auto& pair : pairs) {
    for (std::size_t m = 0; m < names.size(); ++m) {
      text += fmt::format("{},{},{},{},{},{},{},{}\n", csv_field(pair.judgement.method),
                          csv_field(pair.judgement.material), shortest(pair.judgement.distance), csv_field(names[m]),
                          shortest(pair.distance[m].value), shortest(pair.distance[m].error),
                          shortest(pair.relative[m].value), shortest(pair.relative[m].error));
    }
  }
  return text;
}

Json interval_json(const Interval& materials, const Interval& pairs) {
  return {{"value", to_json(materials.value)},
          {"interval", {to_json(materials.low), to_json(materials.high)}},
          {"interval_over_pairs", {to_json(pairs.low), to_json(pairs.high)}}};
}

Json answer_json(const std::vector<Row>& rows, const std::vector<Coverage>& coverage,
                 const std::vector<JudgedPair>& pairs, std::size_t judged, const BootstrapOptions& options) {
  Json answer = json_answer("agreement");
  answer["judged_pairs"] = judged;
  answer["pairs"] = pairs.size();
  answer["materials"] = materials_of(pairs);
  answer["methods"] = Json::array();
  for (const auto& method : coverage) {
    answer["methods"].push_back({{"method", method.method}, {"judged_pairs", method.judged}, {"pairs", method.used}});
  }
  answer["bootstrap"] = {
      {"samples", options.samples}, {"coverage", options.coverage}, {"seed", options.seed}, {"over", "materials"}};
  answer["metrics"] = Json::array();
  for (const auto& row : rows) {
    answer["metrics"].push_back({{"metric", row.metric},
                                 {"distance", row.is_relative ? "relative" : "absolute"},
                                 {"spearman", interval_json(row.over_materials.spearman, row.over_pairs.spearman)},
                                 {"kendall", interval_json(row.over_materials.kendall, row.over_pairs.kendall)},
                                 {"median_relative_error", to_json(row.median_error)}});
  }
  return answer;
}

std::vector<Judgement> read_judgements(const std::string& path) {
  const std::string text = read_text(path);
  try {
    return parse_judgements(text);
  } catch (const ArgumentError& error) {
    throw IoError("cannot read " + path + ": " + error.what(), {.fault = Fault::content, .path = path});
  }
}

/// Selects the judgements that can be computed.
/// \param is_reference whether there is a reference of that name
template <typename IsReference>
std::vector<Group> groups_of(const std::vector<Judgement>& judgements,
                             const std::map<std::string, const Operand*>& materials, const IsReference& is_reference) {
  std::vector<Group> groups;
  for (const auto& judgement : judgements) {
    const auto approximation = materials.find(key_of(judgement));
    if (approximation == materials.end() || !is_reference(lowercase(judgement.material))) continue;
    auto group = std::ranges::find(groups, judgement.material, &Group::material);
    if (group == groups.end()) group = groups.insert(groups.end(), {judgement.material, {}, {}});
    group->judgements.push_back(judgement);
    group->approximations.push_back(approximation->second);
  }
  return groups;
}

BootstrapOptions bootstrap_options(const Arguments& arguments) {
  BootstrapOptions options;
  if (arguments.has(option::samples)) options.samples = arguments.count(option::samples, 1'000'000);
  if (arguments.has(kAgreementSeed)) options.seed = arguments.count(kAgreementSeed, 1'000'000'000);
  return options;
}

ExitCode execute_agreement(Session& session) {
  const auto& arguments = session.arguments();
  if (arguments.has(option::csv) && session.wants_json()) throw ArgumentError("--csv and --json are given; choose one");
  const OutputFile file(session);
  if (file.is_wanted() && file.path().extension() != ".csv") {
    throw ArgumentError("--output " + file.path().string() + " is no name of a table of text; expected FILE.csv");
  }
  const Metrics metrics = metrics_of(arguments);
  const BootstrapOptions bootstrap = bootstrap_options(arguments);
  const double theta_max = domain_of_agreement(arguments);
  const double tolerance = session.tolerance(kTolerance);
  const std::string path = arguments.text(kJudgements);
  const auto judgements = read_judgements(path);
  const OperandList list =
      read_operands(session, arguments.texts(argument::materials), arguments.texts(kAgreementFamily));
  const auto materials = by_name(list.operands);
  std::map<std::string, std::filesystem::path> references;
  if (arguments.has(kReferences)) references = files_of(arguments.text(kReferences));

  const auto groups = groups_of(judgements, materials, [&](const std::string& name) {
    return references.contains(name) || materials.contains(name);
  });
  std::size_t count = 0;
  for (const auto& group : groups) count += group.judgements.size();
  if (count < 3) {
    throw ArgumentError(fmt::format(
        "{} of the {} judged pairs of {} can be computed; expected at least 3: materials called 'METHOD BRDF', such as "
        "'{} {}', and a material called BRDF or a file of that name in --references",
        count, judgements.size(), path, judgements.front().method, judgements.front().material));
  }
  const auto device = session.choose_device();
  const auto progress = session.progress();
  std::vector<JudgedPair> pairs;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Group& group = groups[g];
    const auto report = [&](std::string_view, double) {
      return !progress || progress("agreement", static_cast<double>(g) / static_cast<double>(groups.size()));
    };
    const std::string name = lowercase(group.material);
    const auto reference = references.find(name);
    std::vector<BrdfFunction> functions;
    functions.push_back(
        reference != references.end()
            ? as_function(device, Operand(reference->second.string(), read_options(arguments)).reflectance())
            : as_function(device, materials.at(name)->reflectance()));
    for (const Operand* approximation : group.approximations)
      functions.push_back(as_function(device, approximation->reflectance()));
    for (auto& pair : computed(device, group, functions, metrics, list.channel_weights, tolerance, theta_max, report)) {
      pairs.push_back(std::move(pair));
    }
  }
  session.end_progress();
  const auto names = metrics.names();
  for (const auto& pair : pairs) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      session.note_if_missed(fmt::format("{}: a distance of '{}'", names[i], pair.judgement.material), pair.distance[i],
                             tolerance);
    }
  }
  const auto rows = correlations(pairs, names, bootstrap);
  const auto coverage = coverage_of(judgements, pairs);
  if (file.is_wanted()) file.write(pairs_csv(pairs, names));
  if (session.wants_json()) {
    Json answer = answer_json(rows, coverage, pairs, judgements.size(), bootstrap);
    if (file.is_wanted()) answer["file"] = file.path().string();
    answer["domain_theta_max_deg"] = domain_degrees(theta_max).value_or(90);
    answer["tolerance"] = tolerance;
    answer["device"] = to_json(device.info());
    session.print_json(answer);
  } else if (arguments.has(option::csv)) {
    session.print(answer_csv(rows));
  } else {
    session.print(answer_text(rows, coverage, pairs, judgements.size(), bootstrap.coverage, session.colors_output()));
  }
  return ExitCode::success;
}

}  // namespace

Command agreement_command() {
  return {
      .name = "agreement",
      .group = "Metric",
      .summary = "compare distances with human judgements",
      .description =
          "Correlates computed distances with distances that people judged. Prints Spearman's rho and Kendall's tau-b, "
          "for each lighting and each metric from the literature, over the pairs that both have: once for absolute "
          "distances, once for distances relative to the size of the approximated material.\n"
          "JUDGEMENTS is a text table with the columns METHOD, BRDF and DISTANCE. An approximation is a material "
          "called 'METHOD BRDF', such as 'WARD alum-bronze', in upper or lower case, as families in studies name "
          "theirs; its original is a material called BRDF, or the file of that name in the --references folder. Other "
          "pairs are left out, and counted.\n"
          "Intervals of 95 % come from a bootstrap over materials, which draws all judgements on a material together; "
          "CSV and JSON also give those over single pairs. Distances are computed from functions, within the "
          "tolerance.",
      .positionals = {{.handle = kJudgements, .help = "the table of judged distances"},
                      {.handle = argument::materials,
                       .help = "materials, files and study files (FILE.toml for all materials, FILE.toml#FAMILY for a "
                               "family)",
                       .is_material = true,
                       .is_repeated = true}},
      .options = {{.handle = kReferences,
                   .value = "FOLDER",
                   .help = "folder with the files of the approximated materials"},
                  {.handle = option::lighting,
                   .value = "LIGHTING",
                   .help = "point, daylight or mean-albedo; may be repeated (default: all three, and all metrics)"},
                  {.handle = kAgreementMetric,
                   .value = "METRIC",
                   .help = "a metric from the literature, such as cube-root-l2; may be repeated"},
                  {.handle = kAgreementFamily,
                   .value = "NAME",
                   .help = "use only this family of the study files; may be repeated"},
                  set_option(),
                  {.handle = option::domain_theta_max,
                   .value = "DEGREES",
                   .help = "largest angle of light and view from the normal (default 80)"},
                  tolerance_option("largest relative error of the distances (default 1e-2)"),
                  strict_option(),
                  {.handle = option::samples, .value = "N", .help = "number of bootstrap samples (default 1000)"},
                  {.handle = kAgreementSeed, .value = "N", .help = "seed of the bootstrap (default 1)"},
                  {.handle = option::csv, .help = "print comma-separated values in full precision"},
                  {.handle = option::output,
                   .letter = 'o',
                   .value = "FILE.csv",
                   .help = "write the distances of all pairs, with errors, to a file"},
                  {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
                  json_option()},
      .examples =
          {{"published fits against the judgements by Lavoué et al. 2021, with MERL files in a folder",
            "lobe agreement PerceptualDistances.csv studies/merl-fits.toml studies/perceptual-fits.toml --references "
            "merl"},
           {"one metric and one lighting up to 75 degrees, and the distances of all pairs as CSV",
            "lobe agreement PerceptualDistances.csv studies/merl-fits.toml#Ward --references merl --metric "
            "cube-root-l2 --lighting point --domain-theta-max 75 -o distances.csv"}},
      .execute = execute_agreement};
}

}  // namespace lobe::cli
