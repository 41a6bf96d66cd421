#include "view/turns.hpp"

#include <algorithm>

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

Json Turns::answer(const Question& question, const Work& work) {
  std::unique_lock lock(mutex_);
  make_newest(question);
  Task task{question, work};
  const auto place = waiting_.insert(waiting_.end(), &task);
  changed_.notify_all();
  changed_.wait(lock,
                [&] { return task.stage == Stage::done || (task.stage == Stage::waiting && !is_wanted(question)); });
  if (task.stage == Stage::waiting) {
    waiting_.erase(place);
    throw Cancelled("nobody waits for the answer");
  }
  if (task.failure) std::rethrow_exception(task.failure);
  return std::move(task.answer);
}

void Turns::work(std::chrono::milliseconds longest_wait) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, longest_wait, [&] { return !waiting_.empty(); });
  const auto next = std::ranges::min_element(waiting_, {}, [](const Task* one) { return one->question.patience; });
  if (next == waiting_.end()) return;
  Task& task = **next;
  waiting_.erase(next);
  task.stage = Stage::answering;
  lock.unlock();
  Json answer;
  std::exception_ptr failure;
  try {
    answer = task.work([&] {
      const std::lock_guard guard(mutex_);
      return is_wanted(task.question);
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
