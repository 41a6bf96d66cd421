#include "progress.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "terminal.hpp"

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
  if (!visible_) return;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto now = Clock::now();
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
    stage_start_fraction_ = fraction;
  }
  if (now - start_ < kFirstDrawing || (drawn_width_ > 0 && now - drawn_at_ < kBetweenDrawings)) return;
  std::string line = fmt::format("{:<10} [{}] {:3.0f} %", stage.substr(0, kStageWidth), bar(fraction), 100 * fraction);
  const double done = fraction - stage_start_fraction_;
  if (now - stage_start_ > kBeforeForecast && done > 0) {
    const std::chrono::duration<double> spent = now - stage_start_;
    line += fmt::format("  {} left", duration_text(spent.count() * (1 - fraction) / done));
  }
  const std::size_t width = line.size();
  if (width < drawn_width_) line.append(drawn_width_ - width, ' ');
  write_error("\r" + line);
  drawn_width_ = width;
  drawn_at_ = now;
}

void ProgressLine::erase() {
  // Blanks instead of an escape sequence: they work on every terminal.
  if (drawn_width_ > 0) write_error(fmt::format("\r{:{}}\r", "", drawn_width_));
  drawn_width_ = 0;
}

}  // namespace lobe::cli
