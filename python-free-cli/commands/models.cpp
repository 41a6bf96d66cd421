#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/model_text.hpp"
#include "interface/session.hpp"
#include "interface/terminal.hpp"
#include "lobe/model/model.hpp"

namespace lobe::cli {
namespace {

constexpr Text kModel{"MODEL"};

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
  std::vector<std::vector<std::string>> rows{{"model", "parameters", "source", "traits"}};
  std::vector<std::string_view> titles;  // of the chapter that begins with a row, else empty
  for (const auto& chapter : chapters()) {
    for (const auto* model : chapter.models) {
      rows.push_back({std::string(model->name), names_of(model->parameters), std::string(citation(*model)),
                      traits_text(model->traits)});
      titles.push_back(model == chapter.models.front() ? chapter.title : "");
    }
  }
  const bool color = session.colors_output();
  std::istringstream table(format_table(rows, rows.front().size(), color));
  std::string text;
  std::string line;
  std::getline(table, line);
  text += line + "\n";
  for (std::size_t row = 0; std::getline(table, line); ++row) {
    if (!titles[row].empty()) text += fmt::format("\n{}\n", bold(titles[row], color));
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

ExitCode execute_models(Session& session) {
  const auto& arguments = session.arguments();
  const std::string& name = arguments.text(kModel);
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
          .summary = "list the reflectance models, or explain one",
          .description =
              "Lists the reflectance models by chapter of the dissertation, with their sources and traits. With MODEL, "
              "prints its formula and where that comes from, its parameters with their ranges, and an example.",
          .positionals = {{.handle = kModel, .help = "model or factor to explain", .required = false}},
          .options = {json_option()},
          .examples = {{"all models", "lobe models"}, {"all about one model", "lobe models ward"}},
          .execute = execute_models};
}

}  // namespace lobe::cli
