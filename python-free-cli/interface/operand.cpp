#include "interface/operand.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/model/model.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "lobe/study/study.hpp"

namespace lobe::cli {
namespace {

bool is_model(std::string_view text) {
  return std::ranges::find(catalogue(), text, &Model::name) != catalogue().end();
}

bool is_path(const std::string& text) {
  if (text == "-" || text.ends_with(".toml") || text.ends_with(".h5")) return true;
  // Names of models have neither; behind their colon (or '=', where it was forgotten) slashes stand between the values
  // of channels.
  const auto mark = text.find_first_of("/.");
  if (mark != std::string::npos && text.find_first_of(":=") > mark) return true;
  std::error_code ignored;
  return std::filesystem::is_regular_file(text, ignored) && !is_model(text);
}

bool is_table_path(const std::string& text) {
  return is_table_file(text) || (text.ends_with(".h5") && !is_measured_file(text));
}

/// Whether a file that is no table may be one of materials in TOML: by its name, or by its first character, with which
/// no measured file of numbers begins.
bool is_toml_path(const std::string& text) {
  if (text.ends_with(".toml")) return true;
  std::error_code ignored;
  if (is_measured_file(text) || !std::filesystem::is_regular_file(text, ignored)) return false;
  std::ifstream file(text);
  char first = '\0';
  file >> first;
  return first == '[' || first == '"' || first == '_' || std::isalpha(static_cast<unsigned char>(first)) != 0;
}

}  // namespace

BrdfTable shape_of(const BrdfFunction& function, const HemisphereGrid& grid) {
  BrdfTable shape;
  shape.grid = grid;
  shape.form = grid.is_product() && function.is_isotropic ? TableForm::isotropic : TableForm::general;
  shape.channels = function.channels.size();
  shape.channel_names = function.channels;
  shape.conventions = function.format + ": " + function.conventions;
  shape.expression = function.name + " (" + function.format + ")";
  shape.resolution_error = std::numeric_limits<double>::quiet_NaN();
  return shape;
}

std::vector<std::string> channel_names(const Reflectance& reflectance) {
  if (const BrdfTable* table = reflectance.table()) return table->channel_names;
  if (const BrdfFunction* function = reflectance.function()) return function->channels;
  return {};
}

std::vector<std::string> channel_names(std::span<const Operand> operands) {
  std::size_t channels = 0;
  for (const auto& operand : operands) channels = std::max(channels, operand.channels());
  std::vector<std::string> labels;
  bool is_common = true;
  for (const auto& operand : operands) {
    const auto names = channel_names(operand.shape());
    if (names.size() != channels) continue;
    is_common = is_common && (labels.empty() || labels == names);
    labels = names;
  }
  if (!is_common) labels.clear();
  return labels;
}

std::vector<std::string> channel_labels(std::span<const Operand> operands) {
  std::vector<std::string> labels = channel_names(operands);
  if (!labels.empty()) return labels;
  std::size_t channels = 0;
  for (const auto& operand : operands) channels = std::max(channels, operand.channels());
  for (std::size_t c = 0; c < channels; ++c) labels.push_back(fmt::format("channel {}", c + 1));
  return labels;
}

Reflectance Operand::read(const std::string& text, const ReadOptions& options) {
  file_ = parse_file(text, options);
  const std::string path = file_.path.string();
  if (!is_path(path)) {
    if (!file_.has_brackets) return parse_material(text);
    throw ArgumentError("'" + path + "' in '" + text + "' is no file; options in brackets are those of files");
  }
  if (is_table_path(path) || !is_toml_path(path)) {
    refuse_adjustments(file_);
    return is_table_path(path) ? table_header() : measured();
  }
  if (is_study_file(path)) {
    throw ArgumentError(path + " is a study file; expected a material ('lobe gram' and 'lobe distance-matrix' take " +
                        "the materials of a study)");
  }
  if (file_.has_brackets) throw ArgumentError("'" + path + "' is a material file; expected no options in brackets");
  return with_adjustments(load_material_file(path), file_.adjustments);
}

/// Which channels there are of the wanted ones shows in the whole table only.
Reflectance Operand::table_header() {
  states_deviations_ = lobe::states_deviations(file_.path);
  if (!has_choices(file_.options)) return load_table_header(file_.path);
  BrdfTable table = with_channels(load_table(file_.path), file_.options);
  table.values = {};
  return table;
}

Reflectance Operand::measured() {
  BrdfFunction function = load_measured(file_.path, file_.options);
  states_deviations_ = function.has_deviations;
  return function;
}

Operand::Operand(const std::string& text, const ReadOptions& options) : text_(text), shape_(read(text, options)) {}

Operand::Operand(const std::string& name, const MaterialFile& file)
    : text_(name), file_{file.path, file.options}, shape_(is_table_file(file.path) ? table_header() : measured()) {
  if (shape_.function() == nullptr) return;
  BrdfFunction function = *shape_.function();
  function.name = name;
  shape_ = std::move(function);
}

bool names_file(const std::string& text) {
  return is_path(text);
}

bool names_study(const std::string& text) {
  return is_path(text) && !is_table_path(text) && is_toml_path(text) && is_study_file(text);
}

Reflectance Operand::reflectance() const {
  return shape_.table() == nullptr ? shape_ : Reflectance(table());
}

BrdfTable Operand::table() const {
  return with_channels(load_table(file_.path), file_.options);
}

bool Operand::has_values() const {
  if (const BrdfFunction* function = shape_.function()) return function->cells == nullptr;
  return is_formula();
}

BrdfFunction Operand::replicated(std::size_t replicates) const {
  ReadOptions options = file_.options;
  options.replicates = replicates;
  if (shape_.table() != nullptr) {
    BrdfFunction function = load_replicated_table(file_.path, options);
    function.name = label();
    return function;
  }
  BrdfFunction function = load_measured(file_.path, options);
  function.name = shape_.name();
  return function;
}

BrdfTable Operand::shape_on(const HemisphereGrid& grid) const {
  if (const BrdfFunction* function = shape_.function()) return shape_of(*function, grid);
  if (const BrdfTable* table = shape_.table()) return *table;
  BrdfTable shape;
  shape.grid = grid;
  shape.form = grid.is_product() && shape_.is_isotropic() ? TableForm::isotropic : TableForm::general;
  shape.channels = shape_.channels();
  Material smooth = *shape_.formula();
  std::erase_if(smooth.terms, [](const Term& term) { return traits_of(term).has_delta; });
  if (!smooth.terms.empty()) shape.source = {std::move(smooth)};
  return shape;
}

}  // namespace lobe::cli
