#include "model/divisor_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include "core/text.hpp"
#include "hemisphere/albedo_curve.hpp"

namespace lobe {
namespace {

constexpr double kAlike = 1e-6;

bool is_smooth(const Pumping& pumping) {
  return pumping.correction == Correction::complement || pumping.correction == Correction::viewer;
}

/// Tells the kinks of one curve from those of others.
std::string name_of(const Pumping& pumping, std::size_t step) {
  std::string name = std::string(to_string(pumping.correction)) + " " + std::to_string(step);
  for (std::size_t k = 0; k <= step; ++k) {
    for (const double number : pumping.albedos[k]) name += " " + shortest(number);
  }
  return name;
}

/// The divisor that the curve of a step finds, as kernels/lobes/pumping.clh has it: G, or 1.
double divisor_before(const Pumping& pumping, std::size_t step, double cos_i, double cos_o) {
  if (pumping.correction != Correction::controlled) return 1;
  double divisor = 1;
  for (std::size_t k = 0; k < step; ++k) {
    const auto& curve = pumping.albedos[k];
    divisor = std::max({divisor * std::max(curve_value(curve, cos_i), curve_value(curve, cos_o)), cos_i, cos_o});
  }
  return divisor;
}

}  // namespace

std::function<unsigned(double cos_i, double cos_o)> divisor_pieces(const Pumping& pumping) {
  if (is_smooth(pumping)) {
    return [](double, double) { return 0U; };  // smooth
  }
  return [pumping](double cos_i, double cos_o) {
    unsigned piece = 0;
    double divisor = 1;
    for (const auto& curve : pumping.albedos) {
      // G max(a(L), a(V)) and the cosines, as kernels/lobes/pumping.clh has them; the first of those that are alike.
      const double before = pumping.correction == Correction::controlled ? divisor : 1;
      const std::array<double, 4> arguments = {before * curve_value(curve, cos_i), before * curve_value(curve, cos_o),
                                               cos_i, cos_o};
      const std::size_t count = pumping.correction == Correction::g1 ? 2 : arguments.size();
      std::size_t largest = 0;
      for (std::size_t k = 1; k < count; ++k) {
        if (arguments[k] > arguments[largest] * (1 + kAlike)) largest = k;
      }
      divisor = arguments[largest];
      piece = 4 * piece + static_cast<unsigned>(largest);
    }
    return piece;
  };
}

std::vector<Kink> cosine_pieces_kinks(const Pumping& pumping) {
  if (is_smooth(pumping) || pumping.correction == Correction::g1) return {};
  const auto shared = std::make_shared<const Pumping>(pumping);
  std::vector<Kink> kinks;
  for (std::size_t step = 0; step < pumping.albedos.size(); ++step) {
    const auto over_cosines = [shared, step](const KinkPair& pair) {
      const auto& curve = shared->albedos[step];
      const double albedo = std::max(curve_value(curve, pair.cos_i), curve_value(curve, pair.cos_o));
      return divisor_before(*shared, step, pair.cos_i, pair.cos_o) * albedo * (1 + kAlike) -
             std::max(pair.cos_i, pair.cos_o);
    };
    kinks.push_back({.order = 1, .by = over_cosines, .text = name_of(pumping, step) + " cosine"});
  }
  return kinks;
}

std::vector<Kink> albedo_pieces_kinks(const Pumping& pumping) {
  if (is_smooth(pumping)) return {};
  const auto shared = std::make_shared<const Pumping>(pumping);
  std::vector<Kink> kinks;
  for (std::size_t step = 0; step < pumping.albedos.size(); ++step) {
    // The mean slope of the curve between the two cosines, which N.L = N.V is no zero of.
    const auto slope = [shared, step](const KinkPair& pair) {
      const auto& curve = shared->albedos[step];
      const double low = curve_value(curve, std::min(pair.cos_i, pair.cos_o));
      const double high = curve_value(curve, std::max(pair.cos_i, pair.cos_o));
      return (high - low) / std::max(std::abs(pair.cos_i - pair.cos_o), kAlike) + kAlike * high;
    };
    kinks.push_back({.order = 1, .by = slope, .text = name_of(pumping, step) + " albedo"});
  }
  return kinks;
}

}  // namespace lobe
