#include "model/divisor_pieces.hpp"

#include <array>
#include <cstddef>

#include "hemisphere/albedo_curve.hpp"

namespace lobe {

std::function<unsigned(double cos_i, double cos_o)> divisor_pieces(const Pumping& pumping) {
  constexpr double kAlike = 1e-6;
  if (pumping.correction == Correction::complement || pumping.correction == Correction::viewer) {
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

}  // namespace lobe
