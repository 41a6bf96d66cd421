#include "study/study_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "lobe/any_material.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

/// A file's table, and what is to be said of it.
struct FileTable {
  BrdfTable table;
  nlohmann::ordered_json description;
};

FileTable load_file(const MaterialFile& file, const HemisphereGrid& grid, const TabulateOptions& options) {
  const AnyMaterial loaded = load_material(file.path, file.options);
  FileTable result;
  result.description["file"] = file.name;
  if (const auto* table = std::get_if<BrdfTable>(&loaded)) {
    result.table = resample(*table, grid);
    result.description["expression"] = table->expression;
    return result;
  }
  const auto* function = std::get_if<BrdfFunction>(&loaded);
  if (function == nullptr) {
    throw ArgumentError(file.name + " is a material file; expected a file of measurements or a table");
  }
  result.table = tabulate(*function, grid, options);
  result.description["format"] = function->format;
  result.description["conventions"] = function->conventions;
  result.description["channels"] = function->channels;
  result.description["remarks"] = function->remarks;
  return result;
}

void require_channels(const BrdfTable& table, const Material& material, const Study& study) {
  const std::size_t count = study.channels.size();
  if (table.channels == 1 || table.channels == count) return;
  throw ArgumentError(
      fmt::format("'{}' has {} channels ({}) and the study {}; choose some by 'channels', 'wavelengths' "
                  "or 'luminance' of [[measured]], or name those of the study",
                  material.name, table.channels, fmt::join(table.channel_names, ", "), count));
}

}  // namespace

bool needs_tables(const Study& study) {
  return study.grid.has_value() || !study.files.empty();
}

StudyTables tabulate_study(const Device& device, const Study& study, const ProgressCallback& progress) {
  const HemisphereGrid grid = study.grid.value_or(HemisphereGrid::gauss(32, 64));
  const TabulateOptions options{.precision = study.precision, .allow_unresolved = study.allow_unresolved};
  StudyTables result;
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(study.materials.size());
    if (progress && !progress("tabulating", done)) throw Cancelled("cancelled");
    const Material& material = study.materials[i];
    if (study.files.empty() || !study.files[i]) {
      result.tables.push_back(tabulate(device, material, grid, options));
      result.files.emplace_back();
      continue;
    }
    FileTable loaded = load_file(*study.files[i], grid, options);
    require_channels(loaded.table, material, study);
    loaded.description["resolution_error"] = loaded.table.resolution_error;
    const nlohmann::ordered_json named{{"name", material.name}, {"family", material.family}};
    nlohmann::ordered_json description = named;
    description.update(loaded.description);
    result.files.push_back(description.dump());
    result.tables.push_back(std::move(loaded.table));
  }
  return result;
}

}  // namespace lobe
