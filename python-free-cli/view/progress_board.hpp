#pragma once

#include <cstdint>
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
    Place(ProgressBoard& board, const std::string& slot, std::uint64_t number)
        : board_(board), slot_(slot), number_(number) {}
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
      told.number = number_;
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
    std::uint64_t number_;
  };

  /// {"stage", "share"}, and "best" where the answer has told of one; nothing for a question that nobody has begun to
  /// answer, or whose slot another one fills.
  /// \param number of the question; 0 for whichever the slot has
  [[nodiscard]] Json of(const std::string& slot, std::uint64_t number) const {
    const std::lock_guard lock(mutex_);
    const auto found = told_.find(slot);
    if (found == told_.end() || (number != 0 && number != found->second.number)) return Json::object();
    Json json{{"stage", found->second.stage}, {"share", found->second.share}};
    if (!found->second.best.is_null()) json["best"] = found->second.best;
    return json;
  }

 private:
  struct Told {
    std::uint64_t number = 0;
    std::string stage = {};
    double share = 0;
    Json best = nullptr;
  };

  mutable std::mutex mutex_;
  std::map<std::string, Told> told_;
};

}  // namespace lobe::cli
