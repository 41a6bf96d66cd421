#pragma once

#include <Eigen/Core>
#include <optional>

#include "lobe/metric/lighting.hpp"
#include "lobe/table/brdf_function.hpp"
#include "metric/products.hpp"

namespace lobe {

/// Whether the norm of a function does not exist: whether what each decade of the cosine of a grazing direction adds to
/// the integral of f^2 (point), or of the squared albedo by V (daylight), does not decay towards the horizon. Looked at
/// from 1e-7 to 1e-10: growth as cos^-1 adds the same in each decade, cos^-a a part 10^-2(1-a) of the one before.
/// Decades that add more than 0.8 of the one before count as not decaying (a > 0.95), unless all of them together are
/// below rounding: below 1e-12 of what is added about 0.1, where stored angles of single precision end.
[[nodiscard]] bool has_infinite_norm(const BrdfFunction& function, const Lighting& lighting);

/// Bound on what cosines that the quadrature of formulas does not see add to the integral of f^2 (point), of the
/// squared albedo by V (daylight), or of the squares under patch lights, where these grow towards the horizon: the
/// integral below kUnseenCosine of what a decade adds, continued by its measured power; under patch lights that of
/// squared albedos times the largest value of W. 0 under other lightings; none where has_infinite_norm().
[[nodiscard]] std::optional<double> finite_unseen_square(const BrdfFunction& function, const Lighting& lighting);

/// Adds to errors what of functions is not seen: of a product at most the product of both roots, of a squared distance
/// the square of their sum.
/// \param roots of finite_unseen_square(), by function
/// \param weight of the channel
void add_unseen(const Eigen::VectorXd& roots, double weight, ChannelProducts& products);

/// s/(N.L N.V)^p with p from 0.7 to 0.94 and widths from 0.001 to 1 lack what is below 6e-9 or less.
inline constexpr double kUnseenCosine = 3e-8;

}  // namespace lobe
