#include "study/read/analysis_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

FamilyFit parse_family_fit(std::string_view name) {
  constexpr std::array<std::string_view, 2> kNames{"linear", "non-negative"};
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw ArgumentError(fmt::format("unknown approximation '{}'{}", name, did_you_mean(name, kNames)));
  }
  return static_cast<FamilyFit>(found - kNames.begin());
}

/// A list of names, each once.
/// \param parse from a name, or ArgumentError
template <typename Parse>
auto read_names(const toml::node& node, std::string_view key, const Parse& parse) {
  std::vector<decltype(parse(std::string()))> list;
  for (const auto& entry : reader::array(node, key)) {
    const std::string name = reader::text(entry, fmt::format("an entry of {}", key));
    try {
      const auto value = parse(name);
      if (std::find(list.begin(), list.end(), value) != list.end()) {
        throw ArgumentError(fmt::format("'{}' is listed twice in {}; expected it once", name, key));
      }
      list.push_back(value);
    } catch (const ArgumentError& error) {
      reader::fail(entry, error.what());
    }
  }
  return list;
}

}  // namespace

std::string_view to_string(FamilyFit fit) {
  return fit == FamilyFit::linear ? "linear" : "non-negative";
}

void read_analyses(const toml::table& table, Study& study) {
  if (const toml::node* node = table.get("comparison_metrics")) {
    study.comparison_metrics = read_names(*node, "comparison_metrics", parse_literature_metric);
  }
  if (const toml::node* node = table.get("approximations")) {
    study.approximations = read_names(*node, "approximations", parse_family_fit);
  }
}

}  // namespace lobe
