#pragma once

#include <string>
#include <vector>

#include "lobe/model/material.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {

/// A material of a study, and where it stands.
struct PlacedMaterial {
  Material material;
  const toml::node* place = nullptr;   ///< that its name comes from
  const toml::node* origin = nullptr;  ///< the heading, or the row of a table
  std::string swept;                   ///< values that tell it from others of its family: "m=0.1, scale=0.5"
};

/// The materials of a table [[family]]: one per combination of what is swept, or one per row.
/// \throws ArgumentError with the place.
[[nodiscard]] std::vector<PlacedMaterial> read_family(const toml::table& table, std::size_t channels);

}  // namespace lobe
