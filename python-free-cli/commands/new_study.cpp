#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>
#include <variant>
#include <vector>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/example_value.hpp"
#include "interface/model_text.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/session.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/files.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/material.hpp"
#include "lobe/model/model.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "lobe/study/study_schema.hpp"

namespace lobe::cli {
namespace {

constexpr Text kMeasuredOption{"measured"};
constexpr Words kModels{"models"};
constexpr Flag kSchema{"schema"};

namespace fs = std::filesystem;

constexpr std::string_view kHead = R"toml(# A study: materials, and what to compute of them.
#
#     lobe run {0} --dry-run    # what that takes
#     lobe run {0} -o out
#
# Lines with a # and no blank after it are switched off; take the # away, of all lines of a block, to switch them on.
# docs/study-files.md has every key, 'lobe models' the models, 'lobe models ward' the parameters of one.

# Families, materials and charts of other studies:
#include = ["families/metals.toml"]

[study]
title = "A new study"
{1}
tolerance = 1e-4                   # largest relative error of a product

# The files are called after the study file, unless:
#name = "new"

# These go into the results:
#comment = "What this study is for"
#references = ["Who measured or fitted what, where"]

# Distances of the literature beside those of the lightings, and how alike all of them rank pairs of materials:
#comparison_metrics = ["bieron-l2", "cube-root"]
#comparison_tolerance = 1e-2

# How well every family represents every material, by "linear" or "non-negative" combinations:
#approximations = ["non-negative"]

# How many materials are to stand for all (by default as many as set the clusters best apart), and how many nearest
# ones are listed for each:
#clusters = 3
#neighbours = 5

# Colours; 'scale' and parameters may then have a value for each: scale = [0.4, 0.2, 0.1].
#channels = ["r", "g", "b"]
#channel_weights = [0.2126, 0.7152, 0.0722]

# Models in single precision, which is enough down to a tolerance of 1e-5:
#precision = "single"

# Materials as tables on a grid ('lobe help grids') instead of by their formulas:
#grid = "gauss:32x64"
#allow_unresolved = true
)toml";

constexpr std::string_view kFamilies = R"toml(
# A family is a model with values for its parameters, one material for each: {values = [...]},
# {linspace = [first, last], count = n} and {logspace = [first, last], count = n}.
[[family]]
name = "Ward"
model = "ward"
m = {logspace = [0.05, 0.5], count = 4}

[[family]]
name = "Phong"
model = "phong"
n = [1, 10, 100]  # a list will do, too
)toml";

constexpr std::string_view kMaterials = R"toml(
# Several parameters that vary: every combination, or with zip the first values together, the second together, ...
#[[family]]
#name = "Cook-Torrance"
#model = "cook_torrance"
#m = [0.1, 0.2, 0.4]
#f0 = [0.9, 0.7, 0.5]
#zip = true
#label = "Cook-Torrance {m}"

# Groups of zip: these go together, and each with all the others.
#[[family]]
#name = "Glossy paint"
#terms = [
#{model = "lambert", scale = {values = [0.6, 0.3]}},
#{model = "ward", m = [0.1, 0.2, 0.4], scale = {values = [0.1, 0.05]}},
#]
#zip = [["lambert.scale", "ward.scale"]]

# A table of fits: "$column" stands for the entry of a row.
#[[family]]
#name = "Fits"
#terms = [{model = "lambert", scale = "$kd"}, {model = "ward", m = "$m", scale = "$ks"}]
#columns = ["name", "kd", "ks", "m"]
#rows = [
#["paper", 0.7, 0.01, 0.3],
#["brass", 0.04, 0.1, 0.05],
#]

# A single material, here the sum of two layers.
[[material]]
name = "varnished wood"
terms = [
  {model = "lambert", scale = 0.4},
  {model = "ward", m = 0.1, scale = 0.1},
]

# Functions that multiply a model, and what is done to the whole material; 'lobe help materials'.
#[[material]]
#name = "metal"
#model = "phong"
#n = 20
#factors = [{name = "cos_max", p = 0.5}]
#adjustments = ["pump:times=2", "normalise"]

# A formula of one's own, sr^-1; docs/formulas.md has its language and the names that it may use.
#[[material]]
#name = "retro"
#model = "custom"
#formula = "rho / pi * (1 + gain * cos_h)"
#rho = 0.4
#gain = 0.5

# A patch-based reflectance by points [distance in the base plane, value].
#[[material]]
#name = "drawn by hand"
#model = "profile"
#points = [[0, 4], [0.1, 1.5], [0.4, 0.2], [2, 0]]
)toml";

constexpr std::string_view kMeasured = R"toml(
# Files of measurements; 'lobe help files' lists the formats. Every file is a material.
#[[measured]]
#family = "measured"
#files = "measurements/*.csv"
)toml";

constexpr std::string_view kRest = R"toml(
# Printed figures to compute again; a run that misses one ends with status 1.
#[[published]]
#title = "Reflectance of a diffuse surface"
#quantity = "albedo"
#model = "lambert"
#theta = 60
#printed = "1.000"

# Curves over an angle, as numbers and as a picture.
#[[chart]]
#name = "albedo"
#title = "Albedos"
#quantity = "albedo"
#curves = [
#{label = "Ward, m = 0.2", model = "ward", m = 0.2},
#{label = "Phong, n = 20", model = "phong", n = 20},
#]
)toml";

/// The schema that comes with the command: where it is installed, or in the tree that the command is built in.
fs::path schema_path() {
  std::error_code code;
  const fs::path command = fs::read_symlink("/proc/self/exe", code);
  if (code) return {};
  const fs::path root = command.parent_path().parent_path();
  for (const auto& folder : {root / "share/lobe/studies", root.parent_path() / "studies"}) {
    if (fs::is_regular_file(folder / "study.schema.json", code)) return folder / "study.schema.json";
  }
  return {};
}

std::string in_quotes(std::string_view text) {
  std::string literal = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') literal += '\\';
    literal += c;
  }
  return literal + '"';
}

/// Half of a usual value, the value, and twice it, as far as the model takes them.
std::string swept(const Parameter& parameter) {
  const double usual = example_value(parameter);
  std::vector<std::string> values;
  for (const double factor : {0.5, 1.0, 2.0}) {
    const std::string value = shortest(std::clamp(factor * usual, parameter.minimum, parameter.maximum));
    if (values.empty() || values.back() != value) values.push_back(value);
  }
  return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string range_text(const Parameter& parameter) {
  const std::string unit = parameter.unit == "1" ? "" : fmt::format(" {}", parameter.unit);
  return fmt::format("{}, {:.5g} to {:.5g}{}", parameter.description, parameter.minimum, parameter.maximum, unit);
}

/// A family that sweeps the first parameter that has to be given; the others have usual values.
std::string family_of(const Model& model) {
  std::string text = fmt::format("\n# {}\n# {}\n[[family]]\nname = {}\nmodel = {}\n", model.formula, model.source,
                                 in_quotes(model.name), in_quotes(model.name));
  bool is_swept = false;
  for (const auto& parameter : model.parameters) {
    const bool may_be_left_out = parameter.default_value.has_value();
    const bool sweeps = !may_be_left_out && !is_swept;
    is_swept = is_swept || sweeps;
    text += fmt::format("{}{} = {}  # {}\n", may_be_left_out ? "#" : "", parameter.name,
                        sweeps ? swept(parameter) : shortest(example_value(parameter)), range_text(parameter));
  }
  return text;
}

/// The lightings under which all of the models have norms and products.
std::string lightings_of(const std::vector<std::string>& models) {
  constexpr std::string_view kMeaning = "# what distances are taken under; 'lobe help lightings'";
  std::vector<Material> examples;
  for (const auto& name : models) examples.push_back(parse_material(example_specification(find_model(name))));
  const auto without_norm = [&](const Lighting& lighting) {
    return std::ranges::find_if(examples,
                                [&](const auto& one) { return !are_measurable(std::span(&one, 1), lighting); });
  };
  const auto name_of = [&](auto example) { return models[static_cast<std::size_t>(example - examples.begin())]; };
  if (const auto found = without_norm(Lighting::daylight()); found != examples.end()) {
    return fmt::format("lightings = [\"mean-albedo\"]  {}; {} has no norm under others", kMeaning, name_of(found));
  }
  if (const auto found = without_norm(Lighting::point()); found != examples.end()) {
    return fmt::format("lightings = [\"daylight\"]  {}; {} has no norm under \"point\"", kMeaning, name_of(found));
  }
  if (!examples.empty() && !are_measurable(examples, Lighting::point())) {
    return fmt::format("lightings = [\"daylight\"]  {}; \"point\" does not take all of these together", kMeaning);
  }
  return fmt::format("lightings = [\"point\", \"daylight\"]  {}", kMeaning);
}

std::string families(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) {
    if (std::ranges::count(names, name) > 1) {
      throw ArgumentError(fmt::format("--models names '{}' twice; expected every model once", name));
    }
    text += family_of(find_model(name));
  }
  return text;
}

std::vector<fs::path> matches(const std::string& pattern) {
  std::vector<fs::path> paths = matching_files(pattern);
  if (paths.empty()) {
    throw IoError(fmt::format("no file matches '{}' of --measured; expected at least one", pattern));
  }
  return paths;
}

/// Option that makes one channel from a file with several.
std::string channel_choice(const fs::path& path) {
  const Reflectance material = load_reflectance(path);
  if (material.formula() != nullptr) {
    throw ArgumentError(
        fmt::format("{} is no file of measurements and no table; expected one of --measured", path.string()));
  }
  const BrdfFunction* function = material.function();
  const auto& channels = function != nullptr ? function->channels : material.table()->channel_names;
  if (channels.size() < 2) return "";
  for (const auto* luminance : {"rec709", "photopic"}) {
    try {
      static_cast<void>(load_reflectance(path, {.luminance = luminance}));
      return fmt::format("luminance = \"{}\"  # one channel of {}\n", luminance, channels.size());
    } catch (const ArgumentError&) {  // such channels it has not
    }
  }
  return fmt::format("channels = [{}]  # of {}\n", in_quotes(channels.front()), fmt::join(channels, ", "));
}

/// Paths in a study file start from its folder.
std::string measured(const std::string& pattern, const fs::path& output) {
  const fs::path first = matches(pattern).front();
  fs::path written = pattern;
  if (!output.empty() && written.is_relative()) {
    const fs::path folder = fs::absolute(output).parent_path();
    written = fs::absolute(written.parent_path()).lexically_normal().lexically_relative(folder.lexically_normal()) /
              written.filename();
  }
  return fmt::format("\n# Every file is a material. 'lobe help files' lists the formats.\n[[measured]]\nfiles = {}\n{}",
                     in_quotes(written.lexically_normal().string()), channel_choice(first));
}

std::string study_text(const Session& session, const fs::path& output) {
  const auto& arguments = session.arguments();
  const fs::path schema = schema_path();
  std::string text = schema.empty() ? "" : fmt::format("#:schema {}\n", schema.string());
  const auto models = arguments.has(kModels) ? arguments.words(kModels) : std::vector<std::string>();
  text += fmt::format(fmt::runtime(kHead), output.empty() ? "FILE.toml" : output.string(), lightings_of(models));
  text += arguments.has(kModels) ? families(models) : std::string(kFamilies);
  text += kMaterials;
  text += arguments.has(kMeasuredOption) ? measured(arguments.text(kMeasuredOption), output) : std::string(kMeasured);
  text += kRest;
  return text;
}

ExitCode execute_new_study(Session& session) {
  const auto& arguments = session.arguments();
  const OutputFile output(session);
  if (arguments.has(kSchema)) {
    for (const Text& other : std::initializer_list<Text>{kModels, kMeasuredOption}) {
      if (arguments.has(other)) throw ArgumentError(other.dashed() + " has no meaning with --schema");
    }
  } else if (output.is_wanted() && output.path().extension() != ".toml") {
    throw ArgumentError("--output " + output.path().string() + " is no name of a study file; expected FILE.toml");
  }
  const std::string text = arguments.has(kSchema) ? study_schema() : study_text(session, output.path());
  output.write(text);
  session.print(output.is_wanted() ? output.path().string() + "\n" : text);
  return ExitCode::success;
}

}  // namespace

Command new_study_command() {
  return {.name = "new-study",
          .group = "Studies",
          .summary = "start a study file",
          .description =
              "Writes a study file that runs as it stands, in seconds, and shows what else a study may hold, commented "
              "out. Its first line names the JSON Schema, if installed, by which editors complete keys and models and "
              "check values.",
          .positionals = {},
          .options = {{.handle = option::output,
                       .letter = 'o',
                       .value = "FILE.toml",
                       .help = "write to this file instead of standard output"},
                      {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
                      {.handle = kModels,
                       .value = "MODEL,...",
                       .help = "write families of these models, with all their parameters, instead of two examples"},
                      {.handle = kMeasuredOption,
                       .value = "PATTERN",
                       .help = "take these measured files as materials, with the luminance of several channels; quote "
                               "the pattern"},
                      {.handle = kSchema, .help = "print the JSON Schema of study files instead"}},
          .examples = {{"a study to read and to run", "lobe new-study -o new.toml && lobe run new.toml -o out"},
                       {"a study that compares two models", "lobe new-study --models ward,ggx -o models.toml"}},
          .execute = execute_new_study};
}

}  // namespace lobe::cli
