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
      board_.told_[slot_] = {std::string(stage), share};
    }

   private:
    ProgressBoard& board_;
    const std::string& slot_;
  };

  /// {"stage", "share"}; nothing for a slot whose answer nobody has begun.
  [[nodiscard]] Json of(const std::string& slot) const {
    const std::lock_guard lock(mutex_);
    const auto found = told_.find(slot);
    if (found == told_.end()) return Json::object();
    return {{"stage", found->second.first}, {"share", found->second.second}};
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::pair<std::string, double>> told_;
};

}  // namespace lobe::cli
