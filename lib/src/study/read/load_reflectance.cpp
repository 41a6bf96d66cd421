#include "lobe/study/load_reflectance.hpp"

#include "formats/format.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

Reflectance load_reflectance(const std::filesystem::path& path, const ReadOptions& options) {
  if (is_table_file(path)) return with_channels(load_table(path), options);
  if (is_measured_file(path)) return load_measured(path, options);
  if (path.extension() != ".toml") return load_measured(path, options);  // which says what is wrong
  if (has_choices(options)) {
    throw ArgumentError(path.string() + " is a material file; expected no choice of channels or angles");
  }
  return load_material_file(path);
}

Material with_adjustments(Material material, std::span<const Adjustment> adjustments) {
  for (const Adjustment& adjustment : adjustments) {
    material.adjustments.push_back(adjustment);
    material.name += "@" + to_string(adjustment);
  }
  return material;
}

Reflectance load_reflectance(const ChosenFile& file) {
  Reflectance loaded = load_reflectance(file.path, file.options);
  if (loaded.formula() != nullptr) return with_adjustments(*loaded.formula(), file.adjustments);
  refuse_adjustments(file);
  return loaded;
}

}  // namespace lobe
