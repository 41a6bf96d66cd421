#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interface/command.hpp"
#include "interface/dry_run.hpp"
#include "interface/last_words.hpp"
#include "interface/options.hpp"
#include "interface/ranks.hpp"
#include "interface/report.hpp"
#include "interface/session.hpp"
#include "interface/study_running.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/checkpoint.hpp"
#include "lobe/study/ranks.hpp"
#include "lobe/study/shard.hpp"
#include "lobe/study/study.hpp"
#include "lobe/study/study_plan.hpp"

namespace lobe::cli {
namespace {

constexpr Flag kDryRun{"dry-run"};
constexpr Text kName{"name"};
constexpr Count kRanks{"ranks"};
constexpr Text kShard{"shard"};
constexpr Text kStudy{"STUDY"};

namespace fs = std::filesystem;

StudyRequest run_request(const Session& session) {
  const auto& arguments = session.arguments();
  StudyRequest request{.path = arguments.text(kStudy),
                       .set = {},
                       .name = arguments.text(kName),
                       .tolerance = {},
                       .precision = {},
                       .is_strict = arguments.has(option::strict),
                       .command = words_for_any_output(session.words())};
  const auto set = arguments.texts(option::set);
  request.set.assign(set.begin(), set.end());
  if (arguments.has(option::tolerance)) request.tolerance = session.tolerance(0);
  if (arguments.has(option::precision)) request.precision = session.precision();
  return request;
}

/// Computes a study. Its checkpoint stays if the work is interrupted, and is removed if it fails: it would fail again.
StudyResult compute(Session& session, const Device& device, const Study& study, Checkpoint& checkpoint) {
  if (session.arguments().has(option::no_checkpoint)) return run_study(device, study, session.progress());
  std::optional<std::size_t> noted;
  const auto noting = [&, progress = session.progress()](std::string_view stage, double fraction) {
    if (noted != checkpoint.kept()) {
      const std::string where = fmt::format("{} in {}", checkpoint.kept(), checkpoint.path().string());
      if (!noted && checkpoint.kept() > 0) session.state("goes on from the results kept: " + where);
      if (checkpoint.kept() > 0)
        InterruptWatch::note("results kept: " + where + "; the same command goes on from there");
      noted = checkpoint.kept();
    }
    return progress(stage, fraction);
  };
  return run_study(device, study, checkpoint, noting);
}

/// The ranks of a run, where it has several. Rank 0 sends the others away if it ends before it has work for them.
class Crew {
 public:
  explicit Crew(std::unique_ptr<Ranks> ranks) : ranks_(std::move(ranks)) {}
  ~Crew() {
    if (ranks_ != nullptr && !has_left_) dismiss_ranks(*ranks_);
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  [[nodiscard]] bool has_others() const { return ranks_ != nullptr; }
  [[nodiscard]] bool is_helper() const { return ranks_ != nullptr && ranks_->rank() > 0; }
  /// The ranks, which leave in what they are passed to.
  [[nodiscard]] Ranks& leaving() {
    has_left_ = true;
    return *ranks_;
  }

 private:
  std::unique_ptr<Ranks> ranks_;
  bool has_left_ = false;
};

/// Computes a study with other ranks or on several devices.
/// \param run run_study() for these
StudyResult compute_together(Session& session, Checkpoint& checkpoint,
                             const std::function<StudyResult(Checkpoint*, const CrewOptions&)>& run) {
  const bool keeps = !session.arguments().has(option::no_checkpoint);
  bool is_noted = false;
  CrewOptions options;
  options.progress = session.progress();
  options.kept = [&](std::size_t kept) {
    const std::string where = fmt::format("{} in {}", kept, checkpoint.path().string());
    if (kept > 0) InterruptWatch::note("results kept: " + where + "; the same command goes on from there");
    if (!is_noted && kept > 0) session.state("goes on from the results kept: " + where);
    is_noted = true;
  };
  options.done = [&](const RankTraffic& traffic) {
    session.remark(fmt::format("together: {} of {} units by others, {} bytes received, {} sent\n",
                               traffic.units_of_others, traffic.units, traffic.received_bytes, traffic.sent_bytes));
  };
  leave_threads_behind();
  try {
    return run(keeps ? &checkpoint : nullptr, options);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    // A launcher that has lost a rank ends the others by a signal, which is not the reason.
    InterruptWatch::note(error.what());
    throw;
  }
}

/// What a shard would compute.
void list_units(Session& session, const Study& study, const Shard& shard) {
  const auto units = deal_study(session.choose_device(), study, shard.count, session.progress());
  session.end_progress();
  double share = 0;
  Json list = Json::array();
  std::string text;
  for (const DealtUnit& unit : units) {
    if (unit.shard != shard.index) continue;
    share += unit.share;
    list.push_back(unit.name);
    text += unit.name + "\n";
  }
  if (session.wants_json()) {
    Json answer = json_answer("run");
    answer["study"] = study.name;
    answer["shard"] = shard.index;
    answer["shards"] = shard.count;
    answer["units"] = list;
    answer["all_units"] = units.size();
    answer["estimated_share"] = share;
    session.print_json(answer);
    return;
  }
  session.print(text + fmt::format("shard {} of {}: {} of {} units, about {:.1f} % of the work\n", to_string(shard),
                                   study.name, list.size(), units.size(), 100 * share));
}

ExitCode execute_shard(Session& session, const StudyRequest& request, const Study& study, const fs::path& output) {
  const auto& arguments = session.arguments();
  const Shard shard = parse_shard(arguments.text(kShard));
  if (arguments.has(kDryRun)) {
    list_units(session, study, shard);
    return ExitCode::success;
  }
  StudyRequest anywhere = request;  // shards and the merge may be run in different folders
  anywhere.path = fs::absolute(request.path).lexically_normal().string();
  const OutputDirectory directory(output);  // its lock will tell whether it can be written
  const bool keeps = !arguments.has(option::no_checkpoint);
  if (keeps) InterruptWatch::note("units that are done are kept; the same command goes on from there");
  const ShardReport report = run_shard(session.choose_device(), study, shard, directory.path(),
                                       {.overwrite = arguments.has(option::force),
                                        .keeps_units = keeps,
                                        .request = to_json(anywhere).dump(),
                                        .progress = session.progress()});
  session.end_progress();
  if (report.was_complete) {
    session.state(fmt::format("shard {} is complete: {}", to_string(shard), report.file.string()));
  } else if (report.kept > 0) {
    session.state(fmt::format("went on from {} of {} units, which were kept", report.kept, report.units));
  }
  if (session.wants_json()) {
    Json answer = json_answer("run");
    answer["study"] = study.name;
    answer["shard"] = shard.index;
    answer["shards"] = shard.count;
    answer["units"] = report.units;
    answer["kept_units"] = report.kept;
    answer["was_complete"] = report.was_complete;
    answer["file"] = report.file.string();
    session.print_json(answer);
  } else {
    session.print(report.file.string() + "\n");
  }
  return ExitCode::success;
}

ExitCode execute_run(Session& session) {
  const auto& arguments = session.arguments();
  const bool overwrite = arguments.has(option::force);
  const StudyRequest request = run_request(session);
  if (arguments.has(kRanks) && (!arguments.has(kDryRun) || arguments.has(kShard))) {
    throw ArgumentError("--ranks belongs to --dry-run, without --shard; 'mpirun -n N lobe run' starts N ranks");
  }
  Crew crew(arguments.has(kShard) ? nullptr : join_ranks());
  if (crew.is_helper()) {
    leave_threads_behind();
    help_run_study(
        session.device(), [&] { return requested_study(request).study; }, crew.leaving(),
        [](std::string_view, double) { return !InterruptWatch::interrupted(); });
    return ExitCode::success;
  }
  const RequestedStudy requested = requested_study(request);
  const Study& study = requested.study;
  const fs::path output = arguments.has(option::output) ? fs::path(arguments.text(option::output)) : fs::path(".");
  const std::vector<Device> devices = session.devices();
  if (devices.size() > 1 && (crew.has_others() || arguments.has(kShard) || arguments.has(kDryRun))) {
    throw ArgumentError("ranks, --shard and --dry-run take one device each, and several are named; name one");
  }
  if (arguments.has(kShard)) return execute_shard(session, request, study, output);
  if (arguments.has(kDryRun)) {
    require_writable(output);
    dry_run(session, study, output, overwrite ? fs::path() : existing_file(study, output),
            arguments.has(kRanks) ? std::optional(arguments.count(kRanks, kMostRanks)) : std::nullopt);
    return ExitCode::success;
  }
  const StudyPlace place(session, study, output, overwrite, "--name");
  if (devices.size() == 1) static_cast<void>(session.choose_device());

  Checkpoint checkpoint(place.path() / (study.name + ".checkpoint"));
  const auto run = [&] {
    if (crew.has_others()) {
      return compute_together(session, checkpoint, [&](Checkpoint* kept, const CrewOptions& options) {
        return run_study(devices.front(), study, kept, crew.leaving(), options);
      });
    }
    if (devices.size() > 1) {
      return compute_together(session, checkpoint, [&](Checkpoint* kept, const CrewOptions& options) {
        return run_study(devices, study, kept, options);
      });
    }
    return compute(session, devices.front(), study, checkpoint);
  };
  StudyResult result = run();
  return finish_study(session, result, place,
                      {.command = "run",
                       .command_line = session.command_line(),
                       .wants_errors = arguments.has(option::tolerance),
                       .allows_unresolved = requested.allows_unresolved,
                       .when_written = [&] { checkpoint.remove(); }});
}

}  // namespace

Command run_command() {
  return {
      .name = "run",
      .group = "Studies",
      .summary = "compute a study: distances, printed figures, charts",
      .description =
          "Computes what a study file asks for and prints the names of the files that it writes: NAME.h5 with "
          "everything, tables as NAME.<lighting>.distance.csv, .medoids.csv and .neighbours.csv, pictures with the "
          "gnuplot scripts that made them, and charts as NAME.chart.<name>.csv and .png. After an empty line it "
          "prints, if the study asks for these, the materials that stand for all under each lighting, which families "
          "represent how many materials best, and which metrics rank pairs most alike. It lists the published figures "
          "that miss what the study expects; the exit status is 1 if there are any. Files appear complete or not at "
          "all. During long studies NAME.checkpoint keeps what is done: after Ctrl-C, or any other end, the same "
          "command continues from there. With --shard I/N it computes one of N parts and writes nothing but "
          "NAME.I-of-N.shard, for 'lobe merge': the processes of a job array need nothing from each other but the "
          "folder. Processes that mpirun starts together share the work, if lobe was built with MPI, and so do several "
          "devices of one kind (--device 0:0,0:1); the files have the same bytes.",
      .positionals = {{.handle = kStudy, .help = "study file (.toml)"}},
      .options = {{.handle = option::output,
                   .letter = 'o',
                   .value = "DIR",
                   .help = "directory for the files, created if missing (default: the current one)"},
                  {.handle = option::force, .letter = 'f', .help = "replace existing files"},
                  {.handle = kName, .value = "NAME", .help = "stem of the file names (default: the study's name)"},
                  set_option(),
                  {.handle = kShard,
                   .value = "I/N",
                   .help = "compute shard I of N (1/8 to 8/8) into a file for 'lobe merge'; with --dry-run list its "
                           "units"},
                  {.handle = kDryRun,
                   .help = "only print what the run would need and write: materials, stages, time, memory, files; the "
                           "time is extrapolated, within seconds, from some of the materials"},
                  {.handle = kRanks,
                   .value = "N",
                   .help = "with --dry-run say also what N ranks of MPI would need: time, memory, bytes moved"},
                  {.handle = option::no_checkpoint, .help = "neither write a checkpoint nor continue from one"},
                  tolerance_option("largest relative error of the scalar products (default: the study's)"),
                  strict_option(),
                  json_option()},
      .examples = {{"what a run needs", "lobe run studies/classical-families.toml -o out --dry-run"},
                   {"some sixty materials of the classical families",
                    "lobe run studies/classical-families.toml -o out"},
                   {"the same, quickly and roughly",
                    "lobe run studies/classical-families.toml -o out --name rough --tolerance 1e-3"},
                   {"the second of four shards, as one job of an array",
                    "lobe run studies/classical-families.toml --shard 2/4 -o shards"}},
      .execute = execute_run};
}

}  // namespace lobe::cli
