#pragma once

#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lobe/io/chosen_file.hpp"
#include "lobe/model/material.hpp"
#include "lobe/study/study.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace lobe::cli {

/// What a MATERIAL argument stands for: a material; a table, of which only the header is read before load(); or a
/// reflectance of another program, which is taken for the table that it becomes on a grid.
class Operand {
 public:
  /// \param text a specification, or the path of a material file, a table or a foreign file, as parse_file() takes it
  /// \param options of files
  /// \throws ArgumentError, IoError.
  explicit Operand(const std::string& text, const ReadOptions& options = {});
  /// A file of a study. \throws as load_reflectance().
  Operand(const std::string& name, const MaterialFile& file);
  explicit Operand(Material material) : text_(material.name), content_(std::move(material)) {}

  /// What lists and messages call it: the material's name, the table's path.
  [[nodiscard]] const std::string& label() const { return is_table() ? text_ : material().name; }

  /// No formula: a table, or what becomes one.
  [[nodiscard]] bool is_table() const { return !std::holds_alternative<Material>(content_); }
  [[nodiscard]] const Material& material() const { return std::get<Material>(content_); }
  /// The table without its values; of a foreign file that on its natural grid.
  [[nodiscard]] const BrdfTable& header() const {
    return is_foreign() ? foreign().shape : std::get<BrdfTable>(content_);
  }
  [[nodiscard]] std::size_t channels() const { return is_table() ? header().channels : material().channels(); }
  /// The whole table; of a foreign file also where its grid does not resolve it, which it then says. \throws IoError.
  [[nodiscard]] BrdfTable load() const;

  [[nodiscard]] bool is_foreign() const { return std::holds_alternative<Foreign>(content_); }
  /// What a foreign file holds.
  [[nodiscard]] const BrdfFunction& function() const { return foreign().function; }
  /// Whether it is a file that states standard deviations of its samples.
  [[nodiscard]] bool states_deviations() const {
    return is_foreign() ? function().has_deviations : table_states_deviations_;
  }
  /// The same once more, with replicates of samples within their standard deviations. \throws as load_measured()
  [[nodiscard]] BrdfFunction replicated(std::size_t replicates) const;
  /// A foreign file that is no matrix of cells, with values at any directions.
  [[nodiscard]] bool is_function() const { return is_foreign() && function().cells == nullptr; }

  /// Whether it has values at any directions: a material, or a function.
  [[nodiscard]] bool has_values() const { return !is_table() || is_function(); }
  /// What it is, of a table without its values: enough for choose_route().
  [[nodiscard]] Reflectance shape() const;
  /// What it is. \throws IoError.
  [[nodiscard]] Reflectance reflectance() const;

  /// Without its values, the table that this is, or that the material will be on a grid: what sizes follow from.
  [[nodiscard]] BrdfTable shape_on(const HemisphereGrid& grid) const;

 private:
  struct Foreign {
    BrdfFunction function;
    BrdfTable shape;
  };
  using Content = std::variant<Material, BrdfTable, Foreign>;

  [[nodiscard]] Content read(const std::string& text, const ReadOptions& options);
  [[nodiscard]] Content table_header();
  [[nodiscard]] static Foreign on_natural_grid(BrdfFunction function);
  [[nodiscard]] const Foreign& foreign() const { return std::get<Foreign>(content_); }

  std::string text_;
  ChosenFile file_ = {};  // of tables
  bool table_states_deviations_ = false;
  Content content_;
};

/// Without its values, the table that a function becomes on a grid.
[[nodiscard]] BrdfTable shape_of(const BrdfFunction& function, const HemisphereGrid& grid);

/// The names that all files with names give the channels of operands that are taken together; none: they have only
/// numbers.
[[nodiscard]] std::vector<std::string> channel_names(std::span<const Operand> operands);

/// What text calls the channels of operands that are taken together: their channel_names(), else "channel 0" and so
/// on.
[[nodiscard]] std::vector<std::string> channel_labels(std::span<const Operand> operands);

/// Whether no model of a material sees azimuths.
[[nodiscard]] bool is_isotropic(const Material& material);

/// Whether an argument is the path of a file of any kind, which need not exist, and no specification.
[[nodiscard]] bool names_file(const std::string& text);

/// Whether an argument is the path of a study file. \throws ArgumentError, IoError for files that cannot be read.
[[nodiscard]] bool names_study(const std::string& text);

}  // namespace lobe::cli
