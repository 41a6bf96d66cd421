#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace lobe::cli {

/// One line on standard error that says how far long work has come: "point   [#####.....]  52 %  0:13 left".
/// Appears after half a second, is redrawn ten times a second and is gone when the object goes.
class ProgressLine {
 public:
  explicit ProgressLine(bool visible) : visible_(visible) {}
  ~ProgressLine() { erase(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::string_view stage, double fraction);
  void erase();

 private:
  using Clock = std::chrono::steady_clock;

  bool visible_;
  std::string stage_;
  double stage_start_fraction_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point stage_start_ = start_;
  Clock::time_point drawn_at_ = start_;
  std::size_t drawn_width_ = 0;
};

}  // namespace lobe::cli
