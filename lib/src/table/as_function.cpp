#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"
#include "lobe/table/brdf_function.hpp"
#include "model/evaluate.hpp"
#include "model/traits.hpp"
#include "model/values.hpp"
#include "table/as_function.hpp"
#include "table/evaluate.hpp"

namespace lobe {
namespace {

std::vector<std::string> numbered(std::size_t channels) {
  if (channels == 1) return {"value"};
  std::vector<std::string> names;
  for (std::size_t c = 1; c <= channels; ++c) names.push_back(std::to_string(c));
  return names;
}

/// What evaluates a material on a device, made when it is needed, and again for more pairs at once.
struct KeptValues {
  explicit KeptValues(NodeMaking node_making) : making(node_making) {}

  NodeMaking making;
  std::mutex turn;
  std::optional<MaterialValues> values;
  std::size_t at_once = 0;

  Eigen::MatrixXd at(const Device& device, const Material& material, Precision precision,
                     std::span<const Directions> pairs) {
    if (pairs.empty()) return unchecked_values(device, material, pairs, precision);
    const std::size_t wanted = std::min(pairs.size(), MaterialValues::kAtOnce);
    if (!values || wanted > at_once) {
      values.emplace(device, material, precision, making, wanted);
      at_once = wanted;
    }
    return values->at(pairs);
  }
};

}  // namespace

void require_no_delta(const BrdfFunction& brdf, std::string_view expectation) {
  if (!brdf.cells || !brdf.cells->has_delta()) return;
  throw ArgumentError("'" + brdf.name + "' has delta parts; " + std::string(expectation));
}

BrdfFunction as_function(const Device& device, const Material& material, Precision precision) {
  const auto traits = [](const Term& term) { return traits_of(term); };
  if (std::ranges::any_of(material.terms, &Traits::has_delta, traits)) {
    throw ArgumentError("'" + material.name + "' has delta parts; expected a material with values in sr^-1");
  }
  BrdfFunction brdf;
  brdf.name = material.name;
  brdf.channels = numbered(material.channels());
  brdf.is_isotropic = std::ranges::all_of(material.terms, &Traits::isotropic, traits);
  brdf.is_bilateral = brdf.is_isotropic;
  brdf.is_reciprocal = is_reciprocal(material);
  brdf.is_concurrent = false;  // the device is
  const auto turn = std::make_shared<std::mutex>();
  brdf.at = [device, material, precision, turn](std::span<const Directions> pairs) {
    const std::scoped_lock lock(*turn);
    return BrdfValues{evaluate(device, material, pairs, precision), {}};
  };
  return brdf;
}

BrdfFunction kept_function(const Device& device, const Material& material, Precision precision, NodeMaking making) {
  BrdfFunction brdf = as_function(device, material, precision);
  const auto kept = std::make_shared<KeptValues>(making);
  brdf.at = [device, material, precision, kept](std::span<const Directions> pairs) {
    const std::scoped_lock lock(kept->turn);
    BrdfValues values{kept->at(device, material, precision, pairs), {}};
    require_finite(values.value, material.name, pairs);
    return values;
  };
  return brdf;
}

BrdfFunction as_function(const BrdfTable& table) {
  if (table.has_delta() && !table.grid.has_cells()) {
    throw ArgumentError("'" + table.expression + "' has delta parts; expected a table of values in sr^-1 alone");
  }
  BrdfFunction brdf;
  brdf.name = table.expression;
  brdf.conventions = table.conventions;
  brdf.channels = table.channel_names.empty() ? numbered(table.channels) : table.channel_names;
  brdf.is_isotropic = table.form == TableForm::isotropic;
  brdf.is_bilateral = brdf.is_isotropic;
  const auto shared = std::make_shared<const BrdfTable>(table);
  brdf.at = [shared](std::span<const Directions> pairs) {
    const auto estimates = evaluate(*shared, pairs);
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(shared->channels));
    values.error.resizeLike(values.value);
    for (std::size_t c = 0; c < estimates.size(); ++c) {
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto at = std::pair(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c));
        values.value(at.first, at.second) = estimates[c][i].value;
        values.error(at.first, at.second) = estimates[c][i].error;
      }
    }
    return values;
  };
  if (table.grid.has_cells()) brdf.cells = shared;
  return brdf;
}

}  // namespace lobe
