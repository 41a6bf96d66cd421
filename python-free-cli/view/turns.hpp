#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "interface/report.hpp"

namespace lobe::cli {

/// Who computes next. Questions come from many threads; one thread answers them, as HDF5 and OpenCL like it best: quick
/// ones before slow ones, and none whose answer nobody waits for any more.
class Turns {
 public:
  /// A question: the newest of a slot makes the older ones stale.
  struct Question {
    std::string slot = {};     ///< what of the page it fills; empty: it is never stale
    std::uint64_t number = 0;  ///< rises with every question of the page
    int patience = 0;          ///< the less, the sooner
  };
  /// Makes an answer, and asks now and then whether somebody still waits for it.
  using Work = std::function<Json(const std::function<bool()>& is_wanted)>;

  /// A question and what makes its answer.
  struct Asked {
    Question question;
    Work work;
  };
  /// Takes the answer to one of several questions, or why there is none: Cancelled for a question that is stale, and
  /// after stop(); whatever its work throws.
  /// \return whether the others are still waited for
  using Tell = std::function<bool(std::size_t which, Json answer, const std::exception_ptr& failure)>;

  /// Waits for the turns of several questions, and tells each answer as soon as it is made.
  void answer_all(const std::vector<Asked>& all, const Tell& tell);

  /// Waits for its turn and for the answer.
  /// \throws Cancelled for a question that is stale, and after stop(); whatever the work throws
  [[nodiscard]] Json answer(const Asked& asked);

  /// Nobody waits for older questions of a slot any more.
  void forget(const Question& question);

  /// Answers the question whose turn it is, if one comes within the time. Called from one thread.
  void work(std::chrono::milliseconds longest_wait);

  /// No question is answered from now on. May be called from any thread.
  void stop();

 private:
  enum class Stage { waiting, answering, done };
  struct Task {
    const Asked& asked;
    bool is_given_up = false;  ///< who asked has gone
    Stage stage = Stage::waiting;
    Json answer = {};
    std::exception_ptr failure = {};
  };

  class Tasks;

  [[nodiscard]] bool is_wanted(const Question& question) const;
  void make_newest(const Question& question);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, std::uint64_t, std::less<>> newest_;
  std::list<Task*> waiting_;  ///< in the order of their arrival
  bool is_stopped_ = false;
};

}  // namespace lobe::cli
