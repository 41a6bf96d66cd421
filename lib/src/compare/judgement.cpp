#include "lobe/compare/judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/compare/rank_correlation.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::array<std::string_view, 3> kColumns{"method", "brdf", "distance"};

std::string at_line(std::size_t line) {
  return "line " + std::to_string(line) + ": ";
}

/// Fields of a line; what stands in quotes may hold the separator, and "" for a quote.
std::vector<std::string> fields_of(std::string_view line, char separator, std::size_t number) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"' && is_quoted && k + 1 < line.size() && line[k + 1] == '"') {
      fields.back() += line[k++];
    } else if (line[k] == '"') {
      is_quoted = !is_quoted;
    } else if (line[k] == separator && !is_quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[k];
    }
  }
  if (is_quoted) throw ArgumentError(at_line(number) + "a quote is not closed");
  for (auto& field : fields) {
    field = std::string(trim(field));
    if (!has_control_characters(field)) continue;
    throw ArgumentError(at_line(number) + "'" + excerpt(field) + "' has control characters; expected names of letters");
  }
  return fields;
}

char separator_of(std::string_view header) {
  for (const char separator : {';', '\t', ','}) {
    if (header.find(separator) != std::string_view::npos) return separator;
  }
  return ',';
}

/// Place of each of kColumns.
std::array<std::size_t, 3> columns_of(const std::vector<std::string>& header) {
  std::array<std::size_t, 3> places{};
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    const auto found =
        std::ranges::find_if(header, [&](const std::string& name) { return lowercase(name) == kColumns.at(c); });
    if (found == header.end()) {
      throw ArgumentError(at_line(1) + "no column '" + std::string(kColumns.at(c)) +
                          "'; expected the columns METHOD, BRDF and DISTANCE, separated by semicolons, commas or tabs");
    }
    places.at(c) = static_cast<std::size_t>(found - header.begin());
  }
  return places;
}

using Pairs = std::vector<std::size_t>;

/// The pairs of each group; each pair alone without groups.
std::vector<Pairs> groups_of(std::span<const std::string> group, std::size_t pairs) {
  std::vector<Pairs> groups;
  if (group.empty()) {
    for (std::size_t k = 0; k < pairs; ++k) groups.push_back({k});
    return groups;
  }
  std::map<std::string_view, Pairs> members;
  for (std::size_t k = 0; k < pairs; ++k) members[group[k]].push_back(k);
  for (auto& [name, list] : members) groups.push_back(std::move(list));
  return groups;
}

/// Percentile interval; samples in which a series is constant say nothing.
Interval interval_of(double value, std::vector<double> samples, double coverage) {
  std::erase_if(samples, [](double x) { return std::isnan(x); });
  if (samples.empty()) return {value, std::nan(""), std::nan("")};
  std::ranges::sort(samples);
  const auto quantile = [&](double share) {
    const double place = share * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, samples.size() - 1);
    return samples[below] + (place - static_cast<double>(below)) * (samples[above] - samples[below]);
  };
  return {value, quantile((1 - coverage) / 2), quantile((1 + coverage) / 2)};
}

void check(std::span<const double> computed, std::span<const double> judged, std::span<const std::string> group,
           const BootstrapOptions& options) {
  if (computed.size() != judged.size() || computed.size() < 3 || (!group.empty() && group.size() != judged.size())) {
    throw ArgumentError(std::to_string(computed.size()) + " computed distances of " + std::to_string(judged.size()) +
                        " judged pairs in " + std::to_string(group.size()) +
                        " groups; expected one for each of at least 3 pairs");
  }
  if (options.samples < 20) {
    throw ArgumentError("intervals by " + std::to_string(options.samples) + " samples; expected at least 20");
  }
  if (!(options.coverage > 0 && options.coverage < 1)) {
    throw ArgumentError("coverage of intervals is " + shortest(options.coverage) + "; expected a value in (0, 1)");
  }
}

}  // namespace

std::vector<Judgement> parse_judgements(std::string_view text) {
  std::vector<Judgement> judgements;
  std::set<std::pair<std::string, std::string>> known;
  char separator = ',';
  std::array<std::size_t, 3> columns{};
  bool has_header = false;
  std::size_t number = 0;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (const std::string_view line : split(text, '\n')) {
    ++number;
    if (trim(line).empty()) continue;
    if (!has_header) separator = separator_of(line);
    const auto fields = fields_of(trim(line), separator, number);
    if (!has_header) {
      columns = columns_of(fields);
      has_header = true;
      continue;
    }
    if (fields.size() <= std::ranges::max(columns)) {
      throw ArgumentError(at_line(number) + std::to_string(fields.size()) +
                          " fields; expected as many as there are columns");
    }
    Judgement judgement{fields[columns[0]], fields[columns[1]], 0};
    if (!parse_number(fields[columns[2]], judgement.distance)) {
      throw ArgumentError(at_line(number) + "'" + fields[columns[2]] + "' is no distance; expected a number");
    }
    if (!known.emplace(lowercase(judgement.method), judgement.material).second) {
      throw ArgumentError(at_line(number) + "'" + judgement.method + "' of '" + judgement.material +
                          "' is judged a second time; expected a row for each pair");
    }
    judgements.push_back(std::move(judgement));
  }
  if (judgements.empty()) {
    throw ArgumentError("no judgements; expected a line METHOD;BRDF;DISTANCE and a line for each judged pair");
  }
  return judgements;
}

JudgementCorrelation judgement_correlation(std::span<const double> computed, std::span<const double> judged,
                                           std::span<const std::string> group, const BootstrapOptions& options) {
  check(computed, judged, group, options);
  const double rho = spearman(computed, judged);
  const double tau = kendall(computed, judged);
  const auto groups = groups_of(group, judged.size());
  std::vector<double> rhos(options.samples);
  std::vector<double> taus(options.samples);
  parallel_for(options.samples, [&](std::size_t sample) {
    // Each sample has its own engine, so that threads make no difference.
    std::seed_seq seeds{options.seed, static_cast<std::uint64_t>(sample)};
    std::mt19937_64 engine(seeds);
    std::vector<double> a;
    std::vector<double> b;
    for (std::size_t draw = 0; draw < groups.size(); ++draw) {
      for (const std::size_t pair : groups[engine() % groups.size()]) {
        a.push_back(computed[pair]);
        b.push_back(judged[pair]);
      }
    }
    rhos[sample] = spearman(a, b);
    taus[sample] = kendall(a, b);
  });
  return {interval_of(rho, std::move(rhos), options.coverage), interval_of(tau, std::move(taus), options.coverage)};
}

}  // namespace lobe
