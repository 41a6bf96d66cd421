#include "lobe/metric/lighting.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "core/text.hpp"
#include "hemisphere/gauss.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/written_form.hpp"
#include "lobe/model/specification.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"
#include "metric/lighting_traits.hpp"

namespace lobe {
namespace {

constexpr std::array kForms{
    WrittenForm{"point", "point",
                "integral of f g: all of the reflectance counts; distances are 0 between equals only"},
    WrittenForm{"daylight", "daylight", "integral of the product of albedos, a_f a_g: only these count"},
    WrittenForm{"mean-albedo", "mean-albedo", "product of the integrals of f and of g: only the mean albedo counts"},
    WrittenForm{"patch", "patch:R",
                "light from a disc of radius 0 < R <= 2 of the base plane: R -> 0 is point, 2 is daylight / pi"},
    WrittenForm{"mixture", "mixture:R=W,...",
                "sum of patch lights of radii 0 < R <= 2, each with its weight W, 0 or more"},
    WrittenForm{"density", "density:R=V,...",
                "patch lights of all radii, with a density that is linear between values V, 0 or more, at two or more "
                "rising radii 0 <= R <= 2, and 0 outside of them"},
    WrittenForm{"material", "material:MATERIAL",
                "light of the pattern of any reflectance eta, as in material:phong:n=20: what f and g make of it"},
    WrittenForm{"table", "table:FILE.h5", "W as tabulated (on the command line only)"}};

void require_radius(double radius, bool may_be_zero) {
  if (!(radius <= 2 && (radius > 0 || (may_be_zero && radius == 0)))) {
    throw ArgumentError("radius " + shortest(radius) + " of a patch light is out of range; expected a value in (0, 2]");
  }
}

double read_number(std::string_view text, std::string_view name) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    throw ArgumentError("'" + std::string(text) + "' in lighting '" + std::string(name) +
                        "' is not a number; expected one such as 0.5");
  }
  return value;
}

/// Reads "a=b,c=d".
std::vector<std::pair<double, double>> read_pairs(std::string_view text, std::string_view name) {
  std::vector<std::pair<double, double>> pairs;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view entry = text.substr(0, comma);
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos) {
      throw ArgumentError("'" + std::string(entry) + "' in lighting '" + std::string(name) +
                          "' has no '='; expected RADIUS=VALUE,...");
    }
    pairs.emplace_back(read_number(entry.substr(0, equals), name), read_number(entry.substr(equals + 1), name));
    if (comma == std::string_view::npos) return pairs;
    text.remove_prefix(comma + 1);
  }
}

/// The specification of the material that a text specifies, if it does.
std::optional<std::string> specification_by(const std::string& text) {
  try {
    return specification(parse_material(text));
  } catch (const ArgumentError&) {
    return {};  // the name of a file
  }
}

std::string pair_text(double radius, double value, bool is_first) {
  return (is_first ? "" : ",") + shortest(radius) + "=" + shortest(value);
}

}  // namespace

Lighting::Lighting(Kind kind) : kind_(kind), name_(traits_of(kind).name) {}

Lighting Lighting::patch(double radius) {
  Lighting lighting = mixture({{radius, 1}});
  lighting.name_ = "patch:" + shortest(radius);
  return lighting;
}

Lighting Lighting::mixture(std::vector<PatchShare> shares) {
  Lighting lighting(Kind::patches);
  lighting.name_ = "mixture:";
  double sum = 0;
  for (const PatchShare& share : shares) {
    require_radius(share.radius, false);
    if (!(share.weight >= 0) || !std::isfinite(share.weight)) {
      throw ArgumentError("weight " + shortest(share.weight) +
                          " of a patch light is negative or no finite number; expected 0 or more");
    }
    lighting.name_ += pair_text(share.radius, share.weight, &share == &shares.front());
    sum += share.weight;
  }
  if (!(sum > 0)) throw ArgumentError("a mixture of patch lights has no positive weight; expected at least one");
  lighting.shares_ = std::move(shares);
  return lighting;
}

Lighting Lighting::density(std::vector<DensityPoint> points) {
  Lighting lighting(Kind::patches);
  lighting.name_ = "density:";
  if (points.size() < 2)
    throw ArgumentError("a density of patch lights has " + std::to_string(points.size()) +
                        (points.size() == 1 ? " point" : " points") + "; expected at least two points");
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const DensityPoint& point = points[k];
    require_radius(point.radius, true);
    if (k > 0 && !(point.radius > points[k - 1].radius)) {
      throw ArgumentError("radii of a density of patch lights do not rise at " + shortest(point.radius) +
                          "; expected them in rising order");
    }
    if (!(point.value >= 0) || !std::isfinite(point.value)) {
      throw ArgumentError("value " + shortest(point.value) +
                          " of a density of patch lights is negative or not finite; expected 0 or more");
    }
    lighting.name_ += pair_text(point.radius, point.value, k == 0);
    sum += point.value;
  }
  if (!(sum > 0)) throw ArgumentError("a density of patch lights is zero everywhere; expected a positive value");
  lighting.density_ = std::move(points);
  return lighting;
}

Lighting Lighting::table(BrdfTable table, std::string name) {
  check(table);
  if (table.channels != 1) {
    throw ArgumentError("lighting table '" + name + "' has " + std::to_string(table.channels) +
                        " channels; expected one");
  }
  Lighting lighting(Kind::table);
  lighting.name_ = "table:" + std::move(name);
  lighting.table_ = std::make_shared<const BrdfTable>(std::move(table));
  lighting.is_told_by_name_ = false;
  return lighting;
}

Lighting Lighting::material(Reflectance eta, std::string name) {
  if (eta.channels() != 1) {
    throw ArgumentError("material '" + (name.empty() ? eta.name() : name) + "' of a lighting has " +
                        std::to_string(eta.channels()) + " channels; expected one, for files as in FILE[channels=red]");
  }
  Lighting lighting(Kind::material);
  const auto told = eta.formula() != nullptr ? specification(*eta.formula()) : std::nullopt;
  if (name.empty()) name = told.value_or(eta.name());
  lighting.is_told_by_name_ = told && told == specification_by(name);
  lighting.name_ = "material:" + std::move(name);
  lighting.material_ = std::make_shared<const Reflectance>(std::move(eta));
  return lighting;
}

Lighting Lighting::recorded(std::string name, std::string definition) {
  Lighting lighting(Kind::table);
  lighting.name_ = std::move(name);
  lighting.definition_ = std::move(definition);
  lighting.is_told_by_name_ = false;
  return lighting;
}

const BrdfTable& Lighting::table() const {
  if (!table_) throw ArgumentError("lighting '" + name_ + "' is known by name alone; expected its table");
  return *table_;
}

const Reflectance& Lighting::material() const {
  if (!material_) throw ArgumentError("lighting '" + name_ + "' is known by name alone; expected its material");
  return *material_;
}

std::string Lighting::stem() const {
  constexpr std::string_view kReplaced = ":=,/ *+@()[]";
  std::string stem = name_;
  for (char& c : stem) {
    if (kReplaced.find(c) != std::string_view::npos) c = '-';
  }
  return stem;
}

std::string Lighting::definition() const {
  if (!definition_.empty()) return definition_;
  const std::string measure = ", dmu(X) = cos(theta_X) domega_X";
  const std::string roots = "; norm |f| = sqrt(f.f), distance |f-g|";
  switch (kind_) {
    case Kind::point:
      return "f.g = integral of f(L,V) g(L,V) dmu(L) dmu(V)" + measure + ": W = identity in eq. 5.23 of Neumann 2001" +
             roots;
    case Kind::daylight:
      return "f.g = integral of a_f(L) a_g(L) dmu(L), a_f(L) = integral of f(L,V) dmu(V)" + measure +
             ": W = 1 in eq. 5.23 of Neumann 2001; semi-norm |f| = sqrt(f.f), distance |f-g|";
    case Kind::mean_albedo:
      return "f.g = integral of f dmu dmu times that of g" + measure + "; semi-norm |f| = sqrt(f.f), distance |f-g|";
    case Kind::patches:
      return "f.g = integral of C_{f,g}(L,V) W(L,V) dmu(L) dmu(V)" + measure +
             ", W = sum of w(R) C_{eta_R}, eta_R the basic BRDF of radius R (eqs. 5.23 and 4.2 of Neumann 2001)" +
             roots;
    case Kind::table:
      return "f.g = integral of C_{f,g}(L,V) W(L,V) dmu(L) dmu(V)" + measure +
             ", W tabulated and symmetrised (eqs. 5.23 and 5.26 of Neumann 2001)" + roots;
    case Kind::material:
      return "f.g = integral of C_{eta,f}(L,V) C_{eta,g}(L,V) dmu(L) dmu(V)" + measure + ", eta = '" +
             name_.substr(name_.find(':') + 1) + "': W = C_eta in eq. 5.23 of Neumann 2001" + roots;
  }
  return {};
}

int Lighting::product_power() const {
  return traits_of(kind_).product_power;
}

std::vector<PatchShare> Lighting::shares(int nodes) const {
  if (density_.empty()) return shares_;
  const GaussRule gauss = gauss_rule(nodes);
  std::vector<PatchShare> shares;
  const auto add = [&](double from, double to, auto value) {
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const double radius = from + (to - from) * gauss.nodes[k];
      const double weight = (to - from) * gauss.weights[k] * value(radius);
      if (weight > 0) shares.push_back({radius, weight});
    }
  };
  for (std::size_t k = 0; k + 1 < density_.size(); ++k) {
    const double from = density_[k].radius;
    const double to = density_[k + 1].radius;
    const double first = density_[k].value;
    const double last = density_[k + 1].value;
    const auto value = [&](double radius) { return first + (last - first) * (radius - from) / (to - from); };
    // The normalising constant of eta_R has a kink at R = 1.
    const double middle = from < 1 && 1 < to ? 1 : to;
    add(from, middle, value);
    if (middle < to) add(middle, to, value);
  }
  return shares;
}

std::vector<double> Lighting::radii() const {
  std::vector<double> radii;
  for (const PatchShare& share : shares_) radii.push_back(share.radius);
  for (const DensityPoint& point : density_) radii.push_back(point.radius);
  return radii;
}

std::span<const WrittenForm> lighting_forms() {
  return kForms;
}

Lighting parse_lighting(std::string_view name) {
  const std::size_t colon = name.find(':');
  const std::string_view word = name.substr(0, colon);
  const std::string_view rest = colon == std::string_view::npos ? std::string_view{} : name.substr(colon + 1);
  const auto* found = std::ranges::find(kForms, word, &WrittenForm::word);
  if (found == kForms.end()) {
    const auto* meant = std::ranges::find(kForms, name.substr(0, name.find('=')), &WrittenForm::word);
    if (meant != kForms.end()) {
      throw ArgumentError("cannot read lighting '" + std::string(name) + "'; expected " + std::string(meant->written));
    }
    std::vector<std::string_view> known;
    for (const WrittenForm& form : kForms) known.push_back(form.word);
    throw ArgumentError("unknown lighting '" + std::string(name) + "'" + did_you_mean(word, known));
  }
  const auto index = found - kForms.begin();
  if (index < 3) {
    if (colon != std::string_view::npos) {
      throw ArgumentError("lighting '" + std::string(word) + "' takes no value; expected the word alone");
    }
    return index == 0 ? Lighting::point() : index == 1 ? Lighting::daylight() : Lighting::mean_albedo();
  }
  if (rest.empty()) {
    throw ArgumentError("lighting '" + std::string(word) + "' lacks its values; expected " +
                        std::string(found->written));
  }
  if (found->word == "table")
    throw ArgumentError("lighting '" + std::string(name) + "' is a file; expected one by name");
  if (found->word == "material") return Lighting::material(parse_material(rest), std::string(rest));
  if (index == 3) return Lighting::patch(read_number(rest, name));
  if (index == 4) {
    std::vector<PatchShare> shares;
    for (const auto& [radius, weight] : read_pairs(rest, name)) shares.push_back({radius, weight});
    return Lighting::mixture(std::move(shares));
  }
  std::vector<DensityPoint> points;
  for (const auto& [radius, value] : read_pairs(rest, name)) points.push_back({radius, value});
  return Lighting::density(std::move(points));
}

}  // namespace lobe
