#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lobe::cli {

/// One line on standard error that says how far long work has come: "point   [#####.....]  52 %  4.1 %/s  0:13 left".
/// Appears after half a second, is redrawn ten times a second and is gone when the object goes. Also where it is not
/// visible, it keeps the time that each stage takes.
class ProgressLine {
 public:
  using Stages = std::vector<std::pair<std::string, double>>;  ///< names, seconds

  explicit ProgressLine(bool visible) : visible_(visible) {}
  ~ProgressLine() { erase(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::string_view stage, double fraction);
  void erase();

  /// Stages in the order in which they began; what lies before the first and after erase() of the last has none.
  [[nodiscard]] Stages stages() const;
  /// Since the object was made.
  [[nodiscard]] double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;

  void close_stage(Clock::time_point now);
  void draw(double fraction, Clock::time_point now);

  bool visible_;
  std::string stage_;
  double stage_start_fraction_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point stage_start_ = start_;
  Clock::time_point drawn_at_ = start_;
  bool is_drawn_ = false;
  Stages closed_;
};

}  // namespace lobe::cli
