#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace bench {

/// One of several ways to do the same work.
struct Contender {
  std::string name;
  std::function<void()> run;
  int rounds = 1000;  ///< at most so many, for slow ones
};

/// Time and work of a contender.
struct Timing {
  std::string name;
  double seconds;  ///< median over the rounds
  double
      ratio_to_first;  ///< its time over the first contender's in the same round, median: above 1, the first is faster
  double ratio_spread = 0;          ///< median distance of the rounds' ratios from that one
  std::vector<double> rounds = {};  ///< seconds of each round
};

/// Kinds of seconds: those that pass, or those of all processors at work for the program, which other programs hardly
/// disturb.
enum class Clock { wall, processors };

/// Times contenders round by round, so that all of them meet the same disturbances by other programs.
/// \param rounds how often each is timed, after one run that is not
[[nodiscard]] std::vector<Timing> measure_together(const std::vector<Contender>& contenders, int rounds,
                                                   Clock clock = Clock::wall);

/// Exponent p of cost = c N^p fitted to medians: slope of ln(seconds) over ln(size) by least squares.
[[nodiscard]] double fitted_exponent(std::span<const double> sizes, std::span<const double> seconds);

/// A table of one row per size: rates of each contender, and ratios to the first with their spread.
class Table {
 public:
  /// \param rate_unit of work over seconds, such as "GFLOP/s"
  explicit Table(std::string rate_unit) : rate_unit_(std::move(rate_unit)) {}

  /// \param work in the rate's unit times seconds
  void add(const std::string& row, double work, std::vector<Timing> timings);
  void print() const;

 private:
  struct Row {
    std::string name;
    double work;
    std::vector<Timing> timings;
  };
  std::string rate_unit_;
  std::vector<Row> rows_;
};

/// Median of at least one value; of an even number the larger of the middle two.
[[nodiscard]] double median(std::vector<double> values);

/// Starts the program again without the variables that force kernels and block sizes on OpenBLAS, if there are any:
/// peers get every advantage.
void let_openblas_choose(char** argv);

/// Output of a Python program, run by the interpreter that the variable LOBE_BENCH_PYTHON names, else by python3;
/// empty where it fails, as without NumPy.
/// \param arguments script and arguments, as for a shell
[[nodiscard]] std::string run_python(const std::string& arguments);

/// The line that every bench begins with: device, driver, processors, load of the machine.
void print_setting(const std::string& device, const std::string& driver);

}  // namespace bench
