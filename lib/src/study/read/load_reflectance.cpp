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

}  // namespace lobe
