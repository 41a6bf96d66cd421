#include "view/turns.hpp"

#include <algorithm>
#include <deque>
#include <numeric>
#include <utility>

#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// Slots that are remembered. A page has some twenty.
constexpr std::size_t kMostSlots = 10'000;

}  // namespace

bool Turns::is_wanted(const Question& question) const {
  if (is_stopped_) return false;
  const auto found = newest_.find(question.slot);
  return question.slot.empty() || found == newest_.end() || found->second <= question.number;
}

void Turns::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  changed_.notify_all();
}

void Turns::make_newest(const Question& question) {
  if (question.slot.empty() || !is_wanted(question)) return;
  if (newest_.size() >= kMostSlots) newest_.clear();
  newest_[question.slot] = question.number;
}

void Turns::forget(const Question& question) {
  const std::lock_guard lock(mutex_);
  make_newest(question);
  changed_.notify_all();
}

/// Tasks of one who waits for them, which nobody else works at any more when he goes.
class Turns::Tasks {
 public:
  Tasks(Turns& turns, const std::vector<Asked>& all) : turns_(turns), lock_(turns.mutex_) {
    std::list<Task*> arrived;
    for (const Asked& one : all) {
      turns.make_newest(one.question);
      arrived.push_back(&tasks_.emplace_back(Task{one}));
    }
    turns.waiting_.splice(turns.waiting_.end(), arrived);
    turns.changed_.notify_all();
  }
  ~Tasks() {
    if (!lock_.owns_lock()) lock_.lock();
    for (Task& task : tasks_) {
      give_up(task);
      task.is_given_up = true;
    }
    turns_.changed_.wait(lock_, [&] {
      return std::ranges::none_of(tasks_, [](const Task& task) { return task.stage == Stage::answering; });
    });
  }
  Tasks(const Tasks&) = delete;
  Tasks& operator=(const Tasks&) = delete;

  /// Waits until a task of those in `open` is done, or nobody waits for it any more.
  /// \return its place in `open`
  [[nodiscard]] std::size_t wait(const std::vector<std::size_t>& open) {
    const auto is_over = [&](std::size_t which) {
      const Task& task = tasks_[which];
      return task.stage == Stage::done || (task.stage == Stage::waiting && !turns_.is_wanted(task.asked.question));
    };
    auto found = open.end();
    turns_.changed_.wait(lock_, [&] {
      found = std::ranges::find_if(open, is_over);
      return found != open.end();
    });
    return static_cast<std::size_t>(found - open.begin());
  }

  /// Tells how a task ended, while others go on.
  bool tell(std::size_t which, const Tell& tell) {
    Task& task = tasks_[which];
    if (task.stage == Stage::waiting) {
      give_up(task);
      task.failure = std::make_exception_ptr(Cancelled("nobody waits for the answer"));
    }
    lock_.unlock();
    const bool goes_on = tell(which, std::move(task.answer), task.failure);
    lock_.lock();
    return goes_on;
  }

 private:
  void give_up(Task& task) {
    if (task.stage != Stage::waiting) return;
    turns_.waiting_.remove(&task);
    task.stage = Stage::done;
  }

  Turns& turns_;
  std::unique_lock<std::mutex> lock_;
  std::deque<Task> tasks_;
};

void Turns::answer_all(const std::vector<Asked>& all, const Tell& tell) {
  Tasks tasks(*this, all);
  std::vector<std::size_t> open(all.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  while (!open.empty()) {
    const auto next = open.begin() + static_cast<std::ptrdiff_t>(tasks.wait(open));
    const std::size_t which = *next;
    open.erase(next);
    if (!tasks.tell(which, tell)) return;
  }
}

Json Turns::answer(const Asked& asked) {
  Json told;
  answer_all({asked}, [&](std::size_t, Json answer, const std::exception_ptr& failure) {
    if (failure) std::rethrow_exception(failure);
    told = std::move(answer);
    return true;
  });
  return told;
}

void Turns::work(std::chrono::milliseconds longest_wait) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, longest_wait, [&] { return !waiting_.empty(); });
  const auto next =
      std::ranges::min_element(waiting_, {}, [](const Task* one) { return one->asked.question.patience; });
  if (next == waiting_.end()) return;
  Task& task = **next;
  waiting_.erase(next);
  task.stage = Stage::answering;
  lock.unlock();
  Json answer;
  std::exception_ptr failure;
  try {
    answer = task.asked.work([&] {
      const std::lock_guard guard(mutex_);
      return is_wanted(task.asked.question) && !task.is_given_up;
    });
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  task.answer = std::move(answer);
  task.failure = failure;
  task.stage = Stage::done;
  changed_.notify_all();
}

}  // namespace lobe::cli
