#include "interface/study_running.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <numeric>
#include <system_error>
#include <utility>

#include "core/shell.hpp"
#include "core/text.hpp"
#include "interface/measuring.hpp"
#include "interface/options.hpp"
#include "interface/study_report.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/file_set.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/study/study_results.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kMega = 1e6;

/// \param other the option by which results go elsewhere
/// \throws IoError when a file of the study exists and may not be replaced.
void require_absent(const Study& study, const fs::path& directory, bool overwrite, std::string_view other) {
  const fs::path existing = overwrite ? fs::path() : existing_file(study, directory);
  if (!existing.empty()) {
    throw IoError(existing.string() + " exists; use --force to replace it, or give another " + std::string(other));
  }
}

[[noreturn]] void fail_to_make(const fs::path& directory, std::error_code code) {
  throw IoError(
      fmt::format("cannot create directory {}: {}; give another by --output", directory.string(), code.message()));
}

[[noreturn]] void fail_to_write(const fs::path& directory, std::error_code code) {
  throw IoError(
      fmt::format("cannot write into directory {}: {}; give another by --output", directory.string(), code.message()));
}

std::string stage_table(const std::vector<StageTime>& stages) {
  const double total = std::accumulate(stages.begin(), stages.end(), 0.0,
                                       [](double sum, const StageTime& stage) { return sum + stage.seconds; });
  std::vector<std::vector<std::string>> rows{{"stage", "seconds", "share/%"}};
  const auto add = [&](std::string_view name, double seconds) {
    rows.push_back({std::string(name), fmt::format("{:.3f}", seconds),
                    fmt::format("{:.1f}", total > 0 ? 100 * seconds / total : 0)});
  };
  for (const auto& stage : stages) add(stage.stage, stage.seconds);
  add("total", total);
  return format_table(rows, 1, false);
}

std::string work_table(const StudyResult& result) {
  std::vector<std::vector<std::string>> rows{{"metric", "nodes", "evaluations", "Mevaluations/s"}};
  const auto add = [&](std::string name, const WorkDone& work) {
    const double rate = work.seconds_values > 0 ? static_cast<double>(work.evaluations) / work.seconds_values : 0;
    rows.push_back({std::move(name), std::to_string(work.nodes), std::to_string(work.evaluations),
                    fmt::format("{:.1f}", rate / kMega)});
  };
  for (const auto& metric : result.metrics) add(metric.lighting.name(), metric.work);
  for (const auto& comparison : result.comparisons) add(std::string(to_string(comparison.metric)), comparison.work);
  return format_table(rows, 1, false);
}

Json paths_json(const std::vector<fs::path>& paths) {
  Json json = Json::array();
  for (const auto& path : paths) json.push_back(path.string());
  return json;
}

/// Albedos of charts.
Json missed_json(const std::vector<MissedTolerance>& list) {
  Json json = Json::array();
  for (const auto& missed : list) {
    json.push_back({{"quantity", missed.quantity},
                    {"relative_error", to_json(missed.relative_error)},
                    {"tolerance", missed.tolerance}});
  }
  return json;
}

/// Where in the study's files what is in the results stands.
Json origins_json(const Study& study) {
  Json json{{"materials", Json::array()}, {"charts", Json::array()}};
  for (std::size_t i = 0; i < study.origins.materials.size(); ++i) {
    json["materials"].push_back(
        {{"material", study.materials[i].name()}, {"origin", to_string(study.origins.materials[i])}});
  }
  for (std::size_t i = 0; i < study.origins.charts.size(); ++i) {
    json["charts"].push_back({{"chart", study.charts[i].name}, {"origin", to_string(study.origins.charts[i])}});
  }
  return json;
}

Json answer_json(const StudyResult& result, const StudyFiles& files, const std::string& command) {
  const Study& study = result.study;
  Json answer = json_answer(command);
  answer["study"] = study.name;
  answer["title"] = study.title;
  answer["materials"] = study.materials.size();
  answer["channels"] = study.channels;
  answer["tolerance"] = study.tolerance;
  answer["precision"] = to_string(study.precision);
  answer["units"] = {{"seconds", "s"},
                     {"relative_error", "1"},
                     {"explained_share", "1"},
                     {"mean_silhouette", "1"},
                     {"cophenetic_correlation", "1"}};
  answer["lightings"] = Json::array();
  for (std::size_t i = 0; i < result.metrics.size(); ++i) {
    const auto& metric = result.metrics[i];
    Json entry{{"lighting", metric.lighting.name()}, {"origin", to_string(study.origins.lightings.at(i))}};
    if (i < result.embeddings.size()) entry["explained_share"] = to_json(result.embeddings[i].explained_share);
    entry["clusters"] = clusters_json(study, result.clusterings.at(i));
    entry["nodes"] = metric.work.nodes;
    entry["evaluations"] = metric.work.evaluations;
    entry["unresolved"] = unresolved_json(study, metric.unresolved);
    if (!study.approximations.empty()) entry["approximations"] = approximations_json(result, i);
    answer["lightings"].push_back(std::move(entry));
  }
  if (!result.comparisons.empty()) answer["comparison_metrics"] = comparisons_json(result);
  if (!result.agreement.metrics.empty()) answer["agreement"] = agreement_json(result.agreement);
  if (!result.published.empty()) answer["published"] = published_json(result);
  answer["missed_tolerances"] = missed_json(result.missed);
  answer["origins"] = origins_json(study);
  answer["files"] = {{"table", files.table.string()},
                     {"csv", paths_json(files.csv)},
                     {"pages", paths_json(files.pages)},
                     {"pictures", paths_json(files.pictures)},
                     {"scripts", paths_json(files.scripts)}};
  answer["note"] = files.note;
  answer["stages"] = Json::array();
  for (const auto& stage : result.stages) {
    answer["stages"].push_back({{"stage", stage.stage}, {"seconds", to_json(stage.seconds)}});
  }
  answer["device"] = to_json(result.device);
  return answer;
}

std::string file_list(const StudyFiles& files) {
  std::string text = files.table.string() + "\n";
  for (const auto* group : {&files.csv, &files.pages, &files.pictures, &files.scripts}) {
    for (const auto& path : *group) text += path.string() + "\n";
  }
  return text;
}

/// Metrics of the literature leave a few pairs behind on purpose: one line for all of them.
void warn_of_outliers(Session& session, const LiteratureResult& result, double tolerance) {
  if (result.unresolved.empty()) return;
  session.warn(
      fmt::format("{}: {} of the distances reached relative errors of up to {:.2g} instead of {}; the result holds "
                  "the error of each",
                  to_string(result.metric), result.unresolved.size(), result.unresolved.front().relative_error,
                  shortest(tolerance)));
}

/// Products and albedos that miss the tolerance.
/// \throws as Session::note_missed().
void note_missed(Session& session, const StudyResult& result, bool wants_errors) {
  std::vector<std::string> names;
  for (const auto& material : result.study.materials) names.push_back(material.name());
  for (const auto& metric : result.metrics) {
    note_unresolved(session, metric, names);
    const bool is_wanted = wants_errors && metric.route != Route::formulas;
    if (is_wanted) note_errors(session, metric, names);
  }
  for (const auto& missed : result.missed) session.note_missed(missed);
}

/// Notes materials that the study's grid does not resolve, which --strict refuses.
void note_coarse(Session& session, const StudyResult& result) {
  for (const auto& metric : result.metrics) {
    for (const std::size_t i : metric.coarse) session.note_coarse(*metric.grid, result.study.materials[i].name());
  }
}

}  // namespace

Json to_json(const StudyRequest& request) {
  Json json{{"study", request.path}, {"set", request.set}, {"name", request.name}, {"strict", request.is_strict}};
  if (request.tolerance) json["tolerance"] = *request.tolerance;
  if (request.precision) json["precision"] = to_string(*request.precision);
  json["command"] = request.command;
  return json;
}

StudyRequest study_request(const std::string& text) {
  const auto json = Json::parse(text, nullptr, false);
  try {
    StudyRequest request{.path = json.at("study").get<std::string>(),
                         .set = json.at("set").get<std::vector<std::string>>(),
                         .name = json.at("name").get<std::string>(),
                         .tolerance = {},
                         .precision = {},
                         .is_strict = json.at("strict").get<bool>(),
                         .command = json.at("command").get<std::vector<std::string>>()};
    if (json.contains("tolerance")) request.tolerance = json.at("tolerance").get<double>();
    if (json.contains("precision")) {
      request.precision = json.at("precision").get<std::string>() == "single" ? Precision::single_precision
                                                                              : Precision::double_precision;
    }
    return request;
  } catch (const Json::exception&) {
    throw IoError("these shards were not written by 'lobe run', and do not say how their study was asked for");
  }
}

std::vector<std::string> words_for_any_output(const std::vector<std::string>& words) {
  std::vector<std::string> kept;
  const std::string place(1, kPlaceOfOutput);
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string& word = words[k];
    if (word == "--shard") {
      ++k;
    } else if (word == "-o" || word == "--output") {
      kept.push_back(word);
      kept.push_back(place);
      ++k;
    } else if (word.starts_with("--output=")) {
      kept.push_back("--output=" + place);
    } else if (word.starts_with("-o") && word.size() > 2) {
      kept.push_back("-o" + place);
    } else if (!word.starts_with("--shard=") && word != "--force" && word != "-f") {
      kept.push_back(word);
    }
  }
  return kept;
}

std::string plain_command_line(const StudyRequest& request, const std::string& output) {
  std::vector<std::string> words;
  bool has_output = false;
  for (std::string word : request.command) {
    const std::size_t place = word.find(kPlaceOfOutput);
    if (place == word.npos) {
      words.push_back(std::move(word));
      continue;
    }
    has_output = true;
    if (!output.empty()) {
      words.push_back(word.replace(place, 1, output));
    } else if (place == 0) {
      words.pop_back();  // its option
    }
  }
  if (!has_output && !output.empty()) words.insert(words.end(), {"-o", output});
  return command_line_of(words);
}

RequestedStudy requested_study(const StudyRequest& request) {
  const std::string& path = request.path;
  if (is_table_file(path)) throw ArgumentError(path + " is a table; expected a study file (.toml)");
  if (is_study_results(path)) {
    throw ArgumentError(
        fmt::format("{} holds results of a study; expected the study file (.toml), which 'lobe info {} --study' prints",
                    path, shell_word(path)));
  }
  Study study = load_study(path, request.set);
  if (request.tolerance) {
    study.tolerance = study.patch_tolerance = study.function_tolerance = *request.tolerance;
  }
  study.precision = request.precision.value_or(study.precision);
  if (!request.name.empty()) study.name = request.name;
  if (study.name.find('/') != std::string::npos || study.name == "." || study.name == "..") {
    throw ArgumentError("'" + study.name + "' cannot be the stem of file names; choose a --name without '/'");
  }
  const bool is_allowed = study.allow_unresolved;
  study.allow_unresolved = is_allowed || !request.is_strict;
  return {std::move(study), is_allowed};
}

fs::path existing_file(const Study& study, const fs::path& directory) {
  std::vector<std::string> names = csv_names(study);
  const std::vector<std::string> pages = page_names(study);
  names.insert(names.end(), pages.begin(), pages.end());
  names.insert(names.begin(), study.name + ".h5");
  const auto exists = [&](const std::string& name) {
    std::error_code ignored;
    return fs::exists(directory / name, ignored);
  };
  const auto found = std::ranges::find_if(names, exists);
  return found == names.end() ? fs::path() : directory / *found;
}

void require_writable(const fs::path& directory) {
  std::error_code code;
  fs::path there = fs::absolute(directory);
  while (!fs::exists(fs::symlink_status(there, code)) && there.has_relative_path()) there = there.parent_path();
  const bool is_made = there != fs::absolute(directory);
  if (!fs::is_directory(there, code)) fail_to_make(directory, std::make_error_code(std::errc::not_a_directory));
  if (::access(there.c_str(), W_OK | X_OK) == 0) return;
  code = {errno, std::generic_category()};
  is_made ? fail_to_make(directory, code) : fail_to_write(directory, code);
}

OutputDirectory::OutputDirectory(fs::path path) : path_(std::move(path)) {
  std::error_code code;
  for (fs::path part = fs::absolute(path_); !fs::exists(fs::symlink_status(part, code)) && part.has_relative_path();
       part = part.parent_path()) {
    made_.push_back(part);
  }
  fs::create_directories(path_, code);
  if (code) {
    remove_empty();
    fail_to_make(path_, code);
  }
}

void OutputDirectory::check() const {
  // A file without a name leaves nothing behind when the process is killed; some file systems have none.
  const int nameless = ::open(path_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (nameless >= 0) {
    ::close(nameless);
    return;
  }
  if (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT) {
    fail_to_write(path_, {errno, std::generic_category()});
  }
  std::string probe = (path_ / ".lobe-XXXXXX").string();
  const int descriptor = ::mkstemp(probe.data());
  if (descriptor < 0) fail_to_write(path_, {errno, std::generic_category()});
  ::close(descriptor);
  ::unlink(probe.c_str());
}

void OutputDirectory::remove_empty() const {
  std::error_code ignored;
  for (const auto& part : made_) fs::remove(part, ignored);
}

StudyPlace::StudyPlace(const Session& session, const Study& study, const fs::path& directory, bool overwrite,
                       std::string_view other)
    : directory_(directory) {
  directory_.check();
  lock_ = OutputLock(directory_.path() / study.name, session.command_line());
  finish_killed(directory_.path(), study.name);
  replaces_ = overwrite || lock_.goes_on();
  require_absent(study, directory_.path(), replaces_, other);
}

ExitCode finish_study(Session& session, StudyResult& result, const StudyPlace& place, const StudyEnding& ending) {
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  session.end_progress();
  note_missed(session, result, ending.wants_errors);
  if (!ending.allows_unresolved) note_coarse(session, result);
  const auto writing_began = std::chrono::steady_clock::now();
  InterruptWatch::note("files that are there are complete, pictures may be missing");
  const auto files =
      write_study(result, place.path(),
                  {.overwrite = place.replaces(), .command_line = ending.command_line, .progress = session.progress()});
  const std::chrono::duration<double> writing = std::chrono::steady_clock::now() - writing_began;
  session.end_progress();
  Session::hold(place.lock());
  ending.when_written();
  if (InterruptWatch::interrupted()) {
    InterruptWatch::note(fmt::format("the numbers are complete in {}; {}", files.table.string(),
                                     files.note.empty() ? "so are the pictures" : files.note));
    throw Cancelled("interrupted");
  }
  result.stages.push_back({"files and pictures", writing.count()});

  for (const auto& comparison : result.comparisons) {
    warn_of_outliers(session, comparison, result.study.comparison_tolerance);
  }
  if (!files.note.empty()) session.warn(files.note);
  session.remark(stage_table(result.stages) + "\n" + work_table(result));
  if (session.wants_json()) {
    Json answer = answer_json(result, files, ending.command);
    ending.add(answer);
    session.print_json(answer);
  } else {
    session.print(file_list(files) + "\n" + medoid_lines(result) + approximation_lines(result) +
                  agreement_lines(result.agreement) + published_lines(result));
  }
  const bool is_as_expected = std::ranges::all_of(result.published, &PublishedCheck::is_as_expected);
  return is_as_expected ? ExitCode::success : ExitCode::negative;
}

}  // namespace lobe::cli
