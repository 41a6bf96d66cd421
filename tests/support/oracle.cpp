#include "support/oracle.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

namespace lobe::test {
namespace {

using nlohmann::json;

const json& oracle() {
  static const json content = [] {
    const char* variable = std::getenv("LOBE_ORACLE");
    std::filesystem::path path = variable != nullptr ? variable : "";
    if (!std::filesystem::exists(path)) path = LOBE_GOLDEN_DIR "/oracle.json";
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    return json::parse(file);
  }();
  return content;
}

std::string number_text(const json& value) {
  return value.dump();
}

/// Tobler's models also stand with the constants that the text prints, pi/2 too large (errata, finding 5), and with an
/// exponent below the library's.
bool is_not_of_the_library(const std::string& model, const std::map<std::string, std::string>& values) {
  if (model == "ToblerPow") return values.at("printed_norm") == "true" || std::stod(values.at("n")) < 4;
  return model == "ToblerExp" && std::stod(values.at("c")) > std::stod(values.at("s"));
}

/// Names of models and parameters here and in the file; constants that follow from the exponent are dropped.
std::string specification(const std::string& model, const std::map<std::string, std::string>& values) {
  struct Names {
    std::string model;
    std::map<std::string, std::string> parameters;
  };
  static const std::map<std::string, Names> names = {
      {"Lambert", {"lambert", {{"a", "scale"}}}},
      {"Phong", {"phong", {{"n", "n"}}}},
      {"MetalPhong", {"metal_phong", {{"n", "n"}}}},
      {"Blinn", {"blinn", {{"n", "n"}}}},
      {"Ward", {"ward", {{"m", "m"}}}},
      {"CookTorrance", {"cook_torrance", {{"m", "m"}}}},
      {"OrenNayar", {"oren_nayar", {{"sigma", "sigma"}, {"rho", "scale"}, {"Aden", "a_denominator"}}}},
      {"Minnaert", {"minnaert", {{"k", "k"}}}},
      {"PatchBasic", {"basic_patch", {{"R", "R"}}}},
      {"PatchExp", {"exponential_patch", {{"s", "s"}}}},
      {"Lafortune", {"lafortune", {{"Cx", "c_xy"}, {"Cz", "c_z"}, {"n", "n"}}}},
      {"BlinnMetal", {"blinn_metal", {{"n", "n"}}}},
      {"WardMetal", {"ward_metal", {{"m", "m"}}}},
      {"GenLambert", {"generalised_lambert", {{"d", "d"}, {"mclip", "clip"}}}},
      {"OrenNayarFull", {"oren_nayar_full", {{"sigma", "sigma"}, {"rho", "rho"}, {"Aden", "a_denominator"}}}},
      {"PhongPowerMean", {"phong_mean", {{"n", "n"}, {"p", "p"}}}},
      {"RetroMetalPhong", {"retro_metal_phong", {{"n", "n"}}}},
      {"p-model", {"p_model", {{"n", "n"}, {"p", "p"}}}},
      {"Schlick", {"schlick", {{"r", "r"}}}},
      {"ToblerPow", {"tobler_power", {{"n", "n"}}}},
      {"ToblerExp", {"tobler_exponential", {{"s", "s"}}}},
      {"Lacquer", {"lacquer", {{"s", "s"}}}},
      {"Sandwich", {"sandwich", {{"k", "k"}}}},
      {"Fresnel_normal", {"cook_torrance_fresnel", {{"n", "ior"}, {"k", "k"}}}},
  };
  const auto found = names.find(model);
  if (found == names.end() || is_not_of_the_library(model, values)) return {};
  std::string text = found->second.model;
  char separator = ':';
  for (const auto& [key, value] : values) {
    const auto parameter = found->second.parameters.find(key);
    if (parameter == found->second.parameters.end()) continue;
    text += separator + parameter->second + "=" + value;
    separator = ',';
  }
  return text;
}

/// Albedos of the corrected Ward model are those of C = 1, whereas the library's has the constant of another record.
std::string ward_metal_scale(const std::string& m) {
  for (const auto& entry : oracle().at("records")) {
    if (entry.at("name") == "WardMetal" && entry.at("quantity") == "C_max" &&
        number_text(entry.at("params").at("m")) == m) {
      return ",scale=" + number_text(1 / entry.at("value").get<double>());
    }
  }
  throw std::runtime_error("no constant of the corrected Ward model of roughness " + m + " in the oracle");
}

/// "C[Ward(m=0.2),Phong(n=10)]" -> the specifications of both materials.
std::vector<std::string> composed_materials(const std::string& name) {
  const auto between = name.find("),") + 1;
  return {oracle_material(name.substr(2, between - 2)),
          oracle_material(name.substr(between + 1, name.size() - between - 2))};
}

/// What was done to the material of a record of pumping-up: "@pump:correction=g1,times=2"; empty where nothing was, and
/// for more steps than albedos become indistinguishable by.
std::string pumping(const json& arguments) {
  constexpr int kMostSteps = 5;
  const int steps = arguments.value("k", 0);
  if (!arguments.contains("g") || steps < 1 || steps > kMostSteps) return {};
  const auto divisor = arguments.at("g").get<std::string>();
  const std::string correction = divisor.starts_with("g2 cumulative") ? "controlled" : divisor.substr(0, 2);
  return "@pump:correction=" + correction + ",times=" + std::to_string(steps);
}

std::vector<double> numbers(const json& value) {
  if (value.is_number()) return {value.get<double>()};
  if (value.is_array() && std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); })) {
    return value.get<std::vector<double>>();
  }
  return {};
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const OracleRecord& record) {
  return out << record.name;
}

std::ostream& operator<<(std::ostream& out, const OracleFit& fit) {
  return out << fit.name;
}

std::string oracle_material(const std::string& text) {
  const auto open = text.find('(');
  if (open == std::string::npos || text.back() != ')') return {};
  std::map<std::string, std::string> values;
  std::string rest = text.substr(open + 1, text.size() - open - 2);
  while (!rest.empty()) {
    const auto comma = rest.find(',');
    const auto part = rest.substr(0, comma);
    const auto equals = part.find('=');
    values[part.substr(0, equals)] = part.substr(equals + 1);
    rest = comma == std::string::npos ? std::string{} : rest.substr(comma + 1);
  }
  return specification(text.substr(0, open), values);
}

std::vector<std::string> oracle_family() {
  std::vector<std::string> family;
  for (const auto& text : oracle().at("meta").at("family")) family.push_back(oracle_material(text.get<std::string>()));
  return family;
}

std::vector<OracleRecord> oracle_records(const std::string& quantity) {
  std::vector<OracleRecord> records;
  for (const auto& entry : oracle().at("records")) {
    if (entry.at("quantity") != quantity) continue;
    OracleRecord record;
    record.quantity = quantity;
    const auto name = entry.at("name").get<std::string>();
    const auto& parameters = entry.at("params");
    if (name.starts_with("C[")) {
      record.materials = composed_materials(name);
    } else if (parameters.contains("f1")) {
      if (!parameters.at("f1").is_string()) continue;
      record.materials = {oracle_material(parameters.at("f1")), oracle_material(parameters.at("f2"))};
    } else if (name.find('(') != std::string::npos) {
      record.materials = {oracle_material(name)};
    } else {
      std::map<std::string, std::string> values;
      for (const auto& [key, value] : parameters.items()) values[key] = number_text(value);
      if (values.empty()) continue;
      record.materials = {specification(name, values)};
      if (name == "WardMetal" && quantity != "C_max") record.materials[0] += ward_metal_scale(values.at("m"));
    }
    const auto missing = [](const std::string& text) { return text.empty(); };
    if (std::any_of(record.materials.begin(), record.materials.end(), missing)) continue;
    record.values = numbers(entry.at("value"));
    if (record.values.empty()) continue;
    const auto& arguments = entry.at("args");
    const std::string steps = pumping(arguments);
    if (steps.empty() && arguments.value("k", 0) != 0) continue;
    record.materials[0] += steps;
    for (const char* key : {"theta_deg", "argmax_deg"}) {
      if (record.theta_deg.empty() && arguments.contains(key)) record.theta_deg = numbers(arguments.at(key));
    }
    if (arguments.contains("dphi")) {
      for (const char* key : {"thL", "thV", "dphi"}) record.theta_deg.push_back(arguments.at(key).get<double>());
    }
    if (entry.at("est_err").is_number()) record.uncertainty = entry.at("est_err").get<double>();
    record.printed = entry.value("printed", "");
    record.light_radius = arguments.value("R", 0.0);
    for (const auto& material : record.materials) record.name += (record.name.empty() ? "" : " . ") + material;
    const auto same = [&](const OracleRecord& other) {
      return other.name == record.name && other.theta_deg == record.theta_deg &&
             other.light_radius == record.light_radius;
    };
    if (std::any_of(records.begin(), records.end(), same)) continue;
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<OracleFit> oracle_fits() {
  // The parameters are written into the names: "MetalPhong20", "CookTorrance(0.3)".
  const auto material = [](const std::string& text) -> std::string {
    const auto digits = text.find_first_of("0123456789(");
    const std::string model = text.substr(0, digits);
    if (model == "Lambert") return "lambert";
    if (model == "MetalPhong") return "metal_phong:n=" + text.substr(digits);
    if (model == "CookTorrance") return "cook_torrance:m=" + text.substr(digits + 1, text.size() - digits - 2);
    throw std::runtime_error("unknown material '" + text + "' of an approximation in the oracle");
  };
  const auto lighting = [](const std::string& text) -> std::string {
    if (text == "point light") return "point";
    if (text == "daylight") return "daylight";
    const auto equals = text.find("R=");
    if (equals == std::string::npos) throw std::runtime_error("unknown product '" + text + "' in the oracle");
    return "patch:" + text.substr(equals + 2);
  };
  std::vector<OracleFit> fits;
  for (const auto& entry : oracle().at("records")) {
    const auto quantity = entry.at("quantity").get<std::string>();
    if (!quantity.starts_with("coefficients")) continue;
    OracleFit fit;
    fit.lighting = lighting(entry.at("params").at("product"));
    fit.non_negative = quantity.ends_with("non-negative");
    fit.name = fit.lighting + (fit.non_negative ? " non-negative" : " unconstrained");
    fit.target = material(entry.at("name").get<std::string>().substr(4));  // "fit ..."
    for (const auto& name : entry.at("params").at("basis")) fit.basis.push_back(material(name.get<std::string>()));
    fit.coefficients = numbers(entry.at("value"));
    fit.uncertainties = numbers(entry.at("est_err"));
    fit.residual = entry.at("residual_norm").get<double>();
    fit.relative_residual = entry.at("relative_residual").get<double>();
    fits.push_back(std::move(fit));
  }
  return fits;
}

}  // namespace lobe::test
