#pragma once

#include "lobe/model/model.hpp"
#include "model/draw.hpp"

namespace lobe {

[[nodiscard]] Parameter surface_height();       ///< sigma, rms height over the wavelength
[[nodiscard]] Parameter surface_correlation();  ///< tau, autocorrelation length over the wavelength

/// The profile of a Gaussian height field at normal incidence, where it is widest (He et al. 1991, eq. 78).
/// \param sigma_over rms height, over the wavelength
/// \param tau_over autocorrelation length, over the wavelength
[[nodiscard]] ProposalPart diffraction_patch(const UnitVector& centre, double sigma_over, double tau_over);

}  // namespace lobe
