#pragma once

/// Products over directions up to a largest angle, in the angles of light and view.

#include "reference/quadrature.hpp"

namespace lobe::reference {

/// Integral of f g dmu dmu over theta_L, theta_V <= theta_max: Gauss rules of an order on panels that grow away from
/// the mirror direction and from the limits.
[[nodiscard]] double point_product_up_to(double theta_max, const Lobe& f, const Lobe& g, int order);

/// Integral of a_f a_g dmu, albedos and integral over the same angles.
[[nodiscard]] double daylight_product_up_to(double theta_max, const Lobe& f, const Lobe& g, int order);

/// (Integral of f dmu dmu) (integral of g dmu dmu).
[[nodiscard]] double mean_albedo_product_up_to(double theta_max, const Lobe& f, const Lobe& g, int order);

/// The point norm squared of the basic patch of a radius: 1/(pi R^2) where |L_P + V_P| <= R <= 1, within a disc of
/// radius sin(theta_max), by the areas of lenses.
[[nodiscard]] double patch_square_up_to(double theta_max, double radius);

}  // namespace lobe::reference
