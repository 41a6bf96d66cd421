#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>

#include "energy/plausibility.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"
#include "model/catalogue.hpp"

namespace lobe {
namespace {

/// A parameter's range as a function of 0 .. 1.
class Range {
 public:
  explicit Range(const Parameter& parameter) : parameter_(parameter) {
    constexpr double kWide = 99;  // above that a range is taken by its logarithm
    constexpr double kFar = 1e6;
    constexpr double kLeast = 0.01;  // where such a range begins at 0
    low_ = parameter.minimum;
    high_ = std::isinf(parameter.maximum) ? std::max(kFar, low_) : parameter.maximum;
    start_ = low_ > 0 ? low_ : kLeast;
    is_logarithmic_ = low_ >= 0 && high_ / start_ > kWide * (low_ > 0 ? 1 : 1 / kLeast);
  }

  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }
  /// Where everything else is looked at: a little above the middle, which of refractive indices is 1 and reflects
  /// nothing.
  [[nodiscard]] double middle() const {
    constexpr double kMiddle = 0.55;
    return parameter_.default_value.value_or(at(kMiddle));
  }

  /// A turn about the normal changes nothing.
  [[nodiscard]] bool matters() const { return parameter_.name != "rotation"; }

  /// To three digits, within the range.
  [[nodiscard]] double at(double share) const {
    share = std::clamp(share, 0.0, 1.0);
    const double exact = is_logarithmic_ ? start_ * std::pow(high_ / start_, share) : low_ + (high_ - low_) * share;
    return std::clamp(std::stod(fmt::format("{:.3g}", exact)), low_, high_);
  }

  [[nodiscard]] double share(double value) const {
    const double exact = is_logarithmic_ ? std::log(std::max(value, start_) / start_) / std::log(high_ / start_)
                                         : (value - low_) / (high_ - low_);
    return std::clamp(exact, 0.0, 1.0);
  }

 private:
  const Parameter& parameter_;
  double low_;
  double high_;
  double start_;
  bool is_logarithmic_;
};

std::vector<Range> ranges_of(const Model& model) {
  std::vector<Range> ranges;
  for (const auto& parameter : model.parameters) ranges.emplace_back(parameter);
  return ranges;
}

Material material_of(const Model& model, const std::vector<double>& values) {
  std::vector<std::pair<std::string, double>> named;
  for (std::size_t i = 0; i < values.size(); ++i) named.emplace_back(model.parameters[i].name, values[i]);
  return make_material(model.name, named);
}

/// Whether these values make no anisotropic lobe whose albedos take too long.
bool is_taken(const CatalogueEntry& entry, const std::vector<double>& values) {
  constexpr double kAspect = 20;
  return entry.shape(values).aspect <= kAspect;
}

/// How bad an albedo is: first growth, then size.
std::pair<double, double> badness(const AlbedoBound& bound) {
  return {bound.growth ? bound.growth->value : 0, bound.growth ? 0 : bound.largest.value};
}

/// Worse by what counts: of findings that are nearly the same the first one stays.
bool is_worse(const AlbedoBound& bound, const AlbedoBound& than) {
  constexpr double kGrowth = 0.01;
  constexpr double kRelative = 1e-3;
  constexpr double kAbsurd = 1e6;  // a high power of what is above 1: that it is above 1 tells as much
  const auto [growth, size] = badness(bound);
  const auto [other_growth, other_size] = badness(than);
  if (growth > other_growth + kGrowth) return true;
  if (growth > 0 || other_growth > 0) return false;
  if (size > kAbsurd && other_size > 1) return false;
  return size > other_size + kRelative * std::abs(other_size);
}

class ModelCheck {
 public:
  ModelCheck(const Device& device, const Model& model, const CatalogueOptions& options)
      : device_(device), model_(model), options_(options) {
    result_.model = model.name;
  }

  ModelPlausibility result() {
    for (const auto& material : checked_materials(model_.name, options_.random)) {
      look_at(material);
      if (nodes_ >= options_.nodes) break;
    }
    if (result_.materials == 0) {
      throw NumericError("no albedo of the model '" + std::string(model_.name) + "' could be computed");
    }
    if (options_.is_pursued) pursue();
    return result_;
  }

 private:
  void look_at(const Material& material) {
    Plausibility found;
    try {
      found = check_plausibility(device_, material, options_.material);
    } catch (const NumericError&) {
      ++result_.overflowing;
      return;
    }
    nodes_ += found.nodes;
    const bool is_first = result_.materials++ == 0;
    const ChannelPlausibility& channel = found.channels.front();
    const ModelPlausibility::Worst worst{material, channel};
    if (is_first || channel.least.value.value < result_.least.found.least.value.value) result_.least = worst;
    if (is_first || channel.reciprocity.relative > result_.reciprocity.found.reciprocity.relative) {
      result_.reciprocity = worst;
    }
    const ChannelPlausibility& before = result_.albedo.found;
    const bool is_first_excess = before.conserves_energy && !channel.conserves_energy;
    if (is_first || is_first_excess || is_worse(channel.albedo, before.albedo)) result_.albedo = worst;
    result_.is_non_negative = result_.is_non_negative && channel.is_non_negative;
    result_.is_reciprocal = result_.is_reciprocal && channel.is_reciprocal;
    result_.conserves_energy = result_.conserves_energy && channel.conserves_energy;
  }

  /// From where the albedo is largest on to where it is larger, a parameter at a time, by steps that shrink when they
  /// lead nowhere.
  void pursue() {
    constexpr double kLeastStep = 0.03;
    constexpr int kRounds = 12;
    double step = 0.5;
    for (int round = 0; round < kRounds && step > kLeastStep; ++round) {
      const double before = result_.albedo.found.albedo.largest.value;
      for (std::size_t i = 0; i < model_.parameters.size(); ++i) {
        for (const double sign : {-1.0, 1.0}) {
          if (!is_worth_pursuing()) return;
          look_beside(result_.albedo.material.terms.front().values, i, sign * step);
        }
      }
      if (result_.albedo.found.albedo.largest.value == before) step *= 0.5;
    }
  }

  [[nodiscard]] bool is_worth_pursuing() const {
    constexpr double kLarge = 10;  // above, how large it is tells nothing
    const ChannelPlausibility& worst = result_.albedo.found;
    return !worst.albedo.growth && !worst.conserves_energy && worst.albedo.largest.value < kLarge;
  }

  void look_beside(std::vector<double> values, std::size_t parameter, double step) {
    const Range range(model_.parameters[parameter]);
    const double before = values[parameter];
    values[parameter] = range.at(range.share(before) + step);
    if (range.matters() && values[parameter] != before && is_taken(find_entry(model_.name), values)) {
      look_at(material_of(model_, values));
    }
  }

  const Device& device_;
  const Model& model_;
  const CatalogueOptions& options_;
  ModelPlausibility result_;
  std::uint64_t nodes_ = 0;
};

}  // namespace

std::vector<Material> checked_materials(std::string_view name, std::size_t random) {
  const CatalogueEntry& entry = find_entry(name);
  const Model& model = entry.model;
  const auto ranges = ranges_of(model);
  std::vector<Material> materials;
  const auto take = [&](const std::vector<double>& values) {
    if (is_taken(entry, values)) materials.push_back(material_of(model, values));
  };
  std::vector<double> middle;
  for (const auto& range : ranges) middle.push_back(range.middle());
  take(middle);
  std::vector<double> low = middle;
  std::vector<double> high = middle;
  std::size_t free = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (!ranges[i].matters()) continue;
    ++free;
    low[i] = ranges[i].low();
    high[i] = ranges[i].high();
    for (const double end : {low[i], high[i]}) {
      auto values = middle;
      values[i] = end;
      if (end != middle[i]) take(values);
    }
  }
  if (free == 0) return materials;
  if (free > 1) {
    take(low);
    take(high);
  }
  constexpr std::uint64_t kSeed = 2001;
  std::mt19937_64 generator(kSeed);
  const std::size_t most = materials.size() + random;
  constexpr std::size_t kTries = 100;
  for (std::size_t k = 0; k < kTries * random && materials.size() < most; ++k) {
    std::vector<double> values = middle;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const double share = std::ldexp(static_cast<double>(generator() >> 11U), -53);
      // Defaults are values that matter: 1 for reflectances that make others smaller.
      const bool is_kept = !ranges[i].matters() || (k % 2 == 0 && model.parameters[i].default_value);
      if (!is_kept) values[i] = ranges[i].at(share);
    }
    take(values);
  }
  return materials;
}

ModelPlausibility check_model(const Device& device, std::string_view model, const CatalogueOptions& options) {
  return ModelCheck(device, find_model(model), options).result();
}

std::vector<ModelPlausibility> check_catalogue(const Device& device, const CatalogueOptions& options,
                                               const ProgressCallback& progress) {
  std::vector<ModelPlausibility> found;
  for (const Model& model : catalogue()) {
    const double share = static_cast<double>(found.size()) / static_cast<double>(catalogue().size());
    if (progress && !progress("check", share)) throw Cancelled("the check of the catalogue was cancelled");
    found.push_back(check_model(device, model.name, options));
  }
  return found;
}

bool agrees_with_traits(const ModelPlausibility& model) {
  const Traits& traits = find_model(model.model).traits;
  return model.is_non_negative == traits.non_negative && model.is_reciprocal == traits.reciprocal &&
         model.conserves_energy == traits.conserves_energy;
}

}  // namespace lobe
