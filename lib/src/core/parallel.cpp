#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
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

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (is_busy || count == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::once_flag has_failed;
  const auto run = [&] {
    const Busy busy;
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      std::call_once(has_failed, [&] { failure = std::current_exception(); });
    }
  };
  {
    std::vector<std::jthread> helpers;
    const std::size_t threads = std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), count);
    try {
      while (helpers.size() + 1 < threads) helpers.emplace_back(run);
    } catch (const std::system_error&) {
      // No more threads to be had: those there are do the work.
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace lobe
