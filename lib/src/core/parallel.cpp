#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace lobe {
namespace {

/// This thread works for a parallel_for() already: its own ones run here, since all cores are taken.
thread_local bool is_busy = false;

/// Sets a flag for its lifetime.
class Busy {
 public:
  Busy() : before_(std::exchange(is_busy, true)) {}
  ~Busy() { is_busy = before_; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  bool before_;
};

/// Work that helpers may join.
struct Job {
  const std::function<void()>& run;
  std::size_t wanted = 0;  ///< how many more may join
  std::size_t active = 0;  ///< how many have joined and not ended
  std::condition_variable ended;
};

/// Threads that wait for work, made when they are first needed: making one takes as long as many a job. They are never
/// joined, since the process may end in the middle of their work; after a fork() the child has none and works alone.
class Helpers {
 public:
  static Helpers& all() {
    static auto* const helpers = new Helpers;  // outlives whatever may still work at exit
    return *helpers;
  }

  /// Runs a job here and on at most `count` helpers, and waits for those that have joined it.
  void help(const std::function<void()>& run, std::size_t count) {
    Job job{run, count, 0, {}};
    {
      const std::lock_guard lock(mutex_);
      make(count);
      jobs_.push_back(&job);
    }
    if (count == 1) {
      has_work_.notify_one();
    } else {
      has_work_.notify_all();
    }
    run();
    std::unique_lock lock(mutex_);
    std::erase(jobs_, &job);
    job.ended.wait(lock, [&] { return job.active == 0; });
  }

 private:
  void make(std::size_t count) {
    try {
      for (; made_ < count; ++made_) std::thread([this] { work(); }).detach();
    } catch (const std::system_error&) {
      // No more threads to be had: those there are do the work.
    }
  }

  [[noreturn]] void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      has_work_.wait(lock, [&] { return !jobs_.empty(); });
      Job& job = *jobs_.front();
      ++job.active;
      if (--job.wanted == 0) std::erase(jobs_, &job);
      lock.unlock();
      job.run();
      lock.lock();
      if (--job.active == 0) job.ended.notify_one();
      // A job that has ended for one helper has nothing left to begin.
      std::erase(jobs_, &job);
    }
  }

  std::mutex mutex_;
  std::condition_variable has_work_;
  std::vector<Job*> jobs_;  ///< that want helpers
  std::size_t made_ = 0;
};

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (is_busy || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::once_flag has_failed;
  const std::function<void()> run = [&] {
    const Busy busy;
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      std::call_once(has_failed, [&] { failure = std::current_exception(); });
    }
  };
  const std::size_t threads = std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), count);
  if (threads == 1) {
    run();
  } else {
    Helpers::all().help(run, threads - 1);
  }
  if (failure) std::rethrow_exception(failure);
}

void parallel_for_pieces(std::size_t count, std::size_t size,
                         const std::function<void(std::size_t begin, std::size_t end)>& work) {
  parallel_for((count + size - 1) / size,
               [&](std::size_t piece) { work(piece * size, std::min(count, (piece + 1) * size)); });
}

}  // namespace lobe
