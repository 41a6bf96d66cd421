#include "study/study_operands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <variant>

#include "lobe/any_material.hpp"
#include "lobe/error.hpp"
#include "lobe/function_metric.hpp"
#include "table/mixed_channels.hpp"

namespace lobe {
namespace {

/// A file, and what is to be said of it.
struct LoadedFile {
  std::variant<BrdfTable, BrdfFunction> content;
  std::string description;  ///< JSON
};

LoadedFile load_file(const MaterialFile& file, const Material& named) {
  AnyMaterial loaded = load_material(file.path, file.options);
  nlohmann::ordered_json description{{"name", named.name}, {"family", named.family}, {"file", file.name}};
  if (auto* table = std::get_if<BrdfTable>(&loaded)) {
    description["expression"] = table->expression;
    return {std::move(*table), description.dump()};
  }
  auto* function = std::get_if<BrdfFunction>(&loaded);
  if (function == nullptr) {
    throw ArgumentError(file.name + " is a material file; expected a file of measurements or a table");
  }
  description["format"] = function->format;
  description["conventions"] = function->conventions;
  description["channels"] = function->channels;
  description["remarks"] = function->remarks;
  return {std::move(*function), description.dump()};
}

void require_channels(std::span<const std::string> channels, std::size_t count, const Material& material,
                      const Study& study) {
  if (count == 1 || count == study.channels.size()) return;
  throw ArgumentError(fmt::format(
      "'{}' has {} channels ({}) and the study {}; choose some by 'channels', 'wavelengths' or 'luminance' of "
      "[[measured]], or name those of the study",
      material.name, count, fmt::join(channels, ", "), study.channels.size()));
}

bool needs_tables(const Study& study) {
  return study.grid.has_value() || !study.comparison_metrics.empty() ||
         std::ranges::any_of(study.lightings, takes_tables);
}

/// Makes of each material what the study needs.
class OperandMaker {
 public:
  OperandMaker(const Device& device, const Study& study)
      : device_(device),
        study_(study),
        makes_tables_(needs_tables(study)),
        makes_functions_(!study.grid),
        grid_(study.grid.value_or(HemisphereGrid::gauss(32, 64))),
        options_{.precision = study.precision, .allow_unresolved = study.allow_unresolved} {}

  void add(const Material& material, StudyOperands& operands) const {
    if (makes_functions_) operands.functions.push_back(as_function(device_, material));
    if (makes_tables_) operands.tables.push_back(comparable(tabulate(device_, material, grid_, options_)));
    operands.files.emplace_back();
  }

  void add(const Material& named, const MaterialFile& file, StudyOperands& operands) const {
    LoadedFile loaded = load_file(file, named);
    operands.files.push_back(std::move(loaded.description));
    if (const auto* table = std::get_if<BrdfTable>(&loaded.content)) {
      require_channels(table->channel_names, table->channels, named, study_);
      if (makes_functions_) operands.functions.push_back(as_function(*table));
      if (makes_tables_) operands.tables.push_back(comparable(resample(*table, grid_)));
      return;
    }
    auto& function = std::get<BrdfFunction>(loaded.content);
    require_channels(function.channels, function.channels.size(), named, study_);
    if (makes_tables_) operands.tables.push_back(comparable(tabulate(function, grid_, options_)));
    if (makes_functions_) operands.functions.push_back(std::move(function));
  }

 private:
  /// Comparison metrics want all channels of every table.
  [[nodiscard]] BrdfTable comparable(BrdfTable table) const {
    const auto channels = static_cast<Eigen::Index>(study_.channels.size());
    if (study_.comparison_metrics.empty() || channels == 1 || table.channels > 1) return table;
    return mixed_channels(std::move(table), Eigen::MatrixXd::Ones(channels, 1));
  }

  const Device& device_;
  const Study& study_;
  bool makes_tables_;
  bool makes_functions_;
  HemisphereGrid grid_;
  TabulateOptions options_;
};

}  // namespace

StudyOperands study_operands(const Device& device, const Study& study, const ProgressCallback& progress) {
  StudyOperands operands;
  if (study.files.empty() && !study.grid) return operands;
  const OperandMaker maker(device, study);
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(study.materials.size());
    if (progress && !progress("reading", done)) throw Cancelled("cancelled");
    if (study.files.empty() || !study.files[i]) {
      maker.add(study.materials[i], operands);
    } else {
      maker.add(study.materials[i], *study.files[i], operands);
    }
  }
  return operands;
}

}  // namespace lobe
