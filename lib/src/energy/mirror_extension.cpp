#include "energy/mirror_extension.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "energy/channel_albedo.hpp"
#include "energy/prepare.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/terms.hpp"

namespace lobe {

Material extended_by_mirror(const Device& device, const Material& material, const Adjustment& adjustment) {
  require_isotropic(material, "the adjustment 'mirror'");
  const std::size_t channels = material.channels();
  const std::vector<Factor> boundary = boundary_of(adjustment);
  Material result = material;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const Material one = channel_of(material, channel);
    Term mirror = make_material("mirror").terms.front();
    mirror.factors = boundary;
    if (!one.terms.empty()) {
      mirror.complement_of = albedo_curve(device, one, "extended by a mirror");
      for (const double theta : curve_angles(mirror.complement_of)) {
        const double albedo = curve_value(mirror.complement_of, std::cos(theta));
        if (albedo <= 1 + kAdjustmentError) continue;
        throw NumericError(
            fmt::format("'{}' cannot be extended by a mirror: its albedo is {} at {} degrees; expected at most 1, as "
                        "'normalise' makes it",
                        material.name, shortest(std::round(albedo * 1e4) / 1e4),
                        shortest(std::round(to_degrees(theta) * 1e4) / 1e4)));
      }
    }
    if (channels > 1) {
      mirror.weight.assign(channels, 0.0);
      mirror.weight[channel] = 1;
    }
    result.terms.push_back(std::move(mirror));
  }
  return result;
}

}  // namespace lobe
