#pragma once

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// The material of one model with what its facets scatter more than once, channel by channel (Kelemen and
/// Szirmay-Kalos 2001, Kulla and Conty 2017): f + m (1 - a(L)) (1 - a(V)) / (pi (1 - A)), with a and A the albedo and
/// the mean albedo of the model without Fresnel term, F the mean of that term, m = F^2 A / (1 - F (1 - A)).
/// The Fresnel term is Schlick's f0 of the model, or a factor fresnel or f82.
/// \throws ArgumentError for several models, other factors, and two Fresnel terms or another one; NumericError for
///   anisotropic models, and for an albedo that is above 1, 0 or not smooth enough for a curve
[[nodiscard]] Material with_multiple_scattering(const Device& device, const Material& material);

/// The material of one model scaled towards each viewer, channel by channel (Turquin 2019): f (1 + F (1 - a(V)) /
/// a(V)), with a as above and F the Fresnel term at the normal. It is not reciprocal: a viewer sees all of a uniform
/// sky where F = 1, while albedos of light may be below and above 1.
/// \throws as with_multiple_scattering(), and ArgumentError for a model that is not reciprocal or black
[[nodiscard]] Material scaled_for_viewers(const Device& device, const Material& material);

}  // namespace lobe
