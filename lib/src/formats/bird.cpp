// The universal BRDF data format of the project BiRD (EMPIR 16NRM08), JSON with a column for each variable.
// Source: Lanevski, Ferrero, Perales, Manoocheri and Ikonen 2022 (Color Research and Application 47, 1177-1192), its
// schema brdf_json_schema_v1.0.json and example.brdf; and the drafts of 2021, which have rows.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "core/clock.hpp"
#include "core/text.hpp"
#include "core/uuid.hpp"
#include "formats/format.hpp"
#include "formats/json_walk.hpp"
#include "formats/spectral_rows.hpp"
#include "formats/specular_frame.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::string_view kAdhoc = "adhoc_variables/";
constexpr std::size_t kMostVariables = 64;
constexpr std::size_t kMostStates = 64;      // different texts of a variable
constexpr std::size_t kLongestVector = 200;  // characters

bool recognises(const FileBytes& head) {
  const std::string_view text = head.content();
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string_view::npos && text[first] == '{' && text.find("\"BRDF\"") != std::string_view::npos;
}

/// A variable: its values, one for each point.
struct Variable {
  std::string name;
  std::string unit;
  std::string comments;
  std::deque<double> values;          ///< of texts and vectors: their number among states
  std::vector<std::string> states;    ///< the different ones
  std::optional<double> uncertainty;  ///< of all values
  std::string uncertainty_unit;

  [[nodiscard]] bool varies() const {
    return std::ranges::any_of(values, [&](double value) { return value != values.front(); });
  }
};

/// What is read of a file.
struct Content {
  std::map<std::string, Variable, std::less<>> variables;
  std::string symmetry;  ///< of the sample

  [[nodiscard]] const Variable* find(std::string_view name) const {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : &found->second;
  }
};

class Parser {
 public:
  explicit Parser(const FileBytes& file) : file_(file), walk_(file) {
    walk_.run([&](JsonPath path, const JsonScalar& value) { take(path, value); }, [&](JsonPath path) { end(path); });
    for (Variable& column : columns_) {
      if (column.name.empty()) file_.refuse_end("a variable has no name; expected one for each number of a row");
      std::string name = column.name;
      content_.variables.insert_or_assign(std::move(name), std::move(column));
    }
  }
  [[nodiscard]] Content content() { return std::move(content_); }

 private:
  void take(JsonPath path, const JsonScalar& value) {
    if (is_at(path, {"metadata", "sample", "properties_symmetry"})) content_.symmetry = lowercase(trim(value.text));
    if (path.size() < 2 || path[0] != "data") return;
    if (path[1] == "variables") return take_header(path, value);
    if (path[1] == "values") return take_row(path, value);
    const bool is_adhoc = path[1] == "adhoc_variables";
    const std::size_t from = is_adhoc ? 3 : 2;
    if (path.size() <= from) return;
    Variable& variable = variable_of(is_adhoc ? std::string(kAdhoc) + path[2] : path[1]);
    const JsonPath rest = path.subspan(from);
    if (is_at(rest, {"values", "[]"})) add(variable, value);
    if (is_at(rest, {"values", "[]", "[]"})) {
      vector_ += (vector_.empty() ? "" : ", ") + shortest(number_of(value));
      if (vector_.size() > kLongestVector) walk_.refuse("a vector of too many numbers; expected 4");
    }
    if (is_at(rest, {"unit"})) variable.unit = value.text;
    if (is_at(rest, {"comments"})) variable.comments = value.text;
    if (is_at(rest, {"uncertainty", "value"})) variable.uncertainty = number_of(value);
    if (is_at(rest, {"uncertainty", "unit"})) variable.uncertainty_unit = value.text;
  }

  /// The drafts describe the numbers of a row by an array of objects.
  void take_header(JsonPath path, const JsonScalar& value) {
    if (path.size() != 4) return;
    // Objects end unseen: a second name begins another one.
    if (path[3] == "name" && ++names_ > kMostVariables) refuse_many();
    if (names_ > columns_.size()) columns_.resize(names_);
    if (names_ == 0) walk_.refuse("a variable whose name does not come first");
    Variable& column = columns_[names_ - 1];
    if (path[3] == "name") column.name = value.text;
    if (path[3] == "unit") column.unit = value.text;
  }

  void take_row(JsonPath path, const JsonScalar& value) {
    if (path.size() != 4) return;
    if (filled_ == kMostVariables) refuse_many();
    if (filled_ == columns_.size()) columns_.emplace_back();
    add(columns_[filled_++], value);
  }

  void end(JsonPath path) {
    if (is_at(path, {"data", "values", "[]"})) {
      const std::size_t expected = row_ > 0 ? row_ : names_ > 0 ? names_ : filled_;
      if (filled_ != expected) walk_.refuse(fmt::format("a row of {} numbers; expected {}", filled_, expected));
      row_ = filled_;
      filled_ = 0;
    }
    if (path.size() == 4 && path[0] == "data" && path[2] == "values" && path[3] == "[]") {
      add_state(variable_of(path[1]), "[" + std::exchange(vector_, {}) + "]");
    }
  }

  [[noreturn]] void refuse_many() const { walk_.refuse(fmt::format("more than {} variables", kMostVariables)); }

  Variable& variable_of(const std::string& name) {
    if (const auto found = content_.variables.find(name); found != content_.variables.end()) return found->second;
    if (content_.variables.size() == kMostVariables) refuse_many();
    Variable& variable = content_.variables[name];
    variable.name = name;
    return variable;
  }

  [[nodiscard]] double number_of(const JsonScalar& value) const {
    if (value.kind == JsonScalar::Kind::number) return value.number;
    walk_.refuse(fmt::format("'{}' where a number is expected", text_of(value)));
  }

  [[nodiscard]] static std::string text_of(const JsonScalar& value) {
    if (value.kind == JsonScalar::Kind::number) return shortest(value.number);
    return value.kind == JsonScalar::Kind::text ? excerpt(value.text) : std::string("null");
  }

  void add(Variable& variable, const JsonScalar& value) {
    if (value.kind == JsonScalar::Kind::text) return add_state(variable, text_of(value));
    if (value.kind != JsonScalar::Kind::number || !variable.states.empty()) refuse_mixed(variable, text_of(value));
    variable.values.push_back(value.number);
  }

  [[noreturn]] void refuse_mixed(const Variable& variable, std::string_view what) const {
    walk_.refuse(fmt::format("'{}' among the values of {}; expected numbers, or texts alone", what,
                             variable.name.empty() ? "a variable" : excerpt(variable.name)));
  }

  void add_state(Variable& variable, const std::string& state) {
    if (variable.states.empty() && !variable.values.empty()) refuse_mixed(variable, state);
    const auto found = std::ranges::find(variable.states, state);
    variable.values.push_back(static_cast<double>(found - variable.states.begin()));
    if (found != variable.states.end()) return;
    if (variable.states.size() == kMostStates) {
      walk_.refuse(fmt::format("more than {} different texts of {}", kMostStates, excerpt(variable.name)));
    }
    variable.states.push_back(state);
  }

  const FileBytes& file_;
  JsonWalk walk_;
  Content content_;
  std::vector<Variable> columns_;  ///< of rows
  std::size_t names_ = 0;          ///< of columns so far
  std::size_t filled_ = 0;         ///< numbers of the row so far
  std::size_t row_ = 0;            ///< numbers of each row; 0: none so far
  std::string vector_;
};

/// The variables of the BRDF, each with a value for each point.
class Table {
 public:
  Table(const FileBytes& file, const Content& content) : file_(file), content_(content) {
    points_ = required("BRDF").values.size();
    for (const auto& [name, variable] : content.variables) {
      const bool is_angle = name.starts_with("theta_") || name.starts_with("phi_");
      if (variable.values.size() == points_ || (variable.values.empty() && !is_angle)) continue;
      file_.refuse_end(fmt::format("{} values of {}; expected {}, as many as of BRDF", variable.values.size(),
                                   excerpt(name), points_));
    }
  }

  [[nodiscard]] std::size_t points() const { return points_; }
  [[nodiscard]] const Variable& required(std::string_view name) const {
    const Variable* variable = content_.find(name);
    if (variable != nullptr && variable->states.empty()) return *variable;
    file_.refuse_end(
        fmt::format("there is no variable '{}' of numbers; expected theta_i, phi_i, theta_r, phi_r and BRDF", name));
  }
  /// nullptr without values.
  [[nodiscard]] const Variable* optional(std::string_view name) const {
    const Variable* variable = content_.find(name);
    return variable == nullptr || variable->values.empty() ? nullptr : variable;
  }

  /// Radians.
  [[nodiscard]] std::vector<double> angles(std::string_view name) const {
    const Variable& variable = required(name);
    const bool is_radian = variable.unit == "rad";
    if (!is_radian && variable.unit != "deg" && variable.unit != "°") {
      file_.refuse_end(fmt::format("the unit of {} is '{}'; expected rad, deg or °", name, excerpt(variable.unit)));
    }
    constexpr double kBeyond = 1e-5;  // radians may have six digits
    const bool is_polar = name.starts_with("theta");
    std::vector<double> radians;
    radians.reserve(points_);
    for (const double value : variable.values) {
      radians.push_back(is_radian ? value : value * kDegree);
      if (is_polar && !(radians.back() >= 0 && radians.back() <= std::numbers::pi / 2 + kBeyond)) {
        file_.refuse_end(fmt::format("{} of {} {}; expected 0 to 90 degrees", name, shortest(value), variable.unit));
      }
    }
    return radians;
  }

  /// sr^-1, by the unit of a variable of uncertainties.
  [[nodiscard]] bool is_percent(std::string_view what, std::string_view unit) const {
    if (unit == "%") return true;
    if (unit == "1/sr" || unit == "sr^-1" || unit == "sr-1") return false;
    file_.refuse_end(fmt::format("the unit of {} is '{}'; expected 1/sr, sr^-1 or %", what, excerpt(unit)));
  }

  /// The standard deviation of each point; empty where none is stated.
  [[nodiscard]] std::vector<double> deviations() const {
    const Variable& brdf = required("BRDF");
    const Variable* own = optional("uBRDF");
    if (own == nullptr && !brdf.uncertainty) return {};
    const bool is_share =
        own != nullptr ? is_percent("uBRDF", own->unit) : is_percent("the uncertainty of BRDF", brdf.uncertainty_unit);
    std::vector<double> result;
    result.reserve(points_);
    for (std::size_t i = 0; i < points_; ++i) {
      const double stated = own != nullptr ? own->values[i] : *brdf.uncertainty;
      if (!(stated >= 0)) file_.refuse_end(fmt::format("an uncertainty of {}; expected 0 or more", shortest(stated)));
      result.push_back(is_share ? stated / 100 * std::abs(brdf.values[i]) : stated);
    }
    return result;
  }

  /// Nanometres; empty where none are stated.
  [[nodiscard]] std::vector<double> wavelengths() const {
    const Variable* in = optional("wavelength_i");
    const Variable* out = optional("wavelength_r");
    if (in == nullptr && out == nullptr) return {};
    if (in != nullptr && out != nullptr && (in->values != out->values || in->unit != out->unit)) {
      file_.refuse_end("wavelength_r is not wavelength_i: it fluoresces; expected the same or one of them");
    }
    const Variable& variable = in != nullptr ? *in : *out;
    const bool is_micrometres = variable.unit == "μm" || variable.unit == "µm" || variable.unit == "um";
    if (!is_micrometres && variable.unit != "nm") {
      file_.refuse_end(fmt::format("the unit of {} is '{}'; expected nm or μm", variable.name, excerpt(variable.unit)));
    }
    std::vector<double> result;
    result.reserve(points_);
    for (const double value : variable.values) {
      if (!(value > 0)) {
        file_.refuse_end(fmt::format("{} of {}; expected a length above 0", variable.name, shortest(value)));
      }
      result.push_back(is_micrometres ? std::round(value * 1e9) / 1e6 : value);
    }
    return result;
  }

  /// Whether the other variables are constant; those that vary make several reflectances.
  void require_constant_others() const {
    constexpr std::array<std::string_view, 10> kKnown{"theta_i",        "phi_i",         "theta_r",      "phi_r",
                                                      "BRDF",           "uBRDF",         "wavelength_i", "wavelength_r",
                                                      "polarization_i", "polarization_r"};
    for (const auto& [name, variable] : content_.variables) {
      if (std::ranges::find(kKnown, name) != kKnown.end() || !variable.varies()) continue;
      file_.refuse_end(fmt::format("the variable '{}' varies; expected directions, wavelengths and polarizations alone",
                                   excerpt(name)));
    }
  }

 private:
  const FileBytes& file_;
  const Content& content_;
  std::size_t points_ = 0;
};

/// The letter of a state of polarization by its name or its Stokes vector; '?' for others.
char letter_of(std::string_view state) {
  constexpr std::array<std::pair<std::string_view, char>, 6> kStates{
      {{"s", 's'}, {"p", 'p'}, {"u", 'u'}, {"[1, 1, 0, 0]", 's'}, {"[1, -1, 0, 0]", 'p'}, {"[1, 0, 0, 0]", 'u'}}};
  const auto found = std::ranges::find(kStates, state, &std::pair<std::string_view, char>::first);
  return found == kStates.end() ? '?' : found->second;
}

/// Which points are taken, and whether s and p are to be averaged.
struct Polarization {
  std::string taken;  ///< letters
  bool is_mean = false;
};

Polarization polarization_of(const FileBytes& file, const Table& table, const ReadOptions& options,
                             BrdfFunction& brdf) {
  const Variable* viewed = table.optional("polarization_r");
  if (viewed != nullptr) {
    if (viewed->varies()) {
      file.refuse_end("polarization_r varies; expected one state, for the light of all of them is one reflectance");
    }
    if (!viewed->states.empty() && letter_of(viewed->states.front()) != 'u') {
      brdf.remarks.push_back(fmt::format("only light of the polarization {} is seen", viewed->states.front()));
    }
  }
  const Variable* lit = table.optional("polarization_i");
  if (lit == nullptr) {
    if (!options.component.empty()) {
      throw ArgumentError(
          fmt::format("{} states no polarization; leave out '{}'", file.path().string(), options.component));
    }
    return {};
  }
  std::string letters;
  for (const std::string& state : lit->states) letters += letter_of(state);
  const auto has = [&](char letter) { return letters.find(letter) != std::string::npos; };
  if (!options.component.empty()) {
    const std::string known = "known: s, p, u";
    if (options.component.size() != 1 || !has(options.component.front()) || options.component == "?") {
      throw ArgumentError(
          fmt::format("{} has no polarization '{}' of the light; {}", file.path().string(), options.component, known));
    }
    brdf.remarks.push_back("light of the polarization " + options.component);
    return {options.component};
  }
  if (has('u')) return {"u"};
  if (has('s') && has('p')) {
    brdf.remarks.emplace_back("the mean of light of the polarizations s and p, which is unpolarized light");
    return {"sp", true};
  }
  if (lit->states.size() == 1) {
    brdf.remarks.push_back(fmt::format("light of the polarization {}", lit->states.front()));
    return {letters};
  }
  file.refuse_end("polarizations of the light are neither u nor s and p; expected these, or a single one");
}

/// The mean of the rows of s and p at each place, which are half of unpolarized light each.
std::vector<SpectralRow> means_of(const FileBytes& file, std::vector<SpectralRow> s, std::vector<SpectralRow> p) {
  const auto key = [](const SpectralRow& row) {
    return std::tuple(row.pair.theta_in, row.pair.phi_in, row.pair.theta_out, row.pair.delta_phi, row.wavelength);
  };
  std::ranges::stable_sort(s, {}, key);
  std::ranges::stable_sort(p, {}, key);
  if (!std::ranges::equal(s, p, {}, key, key)) {
    file.refuse_end(
        "the polarizations s and p have other directions or wavelengths; expected the same, or one of them");
  }
  for (std::size_t i = 0; i < s.size(); ++i) {
    s[i].value = (s[i].value + p[i].value) / 2;
    s[i].deviation = std::hypot(s[i].deviation, p[i].deviation) / 2;
  }
  return s;
}

void remark_on_uncertainties(const Content& content, BrdfFunction& brdf) {
  const Variable* own = content.find("uBRDF");
  const Variable& value = content.variables.find("BRDF")->second;
  for (const Variable* variable : {&value, own}) {
    if (variable == nullptr || variable->comments.empty()) continue;
    brdf.remarks.push_back(fmt::format("comment of {}: {}", variable->name, excerpt(variable->comments)));
  }
  if (own != nullptr && !own->values.empty() && value.uncertainty) {
    brdf.remarks.emplace_back("uncertainties by point are taken; the one of all points is left out");
  }
  for (const char* name : {"theta_i", "phi_i", "theta_r", "phi_r", "wavelength_i", "wavelength_r"}) {
    const Variable* variable = content.find(name);
    if (variable == nullptr || variable->uncertainty.value_or(0) == 0) continue;
    brdf.remarks.push_back(fmt::format("the uncertainty of {}, {} {}, is not followed", name,
                                       shortest(*variable->uncertainty), excerpt(variable->uncertainty_unit)));
  }
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  const Content content = Parser(file).content();
  const Table table(file, content);
  table.require_constant_others();
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kBirdFormat.title;
  const auto theta_i = table.angles("theta_i");
  const auto phi_i = table.angles("phi_i");
  const auto theta_r = table.angles("theta_r");
  const auto phi_r = table.angles("phi_r");
  const auto deviations = table.deviations();
  const auto wavelengths = table.wavelengths();
  const Variable& values = table.required("BRDF");
  (void)table.is_percent("BRDF", values.unit);
  if (values.unit == "%") file.refuse_end("the unit of BRDF is '%'; expected 1/sr or sr^-1");
  const Polarization polarization = polarization_of(file, table, options, brdf);
  const Variable* lit = table.optional("polarization_i");
  const bool is_isotropic = content.symmetry == "isotropic" || !content.find("phi_i")->varies();

  std::array<std::vector<SpectralRow>, 2> rows;
  for (std::size_t i = 0; i < table.points(); ++i) {
    const char letter = lit == nullptr ? '\0' : letter_of(lit->states[static_cast<std::size_t>(lit->values[i])]);
    if (lit != nullptr && polarization.taken.find(letter) == std::string::npos) continue;
    rows.at(polarization.is_mean && letter == 'p' ? 1 : 0)
        .push_back({wavelengths.empty() ? 0 : wavelengths[i],
                    {theta_i[i], theta_r[i], phi_r[i] - phi_i[i], is_isotropic ? 0 : phi_i[i]},
                    values.values[i],
                    deviations.empty() ? 0 : deviations[i]});
  }
  if (polarization.is_mean) rows[0] = means_of(file, std::move(rows[0]), std::move(rows[1]));
  brdf.conventions =
      "sr^-1 without cosine; directions away from the surface, phi_r - phi_i = 180 degrees is the mirror side; ";
  brdf.conventions += is_isotropic ? "isotropic" : "anisotropic";
  if (!deviations.empty()) brdf.conventions += "; uncertainties taken as standard uncertainties (coverage factor 1)";
  remark_on_uncertainties(content, brdf);
  interpolate(file, gathered(file, std::move(rows[0]), is_isotropic, !deviations.empty(), brdf), options, brdf);
  return brdf;
}

/// A variable's object: its unit and its values.
std::string variable_text(std::string_view name, std::string_view unit, const std::vector<double>& values,
                          std::string_view more = {}) {
  std::string text = fmt::format("\"{}\": {{\"unit\": \"{}\"{}, \"values\": [", name, unit, more);
  for (std::size_t i = 0; i < values.size(); ++i) text += (i == 0 ? "" : ",") + shortest(values[i]);
  return text + "]}";
}

/// Degrees to a billionth, so that those of multiples are short.
double degrees_of(double radians) {
  return std::round(to_degrees(radians) * 1e9) / 1e9;
}

/// \param data that the metadata is of
std::string metadata_text(const BrdfFunction& brdf, std::string_view data, const WriteOptions& options) {
  constexpr std::string_view kSchema =
      "https://raw.githubusercontent.com/BiRD-project/BiRD_view/master/BRDF_JSON_schema/brdf_json_schema_v1.0.json";
  constexpr std::string_view kUnknown = "NA";
  const bool is_simulated = brdf.format.empty();
  std::string comments = brdf.conventions;
  for (const auto& remark : brdf.remarks) comments += (comments.empty() ? "" : "; ") + remark;
  return fmt::format(
      R"("metadata": {{"schema": "{0}", "id": "urn:uuid:{1}", "type": "BRDF", "timestamp": "{2}",
"provenance": {{"organization": "{3}", "location": {{"country": "{3}", "city": "{3}", "street": "{3}", "building_nr": "{3}", "postal_code": "{3}"}}, "email": "{3}", "contact_person": "{3}"}},
"description": {4}, "method": "{5}", "instrumentation": "{3}",
"software": {{"name": "lobe", "description": {6}}},
"sample": {{"name": {4}, "type": "{3}", "shape": "{3}", "dimensions": {{}}, "properties_symmetry": "{7}", "zero_azimuth_location": "{8}"}},
"environment": "{3}", "comments": {9}}})",
      kSchema, uuid_of(brdf.name + std::string(data)), time_of_writing(), kUnknown, json_text(brdf.name),
      is_simulated ? "simulation" : "measurement", json_text(printable(options.command_line)),
      brdf.is_isotropic ? "isotropic" : "anisotropic", brdf.is_isotropic ? "the light" : "the x axis",
      json_text(comments));
}

std::string write(const BrdfFunction& brdf, const WriteOptions& options) {
  const std::vector<Directions> pairs = specular_pairs(grid_of_rows(brdf));
  const WrittenValues written = spectral_values(brdf, pairs, "BiRD");
  std::array<std::vector<double>, 4> angles;
  std::vector<double> wavelengths;
  std::vector<double> values;
  std::vector<double> deviations;
  for (const std::size_t channel : by_wavelength(brdf)) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [theta_i, theta_r, delta_phi, phi_i] = pairs[i];
      angles[0].push_back(degrees_of(theta_i));
      angles[1].push_back(degrees_of(phi_i));
      angles[2].push_back(degrees_of(theta_r));
      angles[3].push_back(std::fmod(degrees_of(phi_i + delta_phi), 360.0));
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(channel);
      values.push_back(written.value(row, column));
      if (written.deviation.size() > 0) deviations.push_back(written.deviation(row, column));
      if (!brdf.wavelengths.empty()) wavelengths.push_back(brdf.wavelengths[channel]);
    }
  }
  std::string text = "\"data\": {";
  if (!wavelengths.empty()) text += variable_text("wavelength_i", "nm", wavelengths) + ",\n";
  constexpr std::array<std::string_view, 4> kNames{"theta_i", "phi_i", "theta_r", "phi_r"};
  for (std::size_t a = 0; a < kNames.size(); ++a) text += variable_text(kNames[a], "deg", angles[a]) + ",\n";
  text += variable_text("BRDF", "sr^-1", values);
  if (!deviations.empty()) {
    text += ",\n" + variable_text("uBRDF", "sr^-1", deviations, R"(, "comments": "standard uncertainty, k = 1")");
  }
  text += "}";
  return "{" + metadata_text(brdf, text, options) + ",\n" + text + "}\n";
}

}  // namespace

const Format kBirdFormat{.name = "bird",
                         .title = "BiRD universal BRDF data (JSON)",
                         .recognises = recognises,
                         .read = read,
                         .write = write,
                         .holds_deviations = true};

}  // namespace lobe
