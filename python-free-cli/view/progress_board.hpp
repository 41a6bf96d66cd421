#pragma once

#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "interface/report.hpp"

namespace lobe::cli {

/// How far the answers are that are being made, by the slots that they are for. For many threads.
class ProgressBoard {
 public:
  /// What an answer tells of itself, until it is made or has failed. One for no slot tells nothing.
  class Place {
   public:
    Place(ProgressBoard& board, const std::string& slot) : board_(board), slot_(slot) {}
    ~Place() {
      const std::lock_guard lock(board_.mutex_);
      board_.told_.erase(slot_);
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    void tell(std::string_view stage, double share) const {
      if (slot_.empty()) return;
      const std::lock_guard lock(board_.mutex_);
      Told& told = board_.told_[slot_];
      told.stage = stage;
      told.share = share;
    }

    /// The best so far, as the page shows it.
    void tell_best(Json best) const {
      if (slot_.empty()) return;
      const std::lock_guard lock(board_.mutex_);
      board_.told_[slot_].best = std::move(best);
    }

   private:
    ProgressBoard& board_;
    const std::string& slot_;
  };

  /// {"stage", "share"}, and "best" where the answer has told of one; nothing for a slot whose answer nobody has begun.
  [[nodiscard]] Json of(const std::string& slot) const {
    const std::lock_guard lock(mutex_);
    const auto found = told_.find(slot);
    if (found == told_.end()) return Json::object();
    Json json{{"stage", found->second.stage}, {"share", found->second.share}};
    if (!found->second.best.is_null()) json["best"] = found->second.best;
    return json;
  }

 private:
  struct Told {
    std::string stage = {};
    double share = 0;
    Json best = nullptr;
  };

  mutable std::mutex mutex_;
  std::map<std::string, Told> told_;
};

}  // namespace lobe::cli
