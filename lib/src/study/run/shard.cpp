#include "lobe/study/shard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "core/file_set.hpp"
#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/output_lock.hpp"
#include "study/run/completed_study.hpp"
#include "study/run/record_file.hpp"
#include "study/run/shard_file.hpp"
#include "study/run/study_computation.hpp"
#include "study/run/study_identity.hpp"
#include "study/run/study_units.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kShardEnding = ".shard";

/// 0 where it is no whole number.
std::size_t whole_number(std::string_view text) {
  std::size_t number = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  return failed != std::errc() || end != text.data() + text.size() ? 0 : number;
}

/// By what a shard is not one of those that are expected; empty where it is.
std::string foreignness(const PlanIdentity& found, const PlanIdentity& expected) {
  if (found.version != expected.version) {
    return fmt::format("was computed by lobe {}, and this is lobe {}", found.version, expected.version);
  }
  if (found.build != expected.build) return fmt::format("was computed by another build of lobe {}", found.version);
  if (found.plan != expected.plan) {
    return "is a shard of another study, or of this one before its text, its files or its options changed";
  }
  if (found.device != expected.device) {
    return fmt::format("was computed on {}, and this is {}", found.device, expected.device);
  }
  return {};
}

/// Records of a shard: in memory and, until it is complete, in a file.
class ShardRecords {
 public:
  /// \param file none: records are in memory alone
  explicit ShardRecords(RecordFile* file) : file_(file) {}

  /// Says which units the shard has; before, it knows nothing and keeps nothing.
  void choose(std::set<std::string> names) {
    names_ = std::move(names);
    if (file_ == nullptr) return;
    for (const auto& [name, content] : file_->records()) {
      if (names_.contains(name)) all_.emplace(name, content);
    }
  }
  [[nodiscard]] const std::map<std::string, std::string, std::less<>>& all() const { return all_; }
  [[nodiscard]] UnitStore store() {
    return {.has = [this](const std::string& name) { return all_.contains(name); },
            .get = [this](const std::string& name) { return all_.at(name); },
            .is_worth_keeping = [this](const std::string& name, double) { return names_.contains(name); },
            .keep =
                [this](const std::string& name, const std::string& content) {
                  all_.insert_or_assign(name, content);
                  if (file_ != nullptr) file_->keep(name, content);
                }};
  }

 private:
  RecordFile* file_;
  std::set<std::string> names_;
  std::map<std::string, std::string, std::less<>> all_;
};

/// "2, 5 to 9 and 11"
std::string number_list(const std::vector<std::size_t>& numbers) {
  std::vector<std::string> runs;
  for (std::size_t k = 0; k < numbers.size();) {
    std::size_t last = k;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    const bool is_run = last > k + 1;
    if (!is_run) last = k;
    runs.push_back(is_run ? fmt::format("{} to {}", numbers[k], numbers[last]) : std::to_string(numbers[k]));
    k = last + 1;
  }
  std::string text;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == runs.size() ? " and " : ", ") + runs[k];
  }
  return text;
}

[[noreturn]] void refuse_shards(const std::string& what, const fs::path& path) {
  throw IoError(what, {.path = path.string()});
}

}  // namespace

Shard parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  const std::size_t index = whole_number(text.substr(0, slash));
  const std::size_t count = slash == std::string_view::npos ? 0 : whole_number(text.substr(slash + 1));
  if (index < 1 || index > count || count > kMostShards) {
    throw ArgumentError(
        fmt::format("'{}' is no shard; expected INDEX/COUNT, such as 1/8 for the first of eight (the "
                    "index from 1 on, and at most {} shards)",
                    text, kMostShards));
  }
  return {index, count};
}

std::string to_string(const Shard& shard) {
  return fmt::format("{}/{}", shard.index, shard.count);
}

std::string shard_stem(const Study& study, const Shard& shard) {
  return fmt::format("{}.{}-of-{}", study.name, shard.index, shard.count);
}

std::vector<DealtUnit> deal_study(const Device& device, const Study& study, std::size_t shards,
                                  const ProgressCallback& progress) {
  StudyComputation computation(device, study, UnitStore::none(), progress);
  const auto units = computation.units();
  const auto owners = dealt_units(units, shards);
  const double total = std::accumulate(units.begin(), units.end(), 0.0,
                                       [](double sum, const StudyUnit& unit) { return sum + unit.cost; });
  std::vector<DealtUnit> dealt;
  for (std::size_t u = 0; u < units.size(); ++u) {
    dealt.push_back({.name = units[u].name, .shard = owners[u] + 1, .share = units[u].cost / total});
  }
  return dealt;
}

ShardReport run_shard(const Device& device, const Study& study, const Shard& shard, const fs::path& directory,
                      const ShardOptions& options) {
  if (shard.index < 1 || shard.index > shard.count || shard.count > kMostShards) {
    throw ArgumentError(fmt::format("there is no shard {}", to_string(shard)));
  }
  make_directory(directory);
  const std::string stem = shard_stem(study, shard);
  ShardReport report;
  report.file = directory / (stem + std::string(kShardEnding));
  const OutputLock lock(directory / stem, "shard");
  const PlanIdentity identity = plan_identity(study, device);
  RecordFile checkpoint(directory / (stem + ".checkpoint"));
  if (options.keeps_units) checkpoint.open(identity.text(), study.materials.size());
  std::error_code ignored;
  if (!options.overwrite && fs::exists(report.file, ignored)) {
    const ShardFile file(report.file);
    std::string foreign = foreignness(file.head().identity, identity);
    if (foreign.empty() && to_string(file.head().shard) != to_string(shard)) {
      foreign = fmt::format("is shard {} under the name of shard {}", to_string(file.head().shard), to_string(shard));
    }
    if (!foreign.empty()) {
      throw IoError(fmt::format("{} exists and {}; expected leave to replace it, or another folder",
                                report.file.string(), foreign),
                    {.fault = Fault::existing_file, .path = report.file.string()});
    }
    checkpoint.remove();  // a run that was killed after it had written the shard left it
    report.was_complete = true;
    report.units = file.records();
    return report;
  }
  ShardRecords records(options.keeps_units ? &checkpoint : nullptr);
  StudyComputation computation(device, study, records.store(), options.progress);
  const auto units = computation.units();
  const auto owners = dealt_units(units, shard.count);
  std::vector<std::size_t> own;
  std::set<std::string> names;
  for (std::size_t u = 0; u < units.size(); ++u) {
    if (owners[u] + 1 != shard.index) continue;
    own.push_back(u);
    names.insert(units[u].name);
  }
  records.choose(std::move(names));
  report.units = own.size();
  report.all_units = units.size();
  report.kept = records.all().size();
  std::size_t done = 0;
  computation.compute(units, [&] { return done < own.size() ? std::optional(own[done++]) : std::nullopt; });
  const ShardHead head{.study = study.name, .shard = shard, .identity = identity, .request = options.request};
  write_text(report.file, options.overwrite, shard_text(head, records.all()));
  checkpoint.remove();
  return report;
}

struct ShardSet::Implementation {
  std::vector<ShardFile> files;  ///< by index
};

ShardSet ShardSet::find(const fs::path& directory, std::string_view name) {
  std::error_code code;
  if (!fs::is_directory(directory, code)) {
    if (!code) code = std::make_error_code(std::errc::not_a_directory);
    throw IoError("cannot read " + directory.string() + ": " + code.message() + "; expected the folder of the shards",
                  {.fault = fault_of(code), .path = directory.string()});
  }
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(directory, code)) {
    if (entry.path().extension() == kShardEnding) paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  const std::string own = std::string(name) + ".";
  std::vector<ShardFile> files;
  for (const auto& path : paths) {
    if (!name.empty() && !path.filename().string().starts_with(own)) continue;
    ShardFile file(path);
    if (name.empty() || file.head().study == name) files.push_back(std::move(file));
  }
  if (files.empty()) {
    const std::string of = name.empty() ? std::string() : fmt::format(" of '{}'", name);
    refuse_shards(
        fmt::format("{} holds no shard{}; expected files NAME.I-of-N{}", directory.string(), of, kShardEnding),
        directory);
  }
  for (const ShardFile& file : files) {
    const ShardHead& first = files.front().head();
    if (file.head().study == first.study) continue;
    refuse_shards(fmt::format("{} holds shards of '{}' and of '{}'; choose one of them by name", directory.string(),
                              first.study, file.head().study),
                  directory);
  }
  // Who is one among others is named, not those.
  std::map<std::size_t, std::size_t> counts;
  for (const ShardFile& file : files) ++counts[file.head().shard.count];
  const std::size_t count = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; })->first;
  const auto usual = std::ranges::find(files, count, [](const ShardFile& file) { return file.head().shard.count; });
  for (const ShardFile& file : files) {
    if (file.head().shard.count == count) continue;
    refuse_shards(fmt::format("{} is shard {} and {} shard {}; expected shards of one number, so remove the others",
                              file.path().string(), to_string(file.head().shard), usual->path().string(),
                              to_string(usual->head().shard)),
                  file.path());
  }
  std::ranges::stable_sort(files, {}, [](const ShardFile& file) { return file.head().shard.index; });
  for (std::size_t k = 1; k < files.size(); ++k) {
    const Shard& shard = files[k].head().shard;
    if (files[k - 1].head().shard.index != shard.index) continue;
    refuse_shards(fmt::format("{} and {} are both shard {}; remove one of them", files[k - 1].path().string(),
                              files[k].path().string(), to_string(shard)),
                  files[k].path());
  }
  std::vector<std::size_t> missing;
  auto next = files.begin();
  for (std::size_t index = 1; index <= count; ++index) {
    if (next != files.end() && next->head().shard.index == index) {
      ++next;
    } else {
      missing.push_back(index);
    }
  }
  if (!missing.empty()) {
    const bool is_one = missing.size() == 1;
    refuse_shards(fmt::format("{} {} of {} of '{}' {} missing in {}; compute {} first", is_one ? "shard" : "shards",
                              number_list(missing), count, files.front().head().study, is_one ? "is" : "are",
                              directory.string(), is_one ? "it" : "them"),
                  directory);
  }
  auto all = std::make_shared<Implementation>();
  all->files = std::move(files);
  return ShardSet(std::move(all));
}

const std::string& ShardSet::study() const {
  return implementation_->files.front().head().study;
}

std::size_t ShardSet::count() const {
  return implementation_->files.size();
}

const std::string& ShardSet::request() const {
  return implementation_->files.front().head().request;
}

std::vector<fs::path> ShardSet::files() const {
  std::vector<fs::path> paths;
  for (const ShardFile& file : implementation_->files) paths.push_back(file.path());
  return paths;
}

void ShardSet::require_same(const Device& device, const Study& study) const {
  const PlanIdentity expected = plan_identity(study, device);
  for (const ShardFile& file : implementation_->files) {
    const std::string foreign = foreignness(file.head().identity, expected);
    if (foreign.empty()) continue;
    refuse_shards(fmt::format("{} {}; run its shard again, or merge where it was run", file.path().string(), foreign),
                  file.path());
  }
}

StudyResult merge_shards(const Device& device, const Study& study, const ShardSet& shards,
                         const ProgressCallback& progress) {
  shards.require_same(device, study);
  std::map<std::string, const ShardFile*, std::less<>> holders;
  for (const ShardFile& file : shards.implementation().files) {
    for (const auto& [name, place] : file.places()) holders.emplace(name, &file);
  }
  UnitStore store = UnitStore::none();
  store.has = [&](const std::string& name) { return holders.contains(name); };
  store.get = [&](const std::string& name) { return holders.at(name)->content(name); };
  StudyComputation computation(device, study, std::move(store), progress);
  const auto units = computation.units();
  const auto owners = dealt_units(units, shards.count());
  for (std::size_t u = 0; u < units.size(); ++u) {
    if (holders.contains(units[u].name)) continue;
    const ShardFile& file = shards.implementation().files[owners[u]];
    refuse_shards(fmt::format("{} lacks {}; run its shard again", file.path().string(), units[u].name), file.path());
  }
  return completed_study(device, computation);
}

}  // namespace lobe
