#pragma once

#include <map>
#include <string>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "operation_counts.hpp"

namespace bench {

inline constexpr std::size_t kLobes = 64;
inline constexpr std::size_t kNodes = 2048;

/// Lobes of one model, to be timed.
struct CountedLobes {
  std::string name;
  lobe::LobeBatch batch;
  double terms;  ///< terms of the series in it; 0 without
};

/// A ratio of times: median over rounds, and median distance of the rounds from it.
struct Ratio {
  double value;
  double error;
};
[[nodiscard]] Ratio ratio_of(const std::vector<double>& rounds, const std::vector<double>& others);

struct ModelCost {
  double seconds;              ///< time of an evaluation, with all processors at work
  std::vector<double> rounds;  ///< processor seconds of each round, of all evaluations
  Ratio to_phong;
  double share;  ///< share of the throughput that its operations would allow
  OperationCounts counts;
};

struct CostTable {
  std::vector<ModelCost> models;
  double base;                               ///< seconds of loads and stores of an evaluation
  std::map<std::string, double> operations;  ///< seconds that an operation adds
};

/// Times models and the operations that they are made of, all in the same rounds.
[[nodiscard]] CostTable measure_costs(const lobe::Device& device, const std::vector<CountedLobes>& models,
                                      lobe::Precision precision, int rounds);

/// Name of this machine's widest vectors.
[[nodiscard]] std::string vector_extension();

}  // namespace bench
