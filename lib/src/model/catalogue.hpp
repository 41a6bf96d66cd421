#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "device/sampler.hpp"
#include "hemisphere/kink.hpp"
#include "hemisphere/patch_edge.hpp"
#include "lobe/model/model.hpp"

namespace lobe {

/// What a model's kernel gets per material, computed once on the host from the parameters (kernels/models/*.clh tell
/// what each means).
using Coefficients = std::array<double, kCoefficients>;

/// A model and how the device computes it.
struct CatalogueEntry {
  Model model;
  /// Function of kernels/models/<kernel>.clh, <model>_anisotropic where it sees azimuths; empty for delta parts.
  std::string_view kernel;
  /// \param values one per parameter
  Coefficients (*coefficients)(std::span<const double> values);
  /// Angle of the half-vector (radians) over which the reflectance falls by about 1/e near its peak: where quadrature
  /// starts. A hint: too large a value costs refinement, which the error estimates then ask for.
  double (*width)(std::span<const double> values);
  /// Base-plane distance |V_P - L'_P| (4.1) at which the reflectance jumps or has a kink; null where it is smooth.
  double (*patch_radius)(std::span<const double> values) = nullptr;
  /// Like width, about the retro direction (half the angle between L and V) of a retro-reflecting lobe; null where
  /// there is none.
  double (*retro_width)(std::span<const double> values) = nullptr;
  /// The reflectance, as a rule with its albedo, grows as 1/(N.L) at grazing angles, so that norms are infinite; null
  /// where it never does.
  bool (*has_infinite_norm)(std::span<const double> values) = nullptr;
  /// Like patch_radius, from the retro direction, |V_P - L_P| (4.29).
  double (*retro_patch_radius)(std::span<const double> values) = nullptr;
  /// A second base-plane distance at which there is a kink, smaller than patch_radius; null or 0 where there is none.
  double (*inner_patch_radius)(std::span<const double> values) = nullptr;
  /// How many times longer than wide the lobe of an anisotropic model is, which `width` says the width of; null: 1.
  double (*aspect)(std::span<const double> values) = nullptr;
  /// The edge of an anisotropic model, or the norm of the base plane that it depends on where that has kinks, about the
  /// mirror direction; null where the azimuth of V_P - L'_P is not all that a lobe sees of azimuths.
  std::optional<PatchEdge> (*patch_edge)(std::span<const double> values) = nullptr;
  /// The same about the retro direction, of models that are smooth elsewhere.
  std::optional<PatchEdge> (*retro_patch_edge)(std::span<const double> values) = nullptr;
  /// Half a turn about the normal leaves an anisotropic lobe the same; null: it always does.
  bool (*half_turn)(std::span<const double> values) = nullptr;
  /// Where else the reflectance or its derivatives up to the third jump, but on N.L = N.V, L.V = N.L N.V, R.V = 0,
  /// where G (2.10) becomes 1 and, with retro_width, on L.V = 0: on these all rules of quadrature have limits. Null
  /// where it is smooth. tests/property/kinks_test.cpp finds what is missing.
  std::vector<Kink> (*kinks)(std::span<const double> values) = nullptr;
};

[[nodiscard]] std::span<const CatalogueEntry> catalogue_entries();

/// \throws ArgumentError for an unknown name, with the nearest known one.
[[nodiscard]] const CatalogueEntry& find_entry(std::string_view name);

}  // namespace lobe
