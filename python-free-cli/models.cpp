#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "core/text.hpp"
#include "example_value.hpp"
#include "lobe/model.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace lobe::cli {
namespace {

/// A bound of a range, short: "1e10" instead of "1e+10".
std::string bound_text(double value) {
  if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
  std::string text = fmt::format("{:.5g}", value);
  const auto mark = text.find('e');
  if (mark == std::string::npos) return text;
  return fmt::format("{}e{}", text.substr(0, mark), std::stoi(text.substr(mark + 1)));
}

std::string example_specification(const Model& model) {
  std::string text(model.name);
  char separator = ':';
  for (const auto& parameter : model.parameters) {
    text += fmt::format("{}{}={}", separator, parameter.name, shortest(example_value(parameter)));
    separator = ',';
  }
  return text;
}

std::string traits_text(const Traits& traits) {
  std::string text = traits.isotropic ? "isotropic" : "anisotropic";
  if (traits.reciprocal) text += ", reciprocal";
  if (traits.conserves_energy) text += ", conserves energy";
  if (traits.has_delta) text += ", has a delta part";
  if (!traits.non_negative) text += ", may be negative";
  return text;
}

std::string names_of(std::span<const Parameter> parameters) {
  std::string text;
  for (const auto& parameter : parameters) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", parameter.name);
  }
  return text.empty() ? "-" : text;
}

constexpr std::string_view kDissertation = "Neumann 2001, ";

/// Chapter of the equation that a source cites first; 0 beyond the dissertation.
int chapter_of(const Model& model) {
  if (!model.source.starts_with(kDissertation)) return 0;
  return model.source[model.source.find_first_of("0123456789", kDissertation.size())] - '0';
}

std::string_view chapter_title(int chapter) {
  constexpr std::array<std::string_view, 6> kTitles{"Beyond the dissertation",
                                                    "1 Introduction",
                                                    "2 Reflectance Models by Pumping up the Albedo Function",
                                                    "3 New Simple Reflectance Models for Specular Materials",
                                                    "4 Reflectance Models with Fast Importance Sampling",
                                                    "5 Central Concepts and Future Directions"};
  return kTitles.at(static_cast<std::size_t>(chapter));
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The end of a number like 2001 or 3.7.1.
std::size_t number_end(std::string_view text, std::size_t at) {
  while (at < text.size() &&
         (is_digit(text[at]) || (text[at] == '.' && at + 1 < text.size() && is_digit(text[at + 1])))) {
    ++at;
  }
  return at;
}

/// The start of a source without its remarks: "Burley 2012, section 5.3"; for the dissertation "eq. 4.2 and 4.7".
std::string_view citation(const Model& model) {
  const std::string_view source = model.source;
  std::size_t end = number_end(source, source.find_first_of("0123456789"));
  const auto follows = [&](std::string_view joint) {
    const std::size_t next = end + joint.size();
    return source.substr(end).starts_with(joint) && next < source.size() && is_digit(source[next]);
  };
  constexpr std::array<std::string_view, 5> kJoints{", eq. ", ", section ", " to ", " and ", ", "};
  for (;;) {
    const auto joint = std::ranges::find_if(kJoints, follows);
    if (joint == kJoints.end()) break;
    end = number_end(source, end + joint->size());
  }
  const std::size_t first = chapter_of(model) > 0 ? kDissertation.size() : 0;
  return source.substr(first, end - first);
}

Json parameters_json(std::span<const Parameter> parameters) {
  Json list = Json::array();
  for (const auto& parameter : parameters) {
    Json entry{{"name", parameter.name},
               {"unit", parameter.unit},
               {"minimum", to_json(parameter.minimum)},
               {"maximum", to_json(parameter.maximum)}};
    if (parameter.default_value) entry["default"] = to_json(*parameter.default_value);
    entry["description"] = parameter.description;
    list.push_back(std::move(entry));
  }
  return list;
}

Json model_json(const Model& model) {
  Json json{{"name", model.name}, {"family", model.family}, {"formula", model.formula}, {"source", model.source}};
  if (chapter_of(model) > 0) json["chapter"] = chapter_of(model);
  json["parameters"] = parameters_json(model.parameters);
  json["traits"] = {{"isotropic", model.traits.isotropic},
                    {"reciprocal", model.traits.reciprocal},
                    {"conserves_energy", model.traits.conserves_energy},
                    {"has_delta", model.traits.has_delta},
                    {"non_negative", model.traits.non_negative}};
  json["example"] = example_specification(model);
  return json;
}

Json factor_json(const FactorModel& factor) {
  return {{"name", factor.name},
          {"formula", factor.formula},
          {"source", factor.source},
          {"parameters", parameters_json(factor.parameters)}};
}

/// By chapter of the dissertation, the others last; then the factors.
void print_list(Session& session) {
  constexpr int kChapters = 5;
  std::vector<std::vector<std::string>> rows{{"model", "parameters", "source", "traits"}};
  std::vector<int> chapters;
  for (int turn = 1; turn <= kChapters + 1; ++turn) {
    const int chapter = turn % (kChapters + 1);
    for (const auto& model : catalogue()) {
      if (chapter_of(model) != chapter) continue;
      rows.push_back({std::string(model.name), names_of(model.parameters), std::string(citation(model)),
                      traits_text(model.traits)});
      chapters.push_back(chapter);
    }
  }
  const bool color = session.colors_output();
  std::istringstream table(format_table(rows, rows.front().size(), color));
  std::string text;
  std::string line;
  std::getline(table, line);
  text += line + "\n";
  for (std::size_t row = 0; std::getline(table, line); ++row) {
    if (row == 0 || chapters[row] != chapters[row - 1]) {
      text += fmt::format("\n{}\n", bold(chapter_title(chapters[row]), color));
    }
    text += line + "\n";
  }
  text += fmt::format("\n{}\n", bold("Factors on models, as in 'phong:n=20*cos_max:p=0.5'", color));
  std::vector<std::vector<std::string>> factor_rows{{"factor", "parameters", "value"}};
  for (const auto& factor : factors()) {
    factor_rows.push_back({std::string(factor.name), names_of(factor.parameters), std::string(factor.formula)});
  }
  text += format_table(factor_rows, factor_rows.front().size(), color);
  text +=
      "\nIn a material or study file: model = \"custom\", a formula of your own (docs/formulas.md); \"profile\" "
      "or\n\"mixture\", a patch-based model by points (docs/study-files.md)\n";
  session.print(text);
}

/// A line of an explanation.
void print_field(Session& session, std::string_view name, std::string_view text) {
  constexpr std::size_t kTextColumn = 14;
  session.print(fmt::format("  {:<{}}{}\n", name, kTextColumn - 2, wrap(text, kTextColumn)));
}

void print_parameters(Session& session, std::span<const Parameter> parameters) {
  if (parameters.empty()) print_field(session, "parameters", "none");
  for (const auto& parameter : parameters) {
    const std::string unit = parameter.unit == "1" ? "" : fmt::format(" {}", parameter.unit);
    const std::string otherwise =
        parameter.default_value ? fmt::format(" (default {})", shortest(*parameter.default_value)) : "";
    print_field(session, &parameter == parameters.data() ? "parameters" : "",
                fmt::format("{} from {} to {}{}{}: {}", parameter.name, bound_text(parameter.minimum),
                            bound_text(parameter.maximum), unit, otherwise, parameter.description));
  }
}

void print_factor(Session& session, const FactorModel& factor) {
  session.print(fmt::format("{} (factor on a model)\n", bold(factor.name, session.colors_output())));
  print_field(session, "formula", factor.formula);
  print_field(session, "source", factor.source);
  print_parameters(session, factor.parameters);
}

void print_model(Session& session, const Model& model) {
  session.print(fmt::format("{} ({})\n", bold(model.name, session.colors_output()), model.family));
  print_field(session, "formula", model.formula);
  print_field(session, "value", "sr^-1");
  print_field(session, "source", model.source);
  print_field(session, "traits", traits_text(model.traits));
  print_parameters(session, model.parameters);
  print_field(session, "example",
              fmt::format("lobe eval {} --theta-in 45 --theta-out 40 --delta-phi 180", example_specification(model)));
}

ExitCode execute(Session& session) {
  const auto& arguments = session.arguments();
  const std::string& name = arguments.text("MODEL");
  const auto factor = std::ranges::find(factors(), name, &FactorModel::name);
  const bool is_model = std::ranges::find(catalogue(), name, &Model::name) != catalogue().end();
  const Model* chosen = name.empty() || (factor != factors().end() && !is_model) ? nullptr : &find_model(name);
  if (session.wants_json()) {
    Json answer = json_answer("models");
    answer["units"] = {{"value", "sr^-1"}};
    answer["models"] = Json::array();
    for (const auto& model : catalogue()) {
      if (name.empty() || chosen == &model) answer["models"].push_back(model_json(model));
    }
    answer["factors"] = Json::array();
    for (const auto& each : factors()) {
      if (name.empty() || name == each.name) answer["factors"].push_back(factor_json(each));
    }
    session.print_json(answer);
  } else if (name.empty()) {
    print_list(session);
  } else {
    if (chosen != nullptr) print_model(session, *chosen);
    if (factor != factors().end()) print_factor(session, *factor);
  }
  return ExitCode::success;
}

}  // namespace

Command models_command() {
  return {.name = "models",
          .group = "Reference",
          .summary = "the reflectance models and factors, or one of them",
          .description =
              "Lists the reflectance models by chapter of the dissertation, with their sources and traits. With a "
              "MODEL: its formula, where that comes from, its parameters with their ranges, and an example.",
          .positionals = {{.name = "MODEL", .help = "model or factor to explain", .required = false}},
          .options = {json_option()},
          .examples = {{"what there is", "lobe models"}, {"all about one of them", "lobe models ward"}},
          .execute = execute};
}

}  // namespace lobe::cli
