#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/memory.hpp"
#include "interface/operand_json.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/reading.hpp"
#include "interface/session.hpp"
#include "interface/table_report.hpp"
#include "lobe/core/error.hpp"
#include "lobe/lut/lut.hpp"
#include "lobe/lut/lut_file.hpp"
#include "lobe/lut/lut_fit.hpp"

namespace lobe::cli {
namespace {

constexpr Texts kAxis{"axis"};
constexpr Count kBits{"bits"};
constexpr Text kCompare{"compare"};
constexpr Text kFit{"fit"};
constexpr Flag kFloat{"float"};
constexpr Text kName{"name"};
constexpr Text kQuantity{"quantity"};
constexpr Count kRefinement{"refinement"};
constexpr Text kSplit{"split"};

/// A name of an array out of that of a file.
std::string identifier(const std::string& stem) {
  std::string name;
  for (const char c : stem) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) name = "lut_" + name;
  return name;
}

std::optional<LutFileOptions> file_options(const Session& session, const OutputFile& output) {
  const auto& arguments = session.arguments();
  if (!output.is_wanted()) {
    for (const Handle& handle : {Handle(option::format), Handle(kBits), Handle(kFloat), Handle(kName)}) {
      if (arguments.has(handle)) throw ArgumentError(handle.dashed() + " is for a file; give --output as well");
    }
    return std::nullopt;
  }
  LutFileOptions options;
  options.format =
      arguments.has(option::format) ? parse_lut_format(arguments.text(option::format)) : lut_format_of(output.path());
  if (arguments.has(kBits)) options.bits = static_cast<int>(arguments.count(kBits));
  options.is_float = arguments.has(kFloat);
  options.name = arguments.has(kName) ? arguments.text(kName) : identifier(output.path().stem().string());
  options.command_line = session.command_line();
  return options;
}

/// What is computed, of a formula as it is written: adjustments are for each of its parameters anew.
LutRequest request_of(const Session& session) {
  const auto& arguments = session.arguments();
  const Operand operand(arguments.text(argument::material), read_options(arguments));
  LutRequest request{.reflectance = operand.reflectance()};
  for (const auto& axis : arguments.texts(kAxis)) request.axes.push_back(parse_lut_axis(axis, request.reflectance));
  if (arguments.has(kQuantity)) request.quantity = parse_lut_quantity(arguments.text(kQuantity));
  request.split = arguments.text(kSplit);
  return request;
}

std::string deviation_text(const Lut& lut, const LutDeviation& deviation) {
  return fmt::format("{:.2g} at {}", deviation.largest, lut_place_text(lut, deviation));
}

/// Somebody else's numbers are shown beside the true ones.
std::string comparison_text(const Lut& lut, const LutDeviation& deviation) {
  return fmt::format("{}: {} instead of {}", deviation_text(lut, deviation), shortest(deviation.table),
                     format_estimate(deviation.exact));
}

Json deviation_json(const Lut& lut, const LutDeviation& deviation) {
  Json at = Json::object();
  for (std::size_t a = 0; a < deviation.at.size(); ++a) {
    const std::string& name = lut.request.axes[a].name;
    at[name == "theta" ? "theta_deg" : name] = to_json(deviation.at[a]);
  }
  return {{"largest", to_json(deviation.largest)},
          {"rms", to_json(deviation.rms)},
          {"at", std::move(at)},
          {"column", lut.columns[deviation.column]},
          {"table", to_json(deviation.table)},
          {"exact", to_json(deviation.exact)}};
}

Json axes_json(const LutRequest& request) {
  Json axes = Json::array();
  for (const LutAxis& axis : request.axes) {
    axes.push_back({{"name", axis.name},
                    {"count", axis.count},
                    {"from", to_json(axis.from)},
                    {"to", to_json(axis.to)},
                    {"map", to_string(axis.map)},
                    {"entries", to_string(axis.entries)}});
  }
  return axes;
}

/// Formats of tables, then the language of functions that is none.
std::vector<std::string_view> format_names() {
  auto names = lut_format_names();
  names.emplace_back("python");
  return names;
}

std::string shape_text(const LutRequest& request) {
  std::vector<std::string> counts;
  for (const LutAxis& axis : request.axes) counts.push_back(std::to_string(axis.count));
  return fmt::format("{}", fmt::join(counts, " x "));
}

/// The coefficients of a function, or of a part of it.
Json numbers_json(const std::vector<double>& numbers) {
  Json all = Json::array();
  for (const double number : numbers) all.push_back(to_json(number));
  return all;
}

Json errors_json(const Lut& lut, const LutErrors& errors) {
  return {{"entries", deviation_json(lut, errors.entries)},
          {"between", deviation_json(lut, errors.between)},
          {"all", deviation_json(lut, errors.all)},
          {"points", errors.points}};
}

/// Functions that stand for a table, with their errors by column.
struct Functions {
  std::string title;
  std::optional<LutFit> fit;  ///< none for published ones
  std::vector<LutErrors> errors;
};

/// What --fit names.
struct FitChoice {
  std::optional<LutFitForm> form;
  std::optional<PublishedLutFit> published;
};

FitChoice fit_choice(const std::string& text) {
  FitChoice choice;
  if (text.find(':') != std::string::npos) {
    choice.form = parse_lut_fit_form(text);
    return choice;
  }
  const auto names = published_lut_fit_names();
  if (std::ranges::find(names, text) == names.end()) {
    throw ArgumentError(fmt::format("--fit takes no '{}'; expected polynomial:DEGREES, rational:DEGREES/DEGREES, {}",
                                    excerpt(text), fmt::join(names, ", ")));
  }
  choice.published = parse_published_lut_fit(text);
  return choice;
}

Functions functions_for(const Device& device, const FitChoice& choice, const Lut& exact, unsigned refinement,
                        const LutOptions& options) {
  Functions functions;
  if (choice.published) {
    functions.title = published_lut_fit_text(*choice.published);
    functions.errors = published_lut_fit_errors(device, *choice.published, exact, refinement, options);
    return functions;
  }
  functions.fit = fit_lut(device, exact, *choice.form, refinement, options);
  functions.title = lut_fit_text(exact.request, *choice.form);
  for (const LutFitColumn& function : functions.fit->functions) functions.errors.push_back(function.errors);
  return functions;
}

std::optional<LutFitFileOptions> fit_file_options(const Session& session, const OutputFile& output,
                                                  const FitChoice& choice) {
  const auto& arguments = session.arguments();
  for (const Handle& handle : {Handle(kBits), Handle(kFloat), Handle(kCompare)}) {
    if (arguments.has(handle)) throw ArgumentError(handle.dashed() + " is for a table; leave it out, or --fit");
  }
  if (!output.is_wanted()) {
    for (const Handle& handle : {Handle(option::format), Handle(kName)}) {
      if (arguments.has(handle)) throw ArgumentError(handle.dashed() + " is for a file; give --output as well");
    }
    return std::nullopt;
  }
  if (choice.published)
    throw ArgumentError("--fit " + arguments.text(kFit) + " has a file already; leave out --output");
  LutFitFileOptions options;
  options.language = arguments.has(option::format) ? parse_lut_fit_language(arguments.text(option::format))
                                                   : lut_fit_language_of(output.path());
  options.name = arguments.has(kName) ? arguments.text(kName) : identifier(output.path().stem().string());
  options.command_line = session.command_line();
  return options;
}

Json functions_json(const Lut& lut, const Functions& functions) {
  Json fit{{"title", functions.title}, {"columns", Json::array()}};
  if (functions.fit) {
    fit["form"] = to_string(functions.fit->form);
    fit["size"] = lut_fit_size(functions.fit->form, lut.request.axes.size());
    fit["variable"] = functions.fit->is_centred ? "2u-1" : "u";
  }
  for (std::size_t c = 0; c < functions.errors.size(); ++c) {
    Json column{{"column", lut.columns[c]}, {"errors", errors_json(lut, functions.errors[c])}};
    if (functions.fit) {
      const LutFitColumn& function = functions.fit->functions[c];
      column["bound"] = to_json(function.bound);
      column["single_errors"] = errors_json(lut, function.single_errors);
      column["numerator"] = numbers_json(function.numerator);
      if (!function.denominator.empty()) column["denominator"] = numbers_json(function.denominator);
    }
    fit["columns"].push_back(std::move(column));
  }
  return fit;
}

/// The smallest error of any function of the form, rounded down to three digits.
std::string least_error_text(double bound) {
  if (!(bound > 0)) return "0";
  const double unit = std::pow(10.0, std::floor(std::log10(bound)) - 2);
  return fmt::format("{:.3g}", std::floor(bound / unit) * unit);
}

std::vector<Field> function_fields(const Lut& lut, const Functions& functions) {
  std::vector<Field> fields{{"fit", functions.title}};
  for (std::size_t c = 0; c < functions.errors.size(); ++c) {
    const LutErrors& errors = functions.errors[c];
    // The column is named before it.
    const Lut place{.request = lut.request, .columns = {}, .values = {}, .errors = {}};
    const auto text = [&](const LutDeviation& deviation) {
      return fmt::format("{:.3g} at {}", deviation.largest, lut_place_text(place, deviation));
    };
    std::string entries = text(errors.entries);
    if (functions.fit) entries += "; none of this form is below " + least_error_text(functions.fit->functions[c].bound);
    fields.push_back({lut.columns[c], "error of entries " + entries});
    fields.push_back({"", "between " + text(errors.between)});
    if (errors.all.largest > errors.between.largest) fields.push_back({"", "up to the ends " + text(errors.all)});
    if (functions.fit) {
      fields.push_back({"", fmt::format("in single precision {:.3g}, between {:.3g}",
                                        functions.fit->functions[c].single_errors.entries.largest,
                                        functions.fit->functions[c].single_errors.between.largest)});
    }
    fields.push_back({"", fmt::format("root mean square {:.2g} at entries, {:.2g} between", errors.entries.rms,
                                      errors.between.rms)});
  }
  fields.push_back({"measured at", fmt::format("{} points", functions.errors.front().points)});
  return fields;
}

Json table_json(const Session& session, const LutRequest& request) {
  Json answer = json_answer("lut");
  answer["material"] = session.arguments().text(argument::material);
  answer["quantity"] = to_string(request.quantity);
  if (!request.split.empty()) answer["split"] = request.split;
  answer["columns"] = lut_columns(request);
  answer["axes"] = axes_json(request);
  answer["units"] = {{"albedo", "1"}};
  return answer;
}

std::vector<Field> table_fields(const LutRequest& request) {
  std::vector<Field> fields{{"quantity", lut_quantity_text(request)}, {"table", shape_text(request)}};
  for (const LutAxis& axis : request.axes) fields.push_back({"axis", lut_axis_text(axis)});
  return fields;
}

ExitCode execute_fit(Session& session, const LutRequest& request, unsigned refinement, const LutOptions& options) {
  const auto& arguments = session.arguments();
  const OutputFile output(session);
  const FitChoice choice = fit_choice(arguments.text(kFit));
  const auto file = fit_file_options(session, output, choice);
  if (choice.form) (void)lut_fit_size(*choice.form, request.axes.size());
  const Device& device = session.device();
  const Lut exact = make_lut(device, request, options);
  const Functions functions = functions_for(device, choice, exact, refinement, options);
  if (file) output.write(lut_fit_file(*functions.fit, *file));
  session.end_progress();
  if (session.wants_json()) {
    Json answer = table_json(session, request);
    answer["fit"] = functions_json(exact, functions);
    answer["tolerance"] = options.tolerance;
    if (file) answer["file"] = output.path().string();
    answer["device"] = to_json(device.info());
    session.print_json(answer);
    return ExitCode::success;
  }
  std::vector<Field> fields = table_fields(request);
  for (auto& field : function_fields(exact, functions)) fields.push_back(std::move(field));
  if (file) fields.push_back({"file", output.path().string()});
  session.print(fields_text(fields));
  return ExitCode::success;
}

ExitCode execute_lut(Session& session) {
  const auto& arguments = session.arguments();
  if (arguments.texts(kAxis).empty()) {
    throw ArgumentError("'lobe lut' needs at least one --axis; expected, for example, --axis cos_theta:count=32");
  }
  const LutRequest request = request_of(session);
  const unsigned refinement = arguments.has(kRefinement) ? arguments.count(kRefinement, 16) : 2;
  const LutOptions options{.tolerance = session.tolerance(LutOptions{}.tolerance),
                           .precision = session.precision(),
                           .missed = session.missed(),
                           .progress = session.progress()};
  if (arguments.has(kFit)) return execute_fit(session, request, refinement, options);
  const OutputFile output(session);
  const auto file = file_options(session, output);
  const bool is_foreign = arguments.has(kCompare);
  if (is_foreign && file) throw ArgumentError("--compare reads a table and writes none; leave out --output");
  const Device& device = session.device();
  std::optional<Lut> foreign;  // read before anything is computed
  if (is_foreign) foreign = read_lut(arguments.text(kCompare), request);
  if (file) (void)as_stored({.request = request, .columns = lut_columns(request), .values = {}, .errors = {}}, *file);
  const Lut exact = make_lut(device, request, options);
  const Lut lut = foreign ? *foreign : file ? as_stored(exact, *file) : exact;
  const LutErrors errors = lut_errors(device, lut, exact, refinement, options);
  if (file) output.write(lut_file(lut, errors, *file));
  session.end_progress();

  const auto [least, most] = std::ranges::minmax(lut.values);
  if (session.wants_json()) {
    Json answer = table_json(session, request);
    answer["columns"] = lut.columns;
    answer["range"] = {to_json(least), to_json(most)};
    answer["errors"] = errors_json(lut, errors);
    answer["tolerance"] = options.tolerance;
    if (is_foreign) answer["compared"] = arguments.text(kCompare);
    if (file) answer["file"] = output.path().string();
    answer["device"] = to_json(device.info());
    session.print_json(answer);
    return ExitCode::success;
  }
  std::vector<Field> fields = table_fields(request);
  fields.push_back({"values", fmt::format("{:.6g} to {:.6g}", least, most)});
  const auto text = [&](const LutDeviation& deviation) {
    return is_foreign ? comparison_text(lut, deviation) : deviation_text(lut, deviation);
  };
  fields.push_back({"error of entries", text(errors.entries)});
  fields.push_back({"interpolated", text(errors.between)});
  if (errors.all.largest > errors.between.largest) fields.push_back({"up to the ends", text(errors.all)});
  fields.push_back({"measured at", fmt::format("{} points; root mean square {:.2g} at entries, {:.2g} between",
                                               errors.points, errors.entries.rms, errors.between.rms)});
  if (file) fields.push_back({"file", output.path().string()});
  session.print(fields_text(fields));
  return ExitCode::success;
}

}  // namespace

Command lut_command() {
  return {
      .name = "lut",
      .group = "Materials",
      .summary = "make an albedo table for a renderer, or check one",
      .description =
          "Computes a lookup table of directional or mean albedos over angles and parameters, as renderers use for "
          "energy "
          "compensation and split-sum lighting, and prints how far it is off: at the entries, as the file stores them, "
          "and with linear interpolation between them, measured on a finer grid. Axes are cos_theta, theta (degrees) "
          "and any parameter of the formula, each with its map. With --split f0, the table has the two terms of an "
          "albedo that is linear in f0, E = bias + f0 * scale (\"DFG\"). The formats csv, npy, c (.h), glsl, png, "
          "spi1d, hdf5 (.h5), exr and ktx2 are chosen by the ending. --compare reads a table made elsewhere and says "
          "where it is wrong, and by how much. --fit writes no table, but the polynomial or rational function with the "
          "smallest largest error at its entries, as C (.h), GLSL or Python (.py), and prints that error beside a "
          "bound "
          "that no function of the form is below; named lazarov, karis or materialx it grades a published fit.",
      .positionals = {{.handle = argument::material,
                       .help = "the material; values of parameters that are axes are replaced",
                       .is_material = true}},
      .options =
          {{.handle = kAxis,
            .value = "AXIS",
            .help =
                "axis NAME:key=value,... with keys count (32), from, to, map (linear, sqrt, square or log) and entries "
                "(centres or nodes), all optional; may be repeated, the last one is the quickest"},
           {.handle = kQuantity,
            .value = "NAME",
            .help = "albedo (default), complement (1 - albedo), mean-albedo, mean-complement",
            .choices = {"albedo", "complement", "mean-albedo", "mean-complement"}},
           {.handle = kSplit, .value = "PARAMETER", .help = "store scale and bias of the albedo in this parameter"},
           {.handle = option::output, .letter = 'o', .value = "FILE", .help = "the file; without it, only errors"},
           {.handle = option::format,
            .value = "FORMAT",
            .help = "format of the file (default: by its ending)",
            .choices = format_names()},
           {.handle = kBits,
            .value = "N",
            .help = "bits of a number in PNG (8 or 16), EXR (16 or 32) and KTX2 (8 or 16); by default 16, 32 and 16"},
           {.handle = kFloat, .help = "KTX2 with floating-point numbers of 16 or 32 bits"},
           {.handle = kName,
            .value = "NAME",
            .help = "name of the array or function in C, GLSL and Python (default: the file's)"},
           {.handle = kCompare,
            .value = "FILE",
            .help = "check this table instead (.csv, .npy, .png, .h, .glsl, .spi1d, .h5, .exr, .ktx2)"},
           {.handle = kFit,
            .value = "FORM",
            .help = "fit functions instead: polynomial:DEGREES or rational:DEGREES/DEGREES, DEGREES one for the sum of "
                    "exponents or one per axis (rational:2,2/2,2); or grade lazarov, karis or materialx"},
           {.handle = kRefinement,
            .value = "N",
            .help = "steps between entries for the error of interpolation, 1 to 16 (default 2)"},
           {.handle = option::force, .letter = 'f', .help = "replace an existing file"},
           tolerance_option("largest relative error of the albedos (formulas: default 1e-6)"),
           strict_option(),
           json_option()},
      .examples = {{"the DFG terms of split-sum lighting, as an image of 16 bits",
                    "lobe lut ggx:alpha=1,f0=1 --axis alpha --axis cos_theta --split f0 -o dfg.png"},
                   {"the albedo of one roughness, as a list", "lobe lut ggx:alpha=1,f0=1 --axis cos_theta -o e.csv"},
                   {"a rational function instead of a table",
                    "lobe lut ggx:alpha=1,f0=1 --axis cos_theta --fit rational:3/3 -o e.h"},
                   {"whether a table is right", "lobe lut ggx:alpha=1,f0=1 --axis cos_theta --compare e.csv"}},
      .execute = execute_lut};
}

}  // namespace lobe::cli
