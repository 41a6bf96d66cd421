#include "interface/dry_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "interface/memory.hpp"
#include "interface/options.hpp"
#include "interface/report.hpp"
#include "interface/terminal.hpp"
#include "lobe/study/checkpoint.hpp"
#include "lobe/study/study_plan.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

/// A time that is not known well.
std::string time_text(double seconds) {
  constexpr double kMinute = 60;
  constexpr double kHour = 3600;
  if (seconds >= 2 * kHour) return fmt::format("{:.2g} h", seconds / kHour);
  if (seconds >= 2 * kMinute) return fmt::format("{:.0f} min", seconds / kMinute);
  if (seconds >= 10) return fmt::format("{:.0f} s", seconds);
  return fmt::format("{:.1f} s", seconds);
}

std::string range_text(const StudyPlan& plan) {
  if (std::isinf(plan.seconds_high)) {
    return fmt::format("more than {}: a few of the materials alone take longer", time_text(plan.seconds_low));
  }
  const std::string tried =
      plan.materials == 0 ? "" : fmt::format(", from {} of {} materials", plan.tried, plan.materials);
  return fmt::format("about {}, between {} and {}{}", time_text(plan.seconds), time_text(plan.seconds_low),
                     time_text(plan.seconds_high), tried);
}

std::string family_text(const StudyPlan& plan) {
  std::string text;
  for (const auto& [family, count] : plan.families) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", family, count);
  }
  return text;
}

std::string how(const PlannedStage& stage) {
  if (stage.is_kept) return "kept by the checkpoint";
  if (stage.nodes == 0) return stage.method;
  return fmt::format("{}; {} nodes or more", stage.method, stage.nodes);
}

/// Whether it says how long the study takes.
bool has_times(const StudyPlan& plan) {
  return plan.tried > 0 || plan.materials == 0;
}

/// Lines on ranks, each with a machine of its own.
std::string ranks_text(const StudyPlan& plan, const RankPlan& ranks, std::uint64_t present) {
  const auto line = [](std::string_view name, const std::string& text) {
    return fmt::format("{:<11} {}\n", name, text);
  };
  std::string text =
      line("ranks", fmt::format("{}, each on a machine like this one, for {} units", ranks.ranks, ranks.units));
  if (has_times(plan)) {
    text += line("", fmt::format("about {}, of these {} for what is not shared", time_text(ranks.seconds),
                                 time_text(ranks.alone_seconds)));
  }
  if (!ranks.longest_unit.empty()) {
    text +=
        line("", fmt::format("the longest unit takes {}: {}", time_text(ranks.longest_seconds), ranks.longest_unit));
  }
  text +=
      line("", fmt::format("memory of rank 0 about {}{}", bytes_text(present + ranks.first_bytes),
                           ranks.other_bytes == 0 ? "" : ", of each other " + bytes_text(present + ranks.other_bytes)));
  text += line("", fmt::format("results of up to {}, about {} of them move to rank 0", bytes_text(ranks.all_bytes),
                               bytes_text(ranks.moved_bytes)));
  return text;
}

Json ranks_json(const StudyPlan& plan, const RankPlan& ranks, std::uint64_t present) {
  const bool is_known = has_times(plan);
  return {{"count", ranks.ranks},
          {"units", ranks.units},
          {"seconds", is_known ? to_json(ranks.seconds) : Json()},
          {"alone_seconds", is_known ? to_json(ranks.alone_seconds) : Json()},
          {"longest_unit", ranks.longest_unit.empty() ? Json() : Json(ranks.longest_unit)},
          {"longest_seconds", is_known ? to_json(ranks.longest_seconds) : Json()},
          {"rank_0_bytes", present + ranks.first_bytes},
          {"other_rank_bytes", ranks.other_bytes == 0 ? Json() : Json(present + ranks.other_bytes)},
          {"moved_bytes", ranks.moved_bytes},
          {"all_bytes", ranks.all_bytes}};
}

std::string plan_text(const Session& session, const Study& study, const StudyPlan& plan, const Device& device,
                      const fs::path& directory, std::uint64_t peak_bytes, std::size_t kept) {
  const DeviceInfo info = device.info();
  const auto line = [](std::string_view name, std::string_view text) { return fmt::format("{:<11} {}\n", name, text); };
  std::string text = line("study", study.title == study.name ? study.name : study.name + ": " + study.title);
  text += line("device", fmt::format("{}, {} precision", info.name, to_string(study.precision)));
  if (plan.materials > 0) {
    text += line("materials", fmt::format("{} ({}), {} pairs", plan.materials, family_text(plan), plan.pairs));
  }
  if (study.channels.size() > 1) text += line("channels", std::to_string(study.channels.size()));
  if (!study.published.empty()) text += line("figures", std::to_string(study.published.size()));
  text += "\n";
  std::vector<std::vector<std::string>> rows{{"stage", "seconds", "how"}};
  for (const auto& stage : plan.stages) {
    rows.push_back({stage.name, stage.is_kept ? "-" : fmt::format("{:.2g}", stage.seconds), how(stage)});
  }
  text += format_table(rows, 3, session.colors_output()) + "\n";
  text += line("time", range_text(plan));
  text +=
      line("memory", fmt::format("about {} of {}", bytes_text(peak_bytes), bytes_text(machine_memory().total_bytes)));
  text += line("checkpoint", kept == 0 ? "none to go on from" : fmt::format("goes on from {} results", kept));
  text += line("files", fmt::format("{} tables and pages, {} pictures", plan.files.size(), plan.pictures.size()));
  for (const auto* names : {&plan.files, &plan.pictures}) {
    for (const auto& name : *names) text += "  " + (directory / name).string() + "\n";
  }
  return text;
}

Json plan_json(const Study& study, const StudyPlan& plan, const Device& device, const fs::path& directory,
               std::uint64_t peak_bytes, std::size_t kept) {
  Json answer = json_answer("run-plan");
  answer["study"] = study.name;
  answer["title"] = study.title;
  answer["materials"] = plan.materials;
  answer["pairs"] = plan.pairs;
  answer["families"] = Json::array();
  for (const auto& [family, count] : plan.families) {
    answer["families"].push_back({{"family", family}, {"materials", count}});
  }
  answer["channels"] = study.channels;
  answer["tolerance"] = study.tolerance;
  answer["precision"] = to_string(study.precision);
  answer["units"] = {{"seconds", "s"}, {"peak_bytes", "byte"}};
  answer["seconds"] = {{"expected", has_times(plan) ? to_json(plan.seconds) : Json()},
                       {"at_least", to_json(plan.seconds_low)},
                       {"at_most", std::isinf(plan.seconds_high) ? Json() : to_json(plan.seconds_high)},
                       {"tried_materials", plan.tried}};
  answer["stages"] = Json::array();
  for (const auto& stage : plan.stages) {
    Json entry{{"stage", stage.name}, {"seconds", to_json(stage.seconds)}};
    if (!stage.method.empty()) entry["method"] = stage.method;
    if (stage.nodes > 0) entry["nodes_at_least"] = stage.nodes;
    entry["kept"] = stage.is_kept;
    answer["stages"].push_back(std::move(entry));
  }
  answer["peak_bytes"] = peak_bytes;
  answer["checkpoint"] = kept > 0;
  answer["files"] = Json::array();
  for (const auto* names : {&plan.files, &plan.pictures}) {
    for (const auto& name : *names) answer["files"].push_back((directory / name).string());
  }
  answer["device"] = to_json(device.info());
  return answer;
}

}  // namespace

void dry_run(Session& session, const Study& study, const fs::path& directory, const fs::path& existing,
             std::optional<std::size_t> ranks) {
  const Device device = session.choose_device();
  Checkpoint checkpoint(directory / (study.name + ".checkpoint"));
  const bool takes_checkpoint = !session.arguments().has(option::no_checkpoint);
  if (takes_checkpoint) checkpoint.open(study, device);
  const StudyPlan plan = plan_study(
      device, study, {.checkpoint = takes_checkpoint ? &checkpoint : nullptr, .progress = session.progress()});
  const std::uint64_t present = resident_bytes();
  const auto crew = ranks ? std::optional(plan_ranks(device, study, plan, *ranks, session.progress())) : std::nullopt;
  session.end_progress();
  const std::uint64_t peak = present + plan.work_bytes;
  const std::size_t kept = takes_checkpoint ? checkpoint.kept() : 0;
  if (session.wants_json()) {
    Json answer = plan_json(study, plan, device, directory, peak, kept);
    if (crew) answer["ranks"] = ranks_json(plan, *crew, present);
    answer["existing"] = existing.empty() ? Json() : Json(existing.string());
    session.print_json(answer);
    return;
  }
  session.print(plan_text(session, study, plan, device, directory, peak, kept) +
                (crew ? ranks_text(plan, *crew, present) : ""));
  if (!existing.empty())
    session.warn(existing.string() + " exists; the run needs --force to replace it, or another --name");
}

}  // namespace lobe::cli
