#include "lobe/material_file.hpp"

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/model.hpp"

namespace lobe {
namespace {

/// A basic string of TOML 1.0.
std::string toml_string(std::string_view text) {
  std::string literal = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      literal += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      literal += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      literal += c;
    }
  }
  return literal + '"';
}

/// The shortest floating-point number of TOML that reads back as the same.
std::string toml_number(double value) {
  const std::string text = shortest(value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string toml_weight(const std::vector<double>& weight) {
  if (weight.size() == 1) return toml_number(weight.front());
  std::string list;
  for (const double value : weight) list += (list.empty() ? "" : ", ") + toml_number(value);
  return "[" + list + "]";
}

}  // namespace

std::string material_toml(const Material& material, std::string_view comment) {
  std::string text;
  if (!comment.empty()) {
    if (comment.ends_with('\n')) comment.remove_suffix(1);
    for (const auto line : split(comment, '\n')) {
      std::string clean = line.empty() ? "#" : "# " + std::string(line);
      for (char& c : clean) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
      }
      text += clean + "\n";
    }
    text += '\n';
  }
  if (!material.name.empty()) text += "name = " + toml_string(material.name) + "\n";
  if (!material.family.empty()) text += "family = " + toml_string(material.family) + "\n";
  for (const Term& term : material.terms) {
    const Model& model = find_model(term.model);
    if (term.values.size() != model.parameters.size() || term.weight.empty()) {
      throw ArgumentError("a term of material '" + material.name + "' does not fit its model '" + term.model + "'");
    }
    text += "\n[[terms]]\nmodel = " + toml_string(term.model) + "\n";
    for (std::size_t i = 0; i < term.values.size(); ++i) {
      text += std::string(model.parameters[i].name) + " = " + toml_number(term.values[i]) + "\n";
    }
    text += "scale = " + toml_weight(term.weight) + "\n";
  }
  return text;
}

void save_material(const Material& material, const std::filesystem::path& path, bool overwrite,
                   std::string_view comment) {
  write_text(path, overwrite, material_toml(material, comment));
}

}  // namespace lobe
