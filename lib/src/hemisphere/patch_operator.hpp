#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "device/tabulate_patch_light.hpp"
#include "hemisphere/disc_polynomials.hpp"

namespace lobe {

/// The W of patch lights in polynomials of the base plane: for each azimuthal order m the matrix of
///   W_kl = integral of phi_mk(X) W(X, Y) phi_ml(Y) dX dY  over the unit disc.
/// W = sum of factor (1_R 1_R), where 1_R takes a function to its integrals over discs of radius R about P, cut by the
/// unit disc; the boundary of that has a line integral for each polynomial (Green), exact to rounding.
[[nodiscard]] std::vector<Eigen::MatrixXd> patch_light_matrices(const DiscPolynomials& polynomials,
                                                                std::span<const LightDisc> discs);

}  // namespace lobe
