#include "lobe/study/material_file.hpp"

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"

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

std::string toml_factor(const Factor& factor) {
  std::string text = "{name = " + toml_string(factor.name);
  const auto& parameters = find_factor(factor.name).parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    text += ", " + std::string(parameters[i].name) + " = " + toml_number(factor.values.at(i));
  }
  return text + "}";
}

std::string toml_list(const std::vector<double>& values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "" : ", ") + toml_number(value);
  return "[" + list + "]";
}

std::string toml_pumping(const Pumping& pumping) {
  std::string text = "pumping = {correction = " + toml_string(to_string(pumping.correction)) + ", albedos = [";
  for (const auto& curve : pumping.albedos) text += (&curve == pumping.albedos.data() ? "" : ", ") + toml_list(curve);
  return text + "]}\n";
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
  for (const std::string* name : {&material.name, &material.family}) {
    if (!has_control_characters(*name)) continue;
    throw ArgumentError("the name '" + excerpt(*name) + "' of a material has control characters; expected one line");
  }
  if (!material.name.empty()) text += "name = " + toml_string(material.name) + "\n";
  if (!material.family.empty()) text += "family = " + toml_string(material.family) + "\n";
  if (!material.adjustments.empty()) {
    std::string list;
    for (const Adjustment& adjustment : material.adjustments) {
      list += (list.empty() ? "" : ", ") + toml_string(to_string(adjustment));
    }
    text += "adjustments = [" + list + "]\n";
  }
  for (const Term& term : material.terms) {
    const auto parameters = parameter_names(term);
    if (term.values.size() != parameters.size() || term.weight.empty()) {
      throw ArgumentError("a term of material '" + material.name + "' does not fit its model '" + term.model + "'");
    }
    text += "\n[[terms]]\nmodel = " + toml_string(term.model) + "\n";
    if (term.formula) {
      text += "formula = " + toml_string(term.formula->text) + "\nwidth = " + toml_number(term.formula->width) +
              "\nreciprocal = " + (term.formula->reciprocal ? "true" : "false") + "\n";
    }
    for (std::size_t i = 0; i < term.values.size(); ++i) {
      text += parameters[i] + " = " + toml_number(term.values[i]) + "\n";
    }
    if (!term.factors.empty()) {
      std::string list;
      for (const Factor& factor : term.factors) list += (list.empty() ? "" : ", ") + toml_factor(factor);
      text += "factors = [" + list + "]\n";
    }
    if (term.pumping) text += toml_pumping(*term.pumping);
    const bool is_single = term.weight.size() == 1;
    text += "scale = " + (is_single ? toml_number(term.weight.front()) : toml_list(term.weight)) + "\n";
  }
  return text;
}

void save_material(const Material& material, const std::filesystem::path& path, bool overwrite,
                   std::string_view comment) {
  write_text(path, overwrite, material_toml(material, comment));
}

}  // namespace lobe
