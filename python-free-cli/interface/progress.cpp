#include "interface/progress.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "interface/terminal.hpp"

namespace lobe::cli {
namespace {

constexpr std::chrono::milliseconds kFirstDrawing{500};
constexpr std::chrono::milliseconds kBetweenDrawings{100};
constexpr std::chrono::seconds kBeforeForecast{1};  // earlier, the time left is a guess
constexpr std::size_t kBarWidth = 24;
constexpr std::size_t kStageWidth = 24;

std::string bar(double fraction) {
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(kBarWidth));
  return std::string(filled, '#') + std::string(kBarWidth - filled, '.');
}

std::string duration_text(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

void ProgressLine::show(std::string_view stage, double fraction) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto now = Clock::now();
  if (stage != stage_) {
    close_stage(now);
    stage_ = stage;
    stage_start_ = now;
    stage_start_fraction_ = fraction;
  }
  if (visible_) draw(fraction, now);
}

void ProgressLine::draw(double fraction, Clock::time_point now) {
  if (now - start_ < kFirstDrawing || (is_drawn_ && now - drawn_at_ < kBetweenDrawings)) return;
  std::string line = fmt::format("{:<10} [{}] {:3.0f} %", stage_.substr(0, kStageWidth), bar(fraction), 100 * fraction);
  const double done = fraction - stage_start_fraction_;
  if (now - stage_start_ > kBeforeForecast && done > 0) {
    const std::chrono::duration<double> spent = now - stage_start_;
    line += fmt::format("  {:.2g} %/s  {} left", 100 * done / spent.count(),
                        duration_text(spent.count() * (1 - fraction) / done));
  }
  // A line that wraps could not be written over.
  line.resize(std::min(line.size(), columns(Stream::error) - 1));
  write_over(line);
  is_drawn_ = true;
  drawn_at_ = now;
}

void ProgressLine::erase() {
  close_stage(Clock::now());
  write_over("");
  is_drawn_ = false;
}

void ProgressLine::close_stage(Clock::time_point now) {
  if (stage_.empty()) return;
  const double spent = std::chrono::duration<double>(now - stage_start_).count();
  const auto known = std::ranges::find(closed_, stage_, &Stages::value_type::first);
  if (known == closed_.end()) {
    closed_.emplace_back(stage_, spent);
  } else {
    known->second += spent;
  }
  stage_.clear();
}

ProgressLine::Stages ProgressLine::stages() const {
  return closed_;
}

double ProgressLine::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

}  // namespace lobe::cli
