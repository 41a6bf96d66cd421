#include "study/read/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/text.hpp"
#include "study/read/keys.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

struct Range {
  double first = 0;
  double last = 0;
  std::size_t count = 0;
};

Range read_range(const toml::table& table, std::string_view key, const std::string& what) {
  const toml::node& ends_node = reader::require(table, key, what);
  const std::vector<double> ends = reader::numbers(ends_node, std::string(key) + " of " + what);
  if (ends.size() != 2) {
    reader::fail(ends_node, fmt::format("{} of {} has {} values; expected two, [first, last]", key, what, ends.size()));
  }
  const toml::node& count_node = reader::require(table, "count", what);
  const auto* count = count_node.as_integer();
  if (count == nullptr || count->get() < 2 || count->get() > static_cast<std::int64_t>(kLargestSweep)) {
    reader::fail(count_node, fmt::format("count of {} is {}; expected a whole number from 2 to {}", what,
                                         count == nullptr ? reader::kind_of(count_node) : std::to_string(count->get()),
                                         kLargestSweep));
  }
  return {ends[0], ends[1], static_cast<std::size_t>(count->get())};
}

std::vector<double> spread(const Range& range) {
  std::vector<double> values;
  for (std::size_t i = 0; i < range.count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(range.count - 1);
    values.push_back((1 - t) * range.first + t * range.last);
  }
  return values;
}

std::vector<double> spread_logarithmically(const Range& range) {
  std::vector<double> values = spread({std::log(range.first), std::log(range.last), range.count});
  std::transform(values.begin(), values.end(), values.begin(), [](double x) { return std::exp(x); });
  values.front() = range.first;
  values.back() = range.last;
  return values;
}

/// As few digits as tell the values apart, but at least four.
std::vector<std::string> rounded_texts(const std::vector<double>& values) {
  constexpr int kDigits = 4;
  constexpr int kAllDigits = 17;
  const std::size_t distinct = std::set<double>(values.begin(), values.end()).size();
  std::vector<std::string> texts;
  for (int digits = kDigits; digits <= kAllDigits; ++digits) {
    texts.clear();
    for (const double value : values) texts.push_back(fmt::format("{:.{}g}", value, digits));
    if (std::set<std::string>(texts.begin(), texts.end()).size() == distinct) break;
  }
  return texts;
}

void require_positive(const Range& range, const toml::table& table, const std::string& what) {
  if (range.first > 0 && range.last > 0) return;
  reader::fail(*table.get("logspace"), fmt::format("logspace of {} goes from {} to {}; expected positive ends", what,
                                                   shortest(range.first), shortest(range.last)));
}

Sweep listed(std::string_view parameter, const toml::node& node, std::vector<double> values) {
  if (values.empty()) {
    reader::fail(node, fmt::format("'{}' sweeps over no values; expected at least one", parameter));
  }
  std::vector<std::string> texts(values.size());
  std::transform(values.begin(), values.end(), texts.begin(), shortest);
  return {std::string(parameter), &node, std::move(values), std::move(texts)};
}

}  // namespace

Sweep read_sweep(std::string_view parameter, const toml::node& node) {
  const std::string what = fmt::format("'{}'", parameter);
  if (node.is_array()) return listed(parameter, node, reader::numbers(node, what));
  if (!node.is_table()) {
    if (!node.is_number()) {
      reader::fail(node, fmt::format("{} is {}; expected a number, a list of numbers, {{values = [...]}}, "
                                     "{{linspace = [a, b], count = n}} or {{logspace = [a, b], count = n}}",
                                     what, reader::kind_of(node)));
    }
    return listed(parameter, node, {reader::number(node, what)});
  }
  const toml::table& table = *node.as_table();
  constexpr auto kKeys = names_of(kRangeKeys);
  reader::require_known_keys(table, kKeys, what);
  const auto kinds = std::count_if(kKeys.begin(), kKeys.begin() + 3, [&](auto key) { return table.contains(key); });
  if (kinds != 1) {
    reader::fail(node, fmt::format("{} has {} of 'values', 'linspace' and 'logspace'; expected one", what, kinds));
  }
  if (const toml::node* values = table.get("values")) {
    if (table.contains("count")) {
      reader::fail(reader::place_of(table, "count"),
                   fmt::format("{} has both 'values' and 'count'; expected no count", what));
    }
    return listed(parameter, *values, reader::numbers(*values, "values of " + what));
  }
  const bool is_linear = table.contains("linspace");
  const Range range = read_range(table, is_linear ? "linspace" : "logspace", what);
  if (!is_linear) require_positive(range, table, what);
  std::vector<double> values = is_linear ? spread(range) : spread_logarithmically(range);
  std::vector<std::string> texts = rounded_texts(values);
  return {std::string(parameter), &node, std::move(values), std::move(texts)};
}

std::vector<std::vector<std::size_t>> combine(const std::vector<Sweep>& sweeps,
                                              const std::vector<std::vector<std::size_t>>& groups,
                                              const toml::node& place) {
  std::vector<std::vector<std::size_t>> bundles = groups;
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    const auto has = [&](const auto& group) { return std::ranges::find(group, k) != group.end(); };
    if (std::ranges::none_of(groups, has)) bundles.push_back({k});
  }
  // A group stands where its first sweep does.
  std::ranges::sort(bundles, {}, [](const auto& bundle) { return std::ranges::min(bundle); });
  std::vector<std::size_t> lengths;
  std::size_t total = 1;
  for (const auto& bundle : bundles) {
    const Sweep* longest = &sweeps[bundle.front()];
    for (const std::size_t k : bundle) {
      const std::size_t length = sweeps[k].values.size();
      if (length > 1 && longest->values.size() > 1 && length != longest->values.size()) {
        reader::fail(*sweeps[k].place,
                     fmt::format("'{}' has {} values where '{}' has {}; zip expects as many", sweeps[k].parameter,
                                 length, longest->parameter, longest->values.size()));
      }
      if (length > longest->values.size()) longest = &sweeps[k];
    }
    lengths.push_back(longest->values.size());
    total *= lengths.back();
    if (total > kLargestSweep) {
      reader::fail(place, fmt::format("more than {} materials in one family; expected fewer", kLargestSweep));
    }
  }
  std::vector<std::vector<std::size_t>> combinations(total, std::vector<std::size_t>(sweeps.size()));
  for (std::size_t i = 0; i < total; ++i) {
    std::size_t rest = i;
    for (std::size_t b = bundles.size(); b-- > 0;) {
      for (const std::size_t k : bundles[b]) {
        combinations[i][k] = std::min(rest % lengths[b], sweeps[k].values.size() - 1);
      }
      rest /= lengths[b];
    }
  }
  return combinations;
}

}  // namespace lobe
