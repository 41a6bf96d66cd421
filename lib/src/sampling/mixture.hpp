#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "device/draw_directions.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/sampling/sampling.hpp"

namespace lobe {

/// Mirror or RRIM of a reflectance at L.
struct DeltaDirection {
  SampleKind kind = SampleKind::mirror;
  UnitVector direction{};
  std::vector<double> factors;  ///< by channel
};

/// Those that reflect any light.
/// \param mirror share of the light that it reflects, by channel
/// \param retro that of the RRIM
[[nodiscard]] std::vector<DeltaDirection> delta_directions(const UnitVector& light, std::vector<double> mirror,
                                                           std::vector<double> retro);

/// A density to draw from.
struct Mixture {
  std::vector<ProposalPart> parts;     ///< the last ones are the delta parts
  std::vector<DeltaDirection> deltas;  ///< in their order
  std::size_t channels = 1;

  /// The delta direction that a part draws; null if it draws from a density.
  [[nodiscard]] const DeltaDirection* delta_of(std::size_t part) const {
    const std::size_t smooth = parts.size() - deltas.size();
    return part < smooth ? nullptr : &deltas[part - smooth];
  }
};

/// Least albedo of smooth parts beside delta parts, as a share of theirs, and of a term beside the largest.
inline constexpr double kLeastShare = 1e-3;

/// Mean of the absolute values.
[[nodiscard]] double mean_size(std::span<const double> channels);

/// Delta parts beside others, by how much light each reflects.
[[nodiscard]] Mixture with_deltas(std::vector<ProposalPart> smooth, double smooth_albedo,
                                  std::vector<DeltaDirection> deltas, std::size_t channels);

/// About how much light each term of a material reflects from L, from a few samples; 1 of a term that is alone.
/// \param smooth without delta parts
/// \param is_alone whether there are no delta parts beside it
/// \throws DeviceError
[[nodiscard]] std::vector<double> term_albedos(const Device& device, const Material& smooth, bool is_alone,
                                               const UnitVector& light, const SamplingOptions& options);

/// The density that directions V of a material are drawn from.
/// \param albedos of its terms, by which their densities are mixed; any numbers keep weights unbiased
[[nodiscard]] Mixture mixture_of(const Material& smooth, std::span<const double> albedos,
                                 std::vector<DeltaDirection> deltas, std::size_t channels, const UnitVector& light,
                                 const SamplingOptions& options);

/// A sampler of a material's directions that weighs them by its values.
/// \throws DeviceError
[[nodiscard]] DirectionSampler make_sampler(const Device& device, const Material& smooth, const UnitVector& light,
                                            std::span<const ProposalPart> parts, Precision precision,
                                            std::size_t capacity);

}  // namespace lobe
