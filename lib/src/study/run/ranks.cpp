#include "lobe/study/ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "study/run/checkpoint_implementation.hpp"
#include "study/run/checkpoint_records.hpp"
#include "study/run/completed_study.hpp"
#include "study/run/crew_work.hpp"
#include "study/run/rank_messages.hpp"
#include "study/run/record_stream.hpp"
#include "study/run/study_computation.hpp"
#include "study/run/study_identity.hpp"

// In each process one thread computes, and the one that calls exchanges texts: it answers at once, however long a unit
// takes, and knows by their silence of those that do not.

namespace lobe {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kTick{1};              // between looks at what else there is to do
constexpr milliseconds kBeat{1000};           // between signs of life
constexpr milliseconds kSilence{6000};        // after which a rank counts as lost
constexpr milliseconds kStopping{400};        // for others to leave where something has failed
constexpr milliseconds kFarewell{10'000};     // for others to leave when all is known
constexpr milliseconds kHelperStopping{100};  // for work of this rank to end that nobody wants any more

std::string name_of(const Ranks& ranks, std::size_t rank) {
  return fmt::format("rank {} of {} (on {})", rank, ranks.count(), ranks.host(rank));
}

std::string identity_text(const PlanIdentity& identity) {
  RecordWriter writer;
  for (const auto* part : {&identity.version, &identity.build, &identity.device, &identity.plan}) {
    writer.take(std::string_view(*part));
  }
  return writer.text();
}

/// \throws IoError where a rank would compute something else than rank 0
void require_same_identity(const PlanIdentity& own, std::string_view expected) {
  RecordReader reader(expected);
  const std::array named{std::pair(&own.version, "is lobe {}, and rank 0 is lobe {}; install the same everywhere"),
                         std::pair(&own.build, "is another build of lobe; install the same everywhere"),
                         std::pair(&own.device, "computes on {}, and rank 0 on {}; take machines of one kind"),
                         std::pair(&own.plan,
                                   "finds another study or other contents of its files than rank 0; have all ranks "
                                   "start in the same folder")};
  for (const auto& [part, what] : named) {
    std::string_view other;
    reader.take(other);
    if (*part != other) throw IoError(fmt::format(fmt::runtime(what), *part, other));
  }
}

/// Rank 0.
class Crew {
 public:
  Crew(const Device& device, const Study& study, RecordFile* file, Ranks& ranks, const CrewOptions& options)
      : ranks_(ranks),
        options_(options),
        work_(std::make_shared<CrewWork>(device, study, file)),
        heard_(ranks.count(), Clock::now()),
        has_left_(ranks.count(), false) {
    has_left_[0] = true;
    work_->state->progress = options.progress;
  }

  /// Computes all units.
  /// \return what holds their records
  std::shared_ptr<CrewWork> compute() {
    try {
      send_all(RankWord::begin, identity_text(plan_identity(work_->study, work_->device)));
      ComputingThread thread(work_->state, [work = work_, count = ranks_.count()] { work->compute(count); });
      while (!is_complete(thread)) exchange();
    } catch (...) {
      send_away(kStopping);
      // Work that goes on without anybody waiting must not touch the caller's checkpoint.
      const std::scoped_lock lock(work_->state->mutex);
      work_->is_abandoned = true;
      throw;
    }
    send_away(kFarewell);
    traffic_.units = work_->all_units;
    traffic_.units_of_others = work_->units_of_others;
    if (options_.done) options_.done(traffic_);
    return work_;
  }

  void send_away(milliseconds patience) {
    try {
      send_all(RankWord::leave, {});
      const auto end = Clock::now() + patience;
      while (!have_all_left() && Clock::now() < end && !is_any_lost()) take(kTick);
    } catch (const Error&) {
      // Who cannot be reached is not waited for.
    }
    ranks_.leave(have_all_left());
  }

 private:
  [[nodiscard]] std::string name_of(std::size_t rank) const { return ::lobe::name_of(ranks_, rank); }
  [[nodiscard]] bool have_all_left() const { return std::ranges::find(has_left_, false) == has_left_.end(); }
  [[nodiscard]] bool is_any_lost() const {
    for (std::size_t r = 1; r < ranks_.count(); ++r) {
      if (!has_left_[r] && ranks_.has_ended(r)) return true;
    }
    return false;
  }
  void send(std::size_t to, const RankText& text) {
    std::string bytes = written_rank_text(text);
    traffic_.sent_bytes += bytes.size();
    ranks_.send(to, std::move(bytes));
  }
  void send_all(RankWord word, const std::string& content) {
    for (std::size_t r = 1; r < ranks_.count(); ++r) send(r, {.word = word, .name = {}, .content = content});
    beat_ = Clock::now();
  }

  /// Whether all units are known.
  /// \throws what the thread has thrown, and Cancelled
  bool is_complete(const ComputingThread& thread) {
    if (!thread.is_over()) return false;
    if (const std::exception_ptr failure = thread.failure()) {
      require_all_there();  // who ends the others with one that was lost sends this one a signal
      std::rethrow_exception(failure);
    }
    std::size_t left = 0;
    {
      const std::scoped_lock lock(work_->state->mutex);
      left = work_->left.size();
    }
    if (left == 0) return true;
    const auto all = static_cast<double>(work_->all_units);
    if (!work_->state->report("other ranks", 1 - static_cast<double>(left) / all)) {
      require_all_there();
      throw Cancelled("cancelled");
    }
    return false;
  }

  void require_all_there() const {
    for (std::size_t r = 1; r < ranks_.count(); ++r) {
      if (ranks_.has_ended(r)) throw rank_has_ended(ranks_, r);
    }
  }

  /// Answers what comes, and looks after the others.
  void exchange() {
    for (milliseconds patience = kTick; take(patience); patience = {}) {
    }
    answer();
    const auto now = Clock::now();
    if (now - beat_ > kBeat) send_all(RankWord::alive, {});
    require_all_there();
    for (std::size_t r = 1; r < ranks_.count(); ++r) {
      if (now - heard_[r] >= kSilence) throw rank_is_silent(ranks_, r, kSilence);
    }
    std::size_t kept = 0;
    {
      const std::scoped_lock lock(work_->state->mutex);
      kept = work_->records.kept();
    }
    if (kept != told_ && options_.kept) options_.kept(kept);
    told_ = kept;
  }

  /// \return whether anything has come
  bool take(milliseconds patience) {
    const auto message = ranks_.receive(patience);
    if (!message) return false;
    traffic_.received_bytes += message->text.size();
    heard_.at(message->from) = Clock::now();
    auto text = read_rank_text(message->text);
    if (!text) throw DeviceError(name_of(message->from) + " has sent something damaged; check the network");
    switch (text->word) {
      case RankWord::next:
        asking_.push_back(message->from);
        break;
      case RankWord::result:
        work_->take(text->name, text->content);
        break;
      case RankWord::failed:
        throw_written_error(text->content, name_of(message->from));
      case RankWord::left:
        has_left_.at(message->from) = true;
        break;
      default:
        break;
    }
    return true;
  }

  void answer() {
    const std::scoped_lock lock(work_->state->mutex);
    if (!work_->dealer) return;
    for (const std::size_t rank : std::exchange(asking_, {})) {
      const auto unit = work_->dealer->next(rank);
      send(rank, unit ? RankText{.word = RankWord::unit, .name = work_->units[*unit].name, .content = {}}
                      : RankText{.word = RankWord::none});
    }
  }

  Ranks& ranks_;
  const CrewOptions& options_;
  std::shared_ptr<CrewWork> work_;
  std::vector<Clock::time_point> heard_;
  std::vector<bool> has_left_;
  std::vector<std::size_t> asking_;
  Clock::time_point beat_ = Clock::now();
  std::optional<std::size_t> told_;
  RankTraffic traffic_;
};

/// What another rank computes with.
struct HelpWork {
  explicit HelpWork(Device used) : device(std::move(used)) {}

  std::shared_ptr<Computing> state = std::make_shared<Computing>();
  Device device;
  std::deque<RankText> out;        ///< to be sent
  std::optional<RankText> answer;  ///< to the question for a unit

  void tell(RankText text) {
    const std::scoped_lock lock(state->mutex);
    out.push_back(std::move(text));
  }
  /// \return name of the next unit; none: there is no more
  std::optional<std::string> ask() {
    tell({.word = RankWord::next});
    std::unique_lock lock(state->mutex);
    state->changed.wait(lock, [&] { return answer || state->is_stopped; });
    if (state->is_stopped) throw Cancelled("cancelled");
    const RankText found = *std::exchange(answer, {});
    return found.word == RankWord::unit ? std::optional(found.name) : std::nullopt;
  }

  void compute(const std::function<Study()>& load, std::string_view identity) {
    const Study study = load();
    require_same_identity(plan_identity(study, device), identity);
    UnitStore store = UnitStore::none();
    store.is_worth_keeping = [](const std::string&, double) { return true; };
    store.keep = [this](const std::string& name, const std::string& content) {
      tell({.word = RankWord::result, .name = name, .content = content});
    };
    const auto report = [shared = state](std::string_view stage, double share) { return shared->report(stage, share); };
    StudyComputation computation(device, study, std::move(store), report);
    const std::vector<StudyUnit> units = computation.units();
    std::map<std::string, std::size_t, std::less<>> places;
    for (std::size_t u = 0; u < units.size(); ++u) places.emplace(units[u].name, u);
    computation.compute(units, [&]() -> std::optional<std::size_t> {
      const auto name = ask();
      if (!name) return {};
      const auto place = places.find(*name);
      if (place == places.end()) throw IoError("knows no unit '" + *name + "' of the study");
      return place->second;
    });
  }
};

/// Any other rank, once rank 0 has begun.
class Helper {
 public:
  Helper(const Device& device, Ranks& ranks, const ProgressCallback& progress)
      : ranks_(ranks), work_(std::make_shared<HelpWork>(device)) {
    work_->state->progress = progress;
  }

  /// \return whether rank 0 has sent this one away, and waits for it
  bool help(const std::function<Study()>& load, const std::string& identity) {
    ComputingThread thread(work_->state, [work = work_, load, identity] { work->compute(load, identity); });
    const bool is_sent_away = exchange(thread);
    thread.stop(kHelperStopping);
    return is_sent_away;
  }

 private:
  bool exchange(const ComputingThread& thread) {
    auto heard = Clock::now();
    auto beat = heard;
    bool has_failed = false;
    while (true) {
      if (!has_failed && thread.is_over() && thread.failure()) {
        has_failed = true;
        work_->tell({.word = RankWord::failed, .name = {}, .content = written_error(thread.failure())});
      }
      send_what_is_there();
      if (auto message = ranks_.receive(kTick)) {
        heard = Clock::now();
        auto text = read_rank_text(message->text);
        if (text && text->word == RankWord::leave) return true;
        if (text && (text->word == RankWord::unit || text->word == RankWord::none)) {
          const std::scoped_lock lock(work_->state->mutex);
          work_->answer = std::move(*text);
          work_->state->changed.notify_all();
        }
      }
      const auto now = Clock::now();
      if (now - heard > kSilence || ranks_.has_ended(0)) return false;
      if (now - beat > kBeat) {
        work_->tell({.word = RankWord::alive});
        beat = now;
      }
    }
  }

  void send_what_is_there() {
    std::deque<RankText> texts;
    {
      const std::scoped_lock lock(work_->state->mutex);
      texts.swap(work_->out);
    }
    for (const RankText& text : texts) ranks_.send(0, written_rank_text(text));
  }

  Ranks& ranks_;
  std::shared_ptr<HelpWork> work_;
};

/// The first text from rank 0; none: there will be none.
std::optional<RankText> first_text(Ranks& ranks, const ProgressCallback& progress) {
  while (!ranks.has_ended(0) && (!progress || progress("", 0))) {
    const auto message = ranks.receive(milliseconds(10));
    if (!message) continue;
    const auto text = read_rank_text(message->text);
    if (text && (text->word == RankWord::begin || text->word == RankWord::leave)) return text;
  }
  return {};
}

}  // namespace

DeviceError rank_has_ended(const Ranks& ranks, std::size_t rank) {
  return DeviceError(name_of(ranks, rank) +
                     " has ended before its work was done; give the same command again, to go on from what is kept");
}

DeviceError rank_is_silent(const Ranks& ranks, std::size_t rank, milliseconds since) {
  return DeviceError(
      fmt::format("{} has said nothing for {} s; give the same command again, to go on from what is kept",
                  name_of(ranks, rank), std::chrono::duration_cast<std::chrono::seconds>(since).count()));
}

StudyResult run_study(const Device& device, const Study& study, Checkpoint* checkpoint, Ranks& ranks,
                      const CrewOptions& options) {
  RecordFile* file = nullptr;
  if (checkpoint != nullptr) {
    checkpoint->open(study, device);
    file = &checkpoint->implementation_->file;
  }
  const std::shared_ptr<CrewWork> work = Crew(device, study, file, ranks, options).compute();
  return completed_study(work->device, *work->computation);
}

void help_run_study(const Device& device, const std::function<Study()>& load, Ranks& ranks,
                    const ProgressCallback& progress) {
  bool is_sent_away = false;
  try {
    const auto first = first_text(ranks, progress);
    is_sent_away = first.has_value();
    if (first && first->word == RankWord::begin) {
      is_sent_away = Helper(device, ranks, progress).help(load, first->content);
    }
    if (is_sent_away) ranks.send(0, written_rank_text({.word = RankWord::left}));
  } catch (const Error&) {
    is_sent_away = false;  // rank 0 cannot be reached
  }
  ranks.leave(is_sent_away);
}

void dismiss_ranks(Ranks& ranks) {
  std::set<std::size_t> left;
  try {
    for (std::size_t r = 1; r < ranks.count(); ++r) ranks.send(r, written_rank_text({.word = RankWord::leave}));
    const auto end = Clock::now() + kFarewell;
    while (left.size() + 1 < ranks.count() && Clock::now() < end) {
      const auto message = ranks.receive(kTick);
      const auto text = message ? read_rank_text(message->text) : std::nullopt;
      if (text && text->word == RankWord::left) left.insert(message->from);
    }
  } catch (const Error&) {
    // Who cannot be reached is not waited for.
  }
  ranks.leave(left.size() + 1 == ranks.count());
}

}  // namespace lobe
