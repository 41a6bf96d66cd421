#include "study/run/crew_work.hpp"

#include <optional>
#include <utility>

#include "lobe/core/error.hpp"
#include "study/run/checkpoint_records.hpp"

namespace lobe {

bool Computing::report(std::string_view stage, double share) {
  const std::scoped_lock lock(mutex);
  return !is_stopped && (!progress || progress(stage, share));
}

ComputingThread::ComputingThread(std::shared_ptr<Computing> state, std::function<void()> work)
    : state_(std::move(state)) {
  thread_ = std::thread([state = state_, ending = ending_, work = std::move(work)]() mutable {
    std::exception_ptr failure;
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    work = {};
    const std::scoped_lock lock(state->mutex);
    ending->failure = failure;
    ending->is_over = true;
    state->changed.notify_all();
  });
}

ComputingThread::~ComputingThread() {
  constexpr std::chrono::milliseconds kStopping{400};  // less than an interrupted command has
  stop(kStopping);
}

bool ComputingThread::is_over() const {
  const std::scoped_lock lock(state_->mutex);
  return ending_->is_over;
}

std::exception_ptr ComputingThread::failure() const {
  const std::scoped_lock lock(state_->mutex);
  return ending_->failure;
}

void ComputingThread::stop(std::chrono::milliseconds patience) {
  if (!thread_.joinable()) return;
  std::unique_lock lock(state_->mutex);
  if (!ending_->is_over) {
    state_->is_stopped = true;
    state_->progress = {};
  }
  state_->changed.notify_all();
  const bool is_over = state_->changed.wait_for(lock, patience, [&] { return ending_->is_over; });
  lock.unlock();
  is_over ? thread_.join() : thread_.detach();
}

void CrewRecords::keep(const std::string& unit, std::string content) {
  const std::string name = names_.of(unit);
  if (file_ != nullptr && !name.empty()) {
    file_->keep(name, content);
    if (file_->find(name) != nullptr) return;
  }
  others_.insert_or_assign(unit, std::move(content));
}

const std::string* CrewRecords::find(const std::string& unit) const {
  const auto found = others_.find(unit);
  if (found != others_.end()) return &found->second;
  const std::string name = names_.of(unit);
  return file_ == nullptr || name.empty() ? nullptr : file_->find(name);
}

void CrewWork::take(const std::string& name, const std::string& content) {
  const std::scoped_lock lock(state->mutex);
  if (is_abandoned || !left.contains(name)) return;
  records.keep(name, content);
  left.erase(name);
  ++units_of_others;
}

UnitStore CrewWork::store(std::size_t taker) {
  return {.has =
              [this](const std::string& name) {
                const std::scoped_lock lock(state->mutex);
                return !is_abandoned && records.has(name);
              },
          .get =
              [this](const std::string& name) {
                const std::scoped_lock lock(state->mutex);
                return is_abandoned ? std::string() : records.get(name);
              },
          .is_worth_keeping =
              [this](const std::string& name, double) {
                const std::scoped_lock lock(state->mutex);
                return left.contains(name);
              },
          .keep =
              [this, taker](const std::string& name, const std::string& content) {
                if (taker > 0) return take(name, content);
                const std::scoped_lock lock(state->mutex);
                if (is_abandoned) return;
                records.keep(name, content);
                left.erase(name);
              }};
}

ProgressCallback CrewWork::report() const {
  return [shared = state](std::string_view stage, double share) { return shared->report(stage, share); };
}

UnitSource CrewWork::source(std::size_t taker) {
  return [this, taker]() -> std::optional<std::size_t> {
    const std::scoped_lock lock(state->mutex);
    if (state->is_stopped) throw Cancelled("cancelled");
    return dealer->next(taker);
  };
}

void CrewWork::compute(std::size_t takers) {
  computation = std::make_unique<StudyComputation>(device, study, store(0), report());
  std::vector<StudyUnit> all = computation->units();
  {
    const std::scoped_lock lock(state->mutex);
    if (is_abandoned) return;
    units = std::move(all);
    const auto is_known = [&](const StudyUnit& unit) {
      if (records.has(unit.name)) return true;
      // A lighting or a metric may be known as a whole from a run on its own.
      if (unit.kind == StudyUnit::Kind::tile) return records.has(record_name(study.comparison_metrics[unit.index]));
      return unit.kind == StudyUnit::Kind::slab && records.has(record_name(study.lightings[unit.index]));
    };
    for (const StudyUnit& unit : units) {
      if (!is_known(unit)) left.insert(unit.name);
    }
    all_units = left.size();
    dealer = std::make_unique<UnitDealer>(units, is_known, takers);
    state->changed.notify_all();
  }
  computation->compute(units, source(0));
}

void CrewWork::help(const Device& other, std::size_t taker) {
  {
    std::unique_lock lock(state->mutex);
    state->changed.wait(lock, [&] { return dealer != nullptr || state->is_stopped; });
    if (state->is_stopped) throw Cancelled("cancelled");
  }
  std::unique_lock one_at_a_time(preparing);
  StudyComputation own(other, study, store(taker), report());
  one_at_a_time.unlock();
  own.compute(units, source(taker));
}

}  // namespace lobe
