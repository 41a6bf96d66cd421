#include "interface/model_page.hpp"

#include <fmt/format.h>

#include <span>

#include "core/text.hpp"
#include "interface/model_text.hpp"

namespace lobe::cli {
namespace {

std::string heading(std::string_view name, std::string_view summary) {
  return fmt::format("<h1>{}</h1>\n<p class=\"summary\">{}</p>\n", escaped_markup(name), escaped_markup(summary));
}

std::string formula_section(std::string_view formula, std::string_view unit) {
  return fmt::format(
      "<h2 id=\"formula\">Formula</h2>\n<pre class=\"formula\"><code>{}</code></pre>\n"
      "<p>{} Symbols are those of the <a href=\"../docs/conventions.md#notation\">notation</a>.</p>\n",
      escaped_markup(formula), unit);
}

std::string parameters_section(std::span<const Parameter> parameters) {
  std::string text = "<h2 id=\"parameters\">Parameters</h2>\n";
  if (parameters.empty()) return text + "<p>None.</p>\n";
  text +=
      "<table>\n<thead><tr><th>name</th><th>from</th><th>to</th><th>unit</th><th>default</th><th>meaning</th></tr>"
      "</thead>\n";
  for (const auto& parameter : parameters) {
    text += fmt::format("<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        escaped_markup(parameter.name), bound_text(parameter.minimum), bound_text(parameter.maximum),
                        parameter.unit == "1" ? "" : escaped_markup(parameter.unit),
                        parameter.default_value ? shortest(*parameter.default_value) : "",
                        escaped_markup(parameter.description));
  }
  return text + "</table>\n";
}

std::string source_section(std::string_view source, std::string_view kernel) {
  std::string text = fmt::format("<h2 id=\"source\">Source</h2>\n<p>{}.</p>\n", escaped_markup(source));
  if (!kernel.empty()) {
    const auto file = kernel.substr(kernel.find("kernels/"));
    text += fmt::format("<p>Computed by <a href=\"{}\"><code>{}</code></a>.</p>\n", kernel, file);
  }
  return text;
}

std::string properties_section(const Traits& traits) {
  const auto row = [](std::string_view name, bool holds, std::string_view meaning) {
    return fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", name, holds ? "yes" : "no", meaning);
  };
  return "<h2 id=\"properties\">Properties</h2>\n<p>What holds for every value of the parameters; "
         "<a href=\"../docs/plausibility.md\">plausibility</a> has what is computed of it.</p>\n<table>\n" +
         row("isotropic", traits.isotropic, "a turn about the normal changes nothing") +
         row("reciprocal", traits.reciprocal, "f(L, V) = f(V, L)") +
         row("conserves energy", traits.conserves_energy, "no albedo exceeds 1") +
         row("not negative", traits.non_negative, "no value is below 0") +
         row("delta part", traits.has_delta, "reflects into single directions as well") + "</table>\n";
}

std::string console(std::string_view line) {
  return fmt::format("<pre class=\"console\"><code>{}</code></pre>\n", escaped_markup(line));
}

std::string link(std::string_view name, std::string_view page) {
  std::string breakable;  // at underscores
  for (const char c : name) breakable += c == '_' ? "_<wbr>" : std::string(1, c);
  return fmt::format("<a href=\"{}.html\"><code>{}</code></a>", page, breakable);
}

/// Captions of the pictures, one after the other.
std::string seen_on(const std::vector<ModelPicture>& pictures) {
  std::string text;
  for (const auto& picture : pictures) text += (text.empty() ? "" : "; ") + escaped_markup(picture.caption);
  return text;
}

}  // namespace

std::string html_text(const Model& model, std::string_view example, std::string_view kernel,
                      const std::vector<ModelPicture>& pictures) {
  std::string text = heading(model.name, model.family);
  if (!pictures.empty()) {
    text += "<figure class=\"model\">\n";
    for (const auto& picture : pictures) {
      text += fmt::format("<img src=\"{}\" alt=\"{}\">\n", picture.path, escaped_markup(picture.caption));
    }
    text += fmt::format("<figcaption><code>{}</code>: {}.</figcaption></figure>\n", escaped_markup(example),
                        seen_on(pictures));
  }
  text += formula_section(model.formula, "Values are in sr⁻¹.");
  text += parameters_section(model.parameters);
  text += properties_section(model.traits);
  text += source_section(model.source, kernel);
  text += "<h2 id=\"example\">Example</h2>\n";
  text += console(fmt::format("lobe eval {} --theta-in 45 --theta-out 40 --delta-phi 180", example));
  text += console(fmt::format("lobe albedo {} --theta 0,60,85", example));
  return text;
}

std::string html_text(const FactorModel& factor, std::string_view kernel) {
  return heading(factor.name, "a factor that any model may be multiplied by: reciprocal, isotropic, not negative") +
         formula_section(factor.formula, "A factor has no unit.") + parameters_section(factor.parameters) +
         source_section(factor.source, kernel);
}

std::string page_name(const FactorModel& factor) {
  return fmt::format("{}-factor", factor.name);
}

std::string catalogue_html(const std::vector<std::string>& thumbnails) {
  std::string text = heading("Models", fmt::format("{} models and {} factors on them, from the catalogue that the "
                                                   "command and the library read",
                                                   catalogue().size(), factors().size()));
  int number = 0;
  for (const auto& chapter : chapters()) {
    text += fmt::format("<h2 id=\"chapter-{}\">{}</h2>\n<table class=\"models\">\n", ++number, chapter.title);
    for (const auto* model : chapter.models) {
      const auto& thumbnail = thumbnails.at(static_cast<std::size_t>(model - catalogue().data()));
      text += fmt::format(
          "<tr><td>{}</td><td>{}<br>{}</td><td>{}</td><td>{}</td></tr>\n",
          thumbnail.empty()
              ? ""
              : fmt::format("<span class=\"sphere\" style=\"background-image: url({})\"></span>", thumbnail),
          link(model->name, model->name), escaped_markup(names_of(model->parameters)), escaped_markup(citation(*model)),
          traits_text(model->traits));
    }
    text += "</table>\n";
  }
  text +=
      "<h2 id=\"factors\">Factors</h2>\n"
      "<p>Written after a model, as in <code>phong:n=20*cos_max:p=0.5</code>.</p>\n<table>\n";
  for (const auto& factor : factors()) {
    text += fmt::format("<tr><td>{}</td><td><code>{}</code></td></tr>\n", link(factor.name, page_name(factor)),
                        escaped_markup(factor.formula));
  }
  return text +
         "</table>\n<h2 id=\"of-your-own\">Of your own</h2>\n<p>In a material or study file "
         "<code>model = \"custom\"</code> is <a href=\"../docs/formulas.md\">a formula of your own</a>; "
         "<code>\"profile\"</code> and <code>\"mixture\"</code> are patch-based models "
         "<a href=\"../docs/study-files.md\">by points</a>.</p>\n";
}

}  // namespace lobe::cli
