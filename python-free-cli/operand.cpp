#include "operand.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "lobe/error.hpp"
#include "lobe/model.hpp"
#include "lobe/study.hpp"
#include "lobe/table_file.hpp"

namespace lobe::cli {
namespace {

bool is_model(std::string_view text) {
  return std::ranges::find(catalogue(), text, &Model::name) != catalogue().end();
}

bool is_path(const std::string& text) {
  if (text.ends_with(".toml") || text.ends_with(".h5")) return true;
  // Behind the colon of a model slashes stand between the values of channels.
  const auto slash = text.find('/');
  if (slash != std::string::npos) return text.find(':') > slash;
  std::error_code ignored;
  return std::filesystem::is_regular_file(text, ignored) && !is_model(text);
}

bool is_table_path(const std::string& text) {
  return text.ends_with(".h5") || is_table_file(text);
}

std::variant<Material, BrdfTable> read(const std::string& text) {
  if (!is_path(text)) return parse_material(text);
  if (is_table_path(text)) return load_table_header(text);
  if (is_study_file(text)) {
    throw ArgumentError(text + " is a study file; expected a material ('lobe gram' and 'lobe distance-matrix' take " +
                        "the materials of a study)");
  }
  return load_material(text);
}

}  // namespace

bool is_isotropic(const Material& material) {
  return std::ranges::all_of(material.terms, [](const Term& term) { return traits_of(term).isotropic; });
}

Operand::Operand(const std::string& text) : text_(text), content_(read(text)) {}

bool names_study(const std::string& text) {
  return is_path(text) && !is_table_path(text) && is_study_file(text);
}

BrdfTable Operand::load() const {
  return load_table(text_);
}

BrdfTable Operand::shape_on(const HemisphereGrid& grid) const {
  if (is_table()) return header();
  BrdfTable shape;
  shape.grid = grid;
  shape.form = grid.is_product() && is_isotropic(material()) ? TableForm::isotropic : TableForm::general;
  shape.channels = material().channels();
  Material smooth = material();
  std::erase_if(smooth.terms, [](const Term& term) { return traits_of(term).has_delta; });
  if (!smooth.terms.empty()) shape.source = {std::move(smooth)};
  return shape;
}

}  // namespace lobe::cli
