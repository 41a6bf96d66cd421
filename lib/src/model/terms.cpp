#include "model/terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "device/lobe_batch.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/written_form.hpp"
#include "model/factors.hpp"
#include "model/formula.hpp"

namespace lobe {
namespace {

constexpr std::string_view kNormalise = "normalise";
constexpr std::string_view kPump = "pump";
constexpr std::string_view kMirror = "mirror";
constexpr std::string_view kKullaConty = "kulla_conty";
constexpr std::string_view kTurquin = "turquin";
constexpr std::array<std::string_view, 5> kCorrections = {"g1", "g2", "controlled", "complement", "viewer"};
constexpr std::size_t kPumpCorrections = 3;  // of these
constexpr int kMostTimes = 10;
constexpr std::array kForms{
    WrittenForm{kNormalise, kNormalise, "scaled to a largest albedo of 1"},
    WrittenForm{kPump, "pump:correction=KIND,times=N",
                "made brighter by its own albedos; KIND is g1, g2 or controlled"},
    WrittenForm{kMirror, "mirror:ior=X,k=Y",
                "an ideal mirror added for the light that is left, as of that refractive index"},
    WrittenForm{kKullaConty, kKullaConty, "what facets scatter more than once added, to an albedo of 1 for f0 = 1"},
    WrittenForm{kTurquin, kTurquin,
                "scaled towards each viewer by what facets scatter more than once; not reciprocal"}};

/// \param known those that are taken
Correction parse_correction(std::string_view name, std::span<const std::string_view> known) {
  const auto found = std::ranges::find(known, name);
  if (found != known.end()) return static_cast<Correction>(found - known.begin());
  throw ArgumentError("unknown correction '" + std::string(name) + "'" + did_you_mean(name, known));
}

int parse_times(std::string_view text) {
  double times = 0;
  if (!parse_number(text, times) || times != std::floor(times) || times < 1 || times > kMostTimes) {
    throw ArgumentError("times of 'pump' is '" + std::string(text) + "'; expected a whole number from 1 to " +
                        std::to_string(kMostTimes));
  }
  return static_cast<int>(times);
}

void require_curve(const std::vector<double>& curve, std::string_view what) {
  const std::string fault = fault_of_curve(curve);
  if (!fault.empty()) throw ArgumentError(std::string(what) + " " + fault);
}

/// An albedo, which is finite and not below 0 but for rounding.
void require_albedo(const std::vector<double>& curve, std::string_view what) {
  constexpr double kRounding = 1e-6;
  require_curve(curve, what);
  for (const double theta : curve_angles(curve)) {
    const double value = curve_value(curve, std::cos(theta));
    if (std::isfinite(value) && value >= -kRounding) continue;
    throw ArgumentError(fmt::format("{} is {} somewhere; expected a finite number, 0 or more", what, shortest(value)));
  }
}

void require_curves(const std::vector<std::vector<double>>& albedos) {
  if (albedos.empty()) throw ArgumentError("pumping has no albedos; expected one curve per step");
  for (const auto& curve : albedos) require_curve(curve, "an albedo of pumping");
}

/// Reads "key=value,...".
/// \param read takes a key and its value, and says whether it knows the key
template <typename Read>
void read_keys(std::string_view text, std::string_view name, std::span<const std::string_view> keys, const Read& read) {
  for (const auto part : split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string_view key = trim(part.substr(0, equals));
    const std::string_view value = equals == std::string_view::npos ? "" : trim(part.substr(equals + 1));
    const auto found = std::ranges::find(keys, key);
    if (found == keys.end()) {
      throw ArgumentError(fmt::format("'{}' has no parameter '{}'{}", name, key, did_you_mean(key, keys)));
    }
    read(static_cast<std::size_t>(found - keys.begin()), value);
  }
}

double parse_index(std::string_view key, std::string_view text) {
  double value = 0;
  if (!parse_number(text, value)) {
    throw ArgumentError(fmt::format("{} of 'mirror' is '{}'; expected a number", key, text));
  }
  return value;
}

Adjustment parse_mirror(std::string_view text) {
  constexpr std::array<std::string_view, 2> kKeys = {"ior", "k"};
  Adjustment adjustment{.kind = Adjustment::Kind::mirror};
  read_keys(text, kMirror, kKeys, [&](std::size_t key, std::string_view value) {
    const double number = parse_index(kKeys[key], value);
    if (key == 0) {
      adjustment.ior = number;
    } else {
      adjustment.k = number;
    }
  });
  if (!adjustment.ior) throw ArgumentError("'mirror' has k and no ior; expected both, or ior alone");
  static_cast<void>(boundary_of(adjustment));  // within range
  return adjustment;
}

Adjustment parse_pump(std::string_view text) {
  constexpr std::array<std::string_view, 2> kKeys = {"correction", "times"};
  Adjustment adjustment{.kind = Adjustment::Kind::pump};
  read_keys(text, kPump, kKeys, [&](std::size_t key, std::string_view value) {
    if (key == 0) {
      adjustment.correction = parse_correction(value, std::span(kCorrections).first(kPumpCorrections));
    } else {
      adjustment.times = parse_times(value);
    }
  });
  return adjustment;
}

}  // namespace

std::string_view to_string(Correction correction) {
  return kCorrections.at(static_cast<std::size_t>(correction));
}

std::string to_string(const Adjustment& adjustment) {
  switch (adjustment.kind) {
    case Adjustment::Kind::normalise:
      return std::string(kNormalise);
    case Adjustment::Kind::pump:
      return fmt::format("{}:correction={},times={}", kPump, to_string(adjustment.correction), adjustment.times);
    case Adjustment::Kind::kulla_conty:
      return std::string(kKullaConty);
    case Adjustment::Kind::turquin:
      return std::string(kTurquin);
    case Adjustment::Kind::mirror:
      break;
  }
  if (!adjustment.ior) return std::string(kMirror);
  return fmt::format("{}:ior={},k={}", kMirror, shortest(*adjustment.ior), shortest(adjustment.k));
}

std::span<const WrittenForm> adjustment_forms() {
  return kForms;
}

Adjustment parse_adjustment(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = trim(text.substr(0, colon));
  if (std::ranges::find(kForms, name, &WrittenForm::word) == kForms.end()) {
    if (const std::size_t at = name.find_first_of("+*"); at != std::string_view::npos) {
      throw ArgumentError(
          fmt::format("adjustment '{}' is followed by '{}'; adjustments come last, and hold for the "
                      "whole sum",
                      trim(name.substr(0, at)), name[at]));
    }
    std::vector<std::string_view> known;
    for (const WrittenForm& form : kForms) known.push_back(form.word);
    throw ArgumentError("unknown adjustment '" + std::string(name) + "'" + did_you_mean(name, known));
  }
  const bool has_parameters = colon != std::string_view::npos;
  const std::string_view parameters = has_parameters ? text.substr(colon + 1) : "";
  if (name == kPump) return has_parameters ? parse_pump(parameters) : Adjustment{.kind = Adjustment::Kind::pump};
  if (name == kMirror) return has_parameters ? parse_mirror(parameters) : Adjustment{.kind = Adjustment::Kind::mirror};
  if (has_parameters) throw ArgumentError(fmt::format("'{}' takes no parameters", name));
  if (name == kKullaConty) return {.kind = Adjustment::Kind::kulla_conty};
  return {.kind = name == kTurquin ? Adjustment::Kind::turquin : Adjustment::Kind::normalise};
}

std::vector<Factor> boundary_of(const Adjustment& mirror) {
  if (!mirror.ior) return {};
  return {make_factor("fresnel", {{"ior", *mirror.ior}, {"k", mirror.k}})};
}

Pumping make_pumping(std::string_view correction, std::vector<std::vector<double>> albedos) {
  require_curves(albedos);
  return {parse_correction(correction, kCorrections), std::move(albedos)};
}

Term make_custom_term(Formula formula, const std::vector<double>& values) {
  Term term{.model = std::string(kCustomModel), .values = values, .weight = {1.0}, .formula = std::move(formula)};
  require_consistent(term);
  return term;
}

void require_consistent(const Term& term) {
  if (term.factors.size() > kMaxFactors) {
    throw ArgumentError("a term of model '" + term.model + "' has " + std::to_string(term.factors.size()) +
                        " factors; expected at most " + std::to_string(kMaxFactors));
  }
  if (term.pumping) require_curves(term.pumping->albedos);
  if (!term.complement_of.empty()) {
    require_albedo(term.complement_of, "the albedo that a term is the complement of");
    if (!traits_of(term).has_delta) {
      throw ArgumentError("a term of model '" + term.model + "' is the complement of an albedo; expected a delta part");
    }
  }
  if (!term.formula) return;
  require_valid(*term.formula);
  if (term.values.size() != term.formula->parameters.size()) {
    throw ArgumentError("formula has " + std::to_string(term.formula->parameters.size()) + " parameters and " +
                        std::to_string(term.values.size()) + " values; expected one each");
  }
  for (std::size_t k = 0; k < term.values.size(); ++k) {
    if (std::isfinite(term.values[k])) continue;
    throw ArgumentError("parameter '" + term.formula->parameters[k] + "' of a formula is " + shortest(term.values[k]) +
                        "; expected a finite number");
  }
}

std::vector<Term> split_by_channel(std::vector<Term> of_channels) {
  const std::size_t channels = of_channels.size();
  const auto is_first = [&](const Term& term) { return term.values == of_channels.front().values; };
  if (std::ranges::all_of(of_channels, is_first)) return {std::move(of_channels.front())};
  for (std::size_t c = 0; c < channels; ++c) {
    of_channels[c].weight.assign(channels, 0.0);
    of_channels[c].weight[c] = 1;
  }
  return of_channels;
}

void apply_weight(std::vector<Term>& terms, const std::vector<double>& weight) {
  for (Term& term : terms) {
    const std::size_t channels = std::max(term.weight.size(), weight.size());
    if ((term.weight.size() != 1 && term.weight.size() != channels) ||
        (weight.size() != 1 && weight.size() != channels)) {
      throw ArgumentError("scale has " + std::to_string(weight.size()) + " values and parameters of model '" +
                          term.model + "' have " + std::to_string(term.weight.size()) + "; expected as many, or one");
    }
    std::vector<double> product;
    for (std::size_t c = 0; c < channels; ++c) {
      product.push_back(term.weight[term.weight.size() == 1 ? 0 : c] * weight[weight.size() == 1 ? 0 : c]);
    }
    term.weight = std::move(product);
  }
}

std::string family_of(const std::vector<Term>& terms) {
  const auto is_alike = [&](const Term& term) { return term.model == terms.front().model; };
  if (!std::ranges::all_of(terms, is_alike)) return "mixture";
  const Term& first = terms.front();
  // One per channel is one model; anything else with several terms is a mixture.
  const auto is_of_one_channel = [](const Term& term) {
    return std::ranges::count_if(term.weight, [](double weight) { return weight != 0; }) <= 1;
  };
  const bool is_split = terms.size() == first.weight.size() && std::ranges::all_of(terms, is_of_one_channel);
  if (terms.size() > 1 && !is_split) return "mixture";
  return first.formula ? std::string(kCustomModel) : std::string(find_model(first.model).family);
}

}  // namespace lobe
