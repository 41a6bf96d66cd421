#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobe/formats/chosen_file.hpp"
#include "lobe/model/material.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/study/study.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace lobe::cli {

/// A MATERIAL argument as a reflectance, of which the values of tables are read by reflectance() alone.
class Operand {
 public:
  /// \param text a specification, or the path of a material file, a table or a measured file, as parse_file() takes it
  /// \param options of files
  /// \throws ArgumentError, IoError.
  explicit Operand(const std::string& text, const ReadOptions& options = {});
  /// A file of a study.
  /// \throws as load_reflectance().
  Operand(const std::string& name, const MaterialFile& file);
  explicit Operand(const Material& material) : text_(material.name), shape_(material) {}

  /// Name in lists and messages: the material's name, the path of a file.
  [[nodiscard]] const std::string& label() const { return is_formula() ? shape_.name() : text_; }
  [[nodiscard]] std::size_t channels() const { return shape_.channels(); }
  /// The reflectance, for tables without values: enough for choose_route().
  [[nodiscard]] const Reflectance& shape() const { return shape_; }
  /// What it is.
  /// \throws IoError.
  [[nodiscard]] Reflectance reflectance() const;

  /// Does the adjustments of formulas.
  /// \throws as adjusted()
  void adjust(const Device& device) { shape_ = adjusted(device, shape_); }

  /// Of a table what it is, read into a place of its own: tables may be as large as memory.
  /// \throws IoError.
  [[nodiscard]] BrdfTable table() const;

  /// Known by formulas, of which there may be tables on any grid.
  [[nodiscard]] bool is_formula() const { return shape_.formula() != nullptr; }
  /// Has values at any directions: formulas, or a function that is no matrix of cells.
  [[nodiscard]] bool has_values() const;

  /// Whether it is a file that states standard deviations of its samples.
  [[nodiscard]] bool states_deviations() const { return states_deviations_; }
  /// The reflectance again, with replicates of samples within their standard deviations.
  /// \throws as load_measured()
  [[nodiscard]] BrdfFunction replicated(std::size_t replicates) const;

  /// Without its values, the table that this is, or that it will be on a grid: what sizes follow from.
  [[nodiscard]] BrdfTable shape_on(const HemisphereGrid& grid) const;

 private:
  [[nodiscard]] Reflectance read(const std::string& text, const ReadOptions& options);
  [[nodiscard]] Reflectance table_header();
  [[nodiscard]] Reflectance measured();

  std::string text_;
  ChosenFile file_ = {};  // of tables and functions
  bool states_deviations_ = false;
  Reflectance shape_;
};

/// Without its values, the table that a function becomes on a grid.
[[nodiscard]] BrdfTable shape_of(const BrdfFunction& function, const HemisphereGrid& grid);

/// The names of a reflectance's channels; none: it has only numbers.
[[nodiscard]] std::vector<std::string> channel_names(const Reflectance& reflectance);

/// The names that all files with names give the channels of operands that are taken together; none: they have only
/// numbers.
[[nodiscard]] std::vector<std::string> channel_names(std::span<const Operand> operands);

/// Names of the channels of operands that are taken together: their channel_names(), else "channel 1" and so
/// on.
[[nodiscard]] std::vector<std::string> channel_labels(std::span<const Operand> operands);

/// Whether an argument is the path of a file of any kind, which need not exist, and no specification.
[[nodiscard]] bool names_file(const std::string& text);

/// Whether an argument is the path of a study file.
/// \throws ArgumentError, IoError for files that cannot be read.
[[nodiscard]] bool names_study(const std::string& text);

}  // namespace lobe::cli
