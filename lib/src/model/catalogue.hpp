#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "device/known_values.hpp"
#include "hemisphere/kink.hpp"
#include "hemisphere/patch_edge.hpp"
#include "lobe/model/model.hpp"
#include "model/draw.hpp"

namespace lobe {

/// Constants of a material that a model's kernel gets, computed once on the host from the parameters
/// (kernels/models/*.clh say what each means).
using Coefficients = std::array<double, kCoefficients>;

/// Shape of a lobe, as the rules of quadrature need it.
struct LobeShape {
  /// Angle of the half-vector (radians) over which the reflectance falls by about 1/e near its peak: where quadrature
  /// starts. A hint: too large a value costs refinement, which the error estimates then ask for.
  double width = 1;
  /// Like width, about the retro direction (half the angle between L and V) of a retro-reflecting lobe; 1 where there
  /// is none.
  double retro_width = 1;
  /// Base-plane distance |V_P - L'_P| (4.1) at which the reflectance jumps or has a kink; 0 where it is smooth.
  double patch_radius = 0;
  /// The reflectance ends at patch_radius as a power that is not whole, which quadrature approaches slowly.
  bool has_fractional_edge = false;
  /// A second such distance, smaller than patch_radius; 0 where there is none.
  double inner_patch_radius = 0;
  /// Like patch_radius, from the retro direction, |V_P - L_P| (4.29).
  double retro_patch_radius = 0;
  /// How many times longer than wide the lobe of an anisotropic model is, which `width` says the width of.
  double aspect = 1;
  /// The edge of an anisotropic model, or the norm of the base plane that it depends on where that has kinks, about the
  /// mirror direction.
  std::optional<PatchEdge> patch_edge = std::nullopt;
  /// Edge about the retro direction, for models that are smooth elsewhere.
  std::optional<PatchEdge> retro_patch_edge = std::nullopt;
  /// False where the azimuth of V_P - L'_P is all that an anisotropic lobe sees of azimuths.
  bool both_sides = true;
  /// Azimuth, in radians, of a vertical plane whose mirror image of an anisotropic lobe is the lobe itself, like that
  /// of the vertical plane across; none where there are no two such planes.
  std::optional<double> mirror_plane = std::nullopt;
  /// Half a turn about the normal leaves an anisotropic lobe the same.
  bool half_turn = true;
  /// The reflectance, as a rule with its albedo, grows as 1/(N.L) at grazing angles, so that norms are infinite.
  bool has_infinite_norm = false;
  /// Where else the reflectance or its derivatives up to the third jump, but on N.L = N.V, L.V = N.L N.V and, with
  /// retro_width, on L.V = 0: on these all rules of quadrature have limits. tests/property/kinks_test.cpp finds what is
  /// missing.
  std::vector<Kink> kinks = {};
  /// The same, where others have them, too.
  CommonKinks common = {};
};

/// Known values of a kernel, for the test of the device before its first use.
struct KnownValues {
  std::string_view material;            ///< specification of the model and its parameters
  std::array<double, 10> coefficients;  ///< c0 to c9, sr^-1 and as the kernel's file says
  std::array<double, 4> values;         ///< at kKnownPairs, sr^-1
};

/// A model and how it is computed: lib/src/model/catalogue/<model>.cpp.
struct CatalogueEntry {
  Model model;
  /// Function of kernels/models/<kernel>.clh, <model>_anisotropic where it sees azimuths; empty for delta parts.
  std::string_view kernel = {};
  /// A value per parameter, for examples and pages.
  std::vector<double> typical = {};
  /// \param v one per parameter
  Coefficients (*coefficients)(Values v) = [](Values) { return Coefficients{}; };
  /// \param v one per parameter
  LobeShape (*shape)(Values v) = [](Values) { return LobeShape{}; };
  /// Distribution that directions are drawn from; null: draw::general() for the shape.
  draw::Parts (*proposal)(Values v, const draw::Scene& scene) = nullptr;
  /// One entry of each kernel has them. tests/kernel/model_kernel_test.cpp holds them against the reference.
  std::optional<KnownValues> known = std::nullopt;
};

[[nodiscard]] std::span<const CatalogueEntry> catalogue_entries();

/// \throws ArgumentError for an unknown name, with the nearest known one.
[[nodiscard]] const CatalogueEntry& find_entry(std::string_view name);

}  // namespace lobe
