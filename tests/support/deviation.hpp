#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>

namespace lobe::test {

/// Collects comparisons, each in units of its own tolerance, and keeps the worst with what caused it.
class Deviation {
 public:
  /// \param error |computed - expected| in any unit;
  /// \param tolerance in the same unit
  void add(double error, double tolerance, const std::string& cause) {
    const double share = error / tolerance;
    if (count_++ == 0 || !(share <= worst_)) {
      worst_ = share;
      cause_ = cause;
    }
  }

  /// Worst error over tolerance: at most 1 when all comparisons hold; NaN when one gave no number.
  [[nodiscard]] double worst() const { return worst_; }
  [[nodiscard]] const std::string& cause() const { return cause_; }

  /// Prints the worst comparison and keeps it in the test's record, also on success.
  void report(const std::string& what) const {
    char text[64];
    std::snprintf(text, sizeof text, "%.3g", worst_);
    ::testing::Test::RecordProperty(what, text);
    std::cout << "  " << what << ": worst error / tolerance " << text << " at " << cause_ << '\n';
  }

 private:
  double worst_ = 0;
  std::string cause_ = "nothing";
  long count_ = 0;
};

}  // namespace lobe::test
