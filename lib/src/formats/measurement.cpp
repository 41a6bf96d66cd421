#include "lobe/formats/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "formats/replicates.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "table/as_function.hpp"

namespace lobe {
namespace {

/// The standard deviation of a sample of two numbers or more.
double scatter(std::span<const double> numbers) {
  const auto count = static_cast<double>(numbers.size());
  double mean = 0;
  for (const double x : numbers) mean += x / count;
  double squares = 0;
  for (const double x : numbers) squares += (x - mean) * (x - mean);
  return std::sqrt(squares / (count - 1));
}

/// A function with the columns of another one, in this order.
BrdfFunction with_columns(const BrdfFunction& brdf, std::vector<Eigen::Index> columns, std::size_t replicates) {
  BrdfFunction chosen = brdf;
  chosen.replicates = replicates;
  chosen.channels.clear();
  for (const Eigen::Index column : columns) chosen.channels.push_back(brdf.channels[static_cast<std::size_t>(column)]);
  chosen.wavelengths.clear();
  chosen.cells = nullptr;
  chosen.ring_cells = nullptr;
  chosen.samples = nullptr;
  chosen.at = [at = brdf.at, columns = std::move(columns)](std::span<const Directions> pairs) {
    const BrdfValues all = at(pairs);
    BrdfValues found{all.value(Eigen::all, columns), {}};
    if (all.error.size() > 0) found.error = all.error(Eigen::all, columns);
    return found;
  };
  return chosen;
}

/// Products of one set of channels, all together.
struct Combined {
  Eigen::MatrixXd gram;
  Eigen::MatrixXd squared_distance;

  [[nodiscard]] double norm(Eigen::Index i) const { return std::sqrt(std::max(gram(i, i), 0.0)); }
  [[nodiscard]] double distance(Eigen::Index i, Eigen::Index j) const {
    return std::sqrt(std::max(squared_distance(i, j), 0.0));
  }
  [[nodiscard]] double angle(Eigen::Index i, Eigen::Index j) const {
    const double norms = norm(i) * norm(j);
    if (norms == 0) return std::numeric_limits<double>::quiet_NaN();
    return std::acos(std::clamp(gram(i, j) / norms, -1.0, 1.0));
  }
};

Combined combined(std::span<const Metric> channels, std::span<const double> weights) {
  const Eigen::Index n = channels.front().gram.rows();
  Combined sum{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    sum.gram += weights[c] * channels[c].gram;
    sum.squared_distance += weights[c] * channels[c].distance.cwiseAbs2();
  }
  return sum;
}

ProductDeviations deviations_of(const std::vector<Combined>& replicates) {
  const Eigen::Index n = replicates.front().gram.rows();
  ProductDeviations found{Eigen::MatrixXd(n, n), Eigen::VectorXd(n), Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  std::vector<double> numbers(replicates.size());
  const auto over = [&](const auto& number_of) {
    std::ranges::transform(replicates, numbers.begin(), number_of);
    return scatter(numbers);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    found.norm(i) = over([&](const Combined& r) { return r.norm(i); });
    for (Eigen::Index j = 0; j < n; ++j) {
      found.gram(i, j) = over([&](const Combined& r) { return r.gram(i, j); });
      found.distance(i, j) = i == j ? 0 : over([&](const Combined& r) { return r.distance(i, j); });
      found.angle(i, j) = i == j ? 0 : over([&](const Combined& r) { return r.angle(i, j); });
    }
  }
  return found;
}

}  // namespace

std::size_t own_channels(const BrdfFunction& brdf) {
  return brdf.channels.size() / (1 + brdf.replicates);
}

std::vector<double> measurement_deviations(const BrdfFunction& brdf, std::span<const double> numbers) {
  if (numbers.size() != brdf.channels.size()) {
    throw ArgumentError("deviations of " + std::to_string(numbers.size()) + " numbers; expected one for each of the " +
                        std::to_string(brdf.channels.size()) + " channels of '" + brdf.name + "'");
  }
  std::vector<double> deviations;
  if (brdf.replicates < 2) return deviations;
  const std::size_t own = own_channels(brdf);
  for (std::size_t c = 0; c < own; ++c) {
    std::vector<double> copies;
    for (std::size_t k = own + c; k < numbers.size(); k += own) copies.push_back(numbers[k]);
    deviations.push_back(scatter(copies));
  }
  return deviations;
}

std::vector<std::vector<double>> measurement_deviations(const BrdfFunction& brdf, const Eigen::MatrixXd& numbers) {
  std::vector<std::vector<double>> deviations;
  for (const auto& row : numbers.rowwise()) {
    const auto found = measurement_deviations(brdf, std::vector<double>(row.begin(), row.end()));
    deviations.resize(found.size());
    for (std::size_t c = 0; c < found.size(); ++c) deviations[c].push_back(found[c]);
  }
  return deviations;
}

BrdfFunction load_replicated_table(const std::filesystem::path& path, const ReadOptions& options) {
  constexpr std::size_t kMostReplicated = 50'000'000;  // values with their replicates
  BrdfTable table = load_table(path);
  const TableValues deviations = load_table_deviations(path);
  table.mirror.clear();
  table.retro.clear();
  table.factors.clear();
  table.source.clear();
  ReadOptions choice = options;
  choice.replicates = 0;
  const std::size_t replicates =
      deviations.empty() ? 0 : possible_replicates(options.replicates, table.values.size(), kMostReplicated);
  BrdfTable all = with_channels(table, choice);
  const BrdfTable own = all;
  const auto noise = [&](const auto& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  };
  const Eigen::MatrixXd copies =
      replicates > 0 ? with_replicates(noise(table.values), noise(deviations), replicates) : Eigen::MatrixXd();
  for (std::size_t k = 1; k <= replicates; ++k) {
    const auto column = copies.col(static_cast<Eigen::Index>(k));
    std::ranges::copy(column, table.values.begin());
    const BrdfTable copy = with_channels(table, choice);
    all.values.insert(all.values.end(), copy.values.begin(), copy.values.end());
    all.error.insert(all.error.end(), own.error.begin(), own.error.end());
    all.channels += own.channels;
  }
  const auto names = as_function(own).channels;
  all.channel_names.clear();
  for (std::size_t k = 0; k <= replicates; ++k) {
    for (const auto& name : names) {
      all.channel_names.push_back(k == 0 ? name : name + ", replicate " + std::to_string(k));
    }
  }
  BrdfFunction brdf = as_function(all);
  brdf.has_deviations = !deviations.empty();
  brdf.replicates = replicates;
  return brdf;
}

std::vector<BrdfFunction> aligned_replicates(std::span<const BrdfFunction> functions,
                                             std::span<const std::size_t> source) {
  if (!source.empty() && source.size() != functions.size()) {
    throw ArgumentError(std::to_string(source.size()) + " sources of " + std::to_string(functions.size()) +
                        " functions; expected one for each");
  }
  std::size_t own = 1;
  std::size_t replicates = 0;
  for (const auto& function : functions) {
    own = std::max(own, own_channels(function));
    if (function.replicates > 0) {
      replicates = replicates == 0 ? function.replicates : std::min(replicates, function.replicates);
    }
  }
  const std::set<std::size_t> distinct(source.begin(), source.end());
  const std::size_t sources = source.empty() ? functions.size() : distinct.size();
  const std::size_t step = std::max<std::size_t>(1, replicates / std::max<std::size_t>(1, sources));
  std::vector<BrdfFunction> aligned;
  for (std::size_t f = 0; f < functions.size(); ++f) {
    const BrdfFunction& function = functions[f];
    const std::size_t channels = own_channels(function);
    if (channels != 1 && channels != own) {
      throw ArgumentError("'" + function.name + "' has " + std::to_string(channels) + " channels; expected 1 or " +
                          std::to_string(own));
    }
    const std::size_t rank =
        source.empty() ? f : static_cast<std::size_t>(std::distance(distinct.begin(), distinct.find(source[f])));
    std::vector<Eigen::Index> columns;
    for (std::size_t k = 0; k <= replicates; ++k) {
      const std::size_t copy = k == 0 || function.replicates == 0 ? 0 : 1 + (k - 1 + rank * step) % replicates;
      for (std::size_t c = 0; c < own; ++c) {
        columns.push_back(static_cast<Eigen::Index>(copy * channels + (channels == 1 ? 0 : c)));
      }
    }
    aligned.push_back(with_columns(function, std::move(columns), replicates));
  }
  return aligned;
}

MetricDeviations metric_deviations(const MetricResult& replicated, std::size_t own, std::span<const double> weights) {
  const std::size_t channels = replicated.channels.size();
  if (own == 0 || channels < 3 * own || channels % own != 0) {
    throw ArgumentError("products of " + std::to_string(channels) + " channels, " + std::to_string(own) +
                        " of them own; expected two replicates of all at least");
  }
  if (!weights.empty() && weights.size() != own) {
    throw ArgumentError(std::to_string(weights.size()) + " channel weights for " + std::to_string(own) +
                        " channels; expected one per channel");
  }
  const std::vector<double> equal(own, 1 / static_cast<double>(own));
  const std::span<const Metric> all = replicated.channels;
  std::vector<Combined> together;
  std::vector<std::vector<Combined>> apart(own);
  constexpr double kOne = 1;
  for (std::size_t first = own; first < channels; first += own) {
    together.push_back(combined(all.subspan(first, own), weights.empty() ? std::span<const double>(equal) : weights));
    for (std::size_t c = 0; c < own; ++c) apart[c].push_back(combined(all.subspan(first + c, 1), {&kOne, 1}));
  }
  MetricDeviations found{deviations_of(together), {}};
  for (std::size_t c = 0; own > 1 && c < own; ++c) found.channels.push_back(deviations_of(apart[c]));
  return found;
}

}  // namespace lobe
