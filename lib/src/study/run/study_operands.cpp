#include "study/run/study_operands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "lobe/core/error.hpp"
#include "lobe/study/load_reflectance.hpp"

namespace lobe {
namespace {

void require_channels(std::span<const std::string> channels, std::size_t count, const MaterialLabel& material,
                      const Study& study) {
  if (count == 1 || count == study.channels.size()) return;
  throw ArgumentError(fmt::format(
      "'{}' has {} channels ({}) and the study {}; choose some by 'channels', 'wavelengths' or 'luminance' of "
      "[[measured]], or name those of the study",
      material.name, count, fmt::join(channels, ", "), study.channels.size()));
}

/// A file, and what is to be said of it.
struct LoadedFile {
  Reflectance content;
  std::string description;  ///< JSON
};

LoadedFile load_file(const MaterialFile& file, const MaterialLabel& named, const Study& study) {
  Reflectance loaded = load_reflectance(file.path, file.options);
  nlohmann::ordered_json description{{"name", named.name}, {"family", named.family}, {"file", file.name}};
  if (const BrdfTable* table = loaded.table()) {
    require_channels(table->channel_names, table->channels, named, study);
    description["expression"] = table->expression;
    return {std::move(loaded), description.dump()};
  }
  const BrdfFunction* function = loaded.function();
  if (function == nullptr) {
    throw ArgumentError(file.name + " is a material file; expected a file of measurements or a table");
  }
  require_channels(function->channels, function->channels.size(), named, study);
  description["format"] = function->format;
  description["conventions"] = function->conventions;
  description["channels"] = function->channels;
  description["remarks"] = function->remarks;
  return {std::move(loaded), description.dump()};
}

}  // namespace

StudyOperands study_operands(const Study& study, const ProgressCallback& progress) {
  StudyOperands operands;
  const bool has_files = count_files(study) > 0;
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    const StudyMaterial& material = study.materials[i];
    if (const Material* formula = material.formula()) {
      operands.reflectances.emplace_back(*formula);
      if (has_files) operands.files.emplace_back();
      continue;
    }
    if (material.file() == nullptr) {
      throw ArgumentError(fmt::format("material '{}' is neither a formula nor a file", material.name()));
    }
    const double done = static_cast<double>(i) / static_cast<double>(study.materials.size());
    if (progress && !progress("reading", done)) throw Cancelled("cancelled");
    LoadedFile loaded = load_file(*material.file(), material.label(), study);
    operands.reflectances.push_back(std::move(loaded.content));
    operands.files.push_back(std::move(loaded.description));
  }
  return operands;
}

}  // namespace lobe
