#pragma once

#include <string>
#include <utility>
#include <variant>

#include "lobe/material.hpp"
#include "lobe/table.hpp"

namespace lobe::cli {

/// What a MATERIAL argument stands for: a material, or a table, of which only the header is read before load().
class Operand {
 public:
  /// \param text a specification, or the path of a material file or of a table. \throws ArgumentError, IoError.
  explicit Operand(const std::string& text);
  explicit Operand(Material material) : text_(material.name), content_(std::move(material)) {}

  /// What lists and messages call it: the material's name, the table's path.
  [[nodiscard]] const std::string& label() const { return is_table() ? text_ : material().name; }

  [[nodiscard]] bool is_table() const { return std::holds_alternative<BrdfTable>(content_); }
  [[nodiscard]] const Material& material() const { return std::get<Material>(content_); }
  /// The table without its values.
  [[nodiscard]] const BrdfTable& header() const { return std::get<BrdfTable>(content_); }
  [[nodiscard]] std::size_t channels() const { return is_table() ? header().channels : material().channels(); }
  /// The whole table. \throws IoError.
  [[nodiscard]] BrdfTable load() const;

  /// Without its values, the table that this is, or that the material will be on a grid: what sizes follow from.
  [[nodiscard]] BrdfTable shape_on(const HemisphereGrid& grid) const;

 private:
  std::string text_;
  std::variant<Material, BrdfTable> content_;
};

/// Whether no model of a material sees azimuths.
[[nodiscard]] bool is_isotropic(const Material& material);

/// Whether an argument is the path of a study file. \throws ArgumentError, IoError for files that cannot be read.
[[nodiscard]] bool names_study(const std::string& text);

}  // namespace lobe::cli
