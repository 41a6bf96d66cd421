#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/least_value.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// What a plausible reflectance is: no value below 0, f(L, V) = f(V, L), no albedo above 1 (Neumann 2001, eq. 1.10 and
/// 1.14). Values and albedos are looked for, nothing is proved: a violation that is reported is there, one that is
/// narrower than the search may be missed.
struct PlausibilityOptions {
  double tolerance = 1e-5;                            ///< of albedos, relative
  Precision precision = Precision::double_precision;  ///< of albedos; values are always taken in double
  std::size_t pairs = 8192;                           ///< pairs of directions looked at before the search narrows
  std::size_t angles = 46;                            ///< angles of incidence over the quarter circle
  std::size_t azimuths = 6;                           ///< of anisotropic materials, over half a turn
  int levels = 9;                                     ///< of refinement of albedos, at most; 2 to 9
  bool with_mean_albedo = true;                       ///< compute what a white furnace shows, too
};

/// By how much f(L, V) and f(V, L) differ.
struct ReciprocityDefect {
  double absolute = 0;     ///< the largest difference, sr^-1
  Directions absolute_at;  ///< where that is
  /// The largest difference over the larger of both values, or over a thousandth of their mean size if that is larger.
  /// Of tables the root mean square of the differences over that of the values, both weighted by dmu dmu.
  double relative = 0;
  Directions relative_at;  ///< of tables as absolute_at
};

/// The least upper bound of the albedo, as far as it was looked for.
struct AlbedoBound {
  Estimate largest;  ///< the largest one found; the error includes that of the search
  Direction at;      ///< radians
  /// The albedo grows as (N.L)^-p towards grazing incidence: p with its error. The largest one found then says nothing.
  std::optional<Estimate> growth;
};

/// A channel of a reflectance.
struct ChannelPlausibility {
  PlacedValue least;  ///< the smallest value found; its error is that of rounding, of tables that of the value
  ReciprocityDefect reciprocity;        ///< difference between f(L, V) and f(V, L)
  AlbedoBound albedo;                   ///< the largest one
  std::optional<Estimate> mean_albedo;  ///< what a white furnace shows; none: not wanted, or not to be computed

  bool is_non_negative = true;   ///< no value is below 0 by more than its error
  bool is_reciprocal = true;     ///< the defect is one of rounding, of tables of their errors
  bool conserves_energy = true;  ///< no albedo is above 1 by more than its error, and none grows without bound
  /// Whether none of the three is violated.
  [[nodiscard]] bool is_plausible() const { return is_non_negative && is_reciprocal && conserves_energy; }
};

/// Where a model says that its reflectance has an edge: at a distance in the base plane (4.1) from the mirror direction
/// or from the retro direction.
struct SmoothnessBreak {
  bool is_about_retro = false;  ///< of the retro direction, else of the mirror direction
  double radius = 0;            ///< of an anisotropic edge the distance across it
  std::vector<double> jump;     ///< by channel, sr^-1, where L and V are symmetrical about N; 0: a kink
  bool is_anisotropic = false;  ///< the edge is not the same at all azimuths
};

/// What was found of a reflectance.
struct Plausibility {
  std::vector<ChannelPlausibility> channels;  ///< one per channel
  std::vector<SmoothnessBreak> breaks;        ///< of tables none are known
  std::size_t pairs = 0;                      ///< of directions looked at
  std::size_t incident = 0;                   ///< directions of incidence whose albedos were computed
  std::size_t unresolved = 0;  ///< of these, where the quadrature did not reach the tolerance: errors are larger
  double least_elevation = 0;  ///< the most grazing of them, above the horizon, radians
  std::uint64_t nodes = 0;     ///< of the quadrature of these albedos
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< of tables and functions: what was looked at
  /// Whether all channels are plausible.
  [[nodiscard]] bool is_plausible() const;
};

/// Checks a reflectance, delta parts included.
///
/// Formulas. Values: at `pairs` pairs of directions, in equal parts anywhere, about the mirror direction, about the
/// retro direction and at grazing angles (distances spread by their logarithm from 1e-6 to 1), then around the eight
/// worst in boxes that shrink from 0.3 to 1e-5 rad. Albedos: at `angles` angles, then by half powers of 10 of the
/// elevation down to 1e-7, or for lobes of a width w (radians) to w^2/100, at least 1e-12; then around the largest,
/// whose error counts as at least a hundredth of the tolerance: levels of quadrature may agree by accident. Growth is
/// the exponent between the two last powers of 10 where it is above its error, the difference from the exponent before.
///
/// Tables: the values, the differences across the diagonal, and the albedos of the rows, each with their errors; where
/// errors are unknown (NaN) they count as none. Functions as the tables that they are on their natural_grid().
/// \throws ArgumentError for options out of range and inconsistent tables; NumericError for albedos that are no finite
///   numbers; as adjusted(); DeviceError.
[[nodiscard]] Plausibility check_plausibility(const Device& device, const Reflectance& reflectance,
                                              const PlausibilityOptions& options = {});

/// The worst that was seen of a model over the ranges of its parameters, at scale 1.
struct ModelPlausibility {
  /// A material and what was found of it.
  struct Worst {
    Material material;          ///< the material
    ChannelPlausibility found;  ///< what was found of it
  };
  std::string_view model;        ///< name in the catalogue
  std::size_t materials = 0;     ///< checked
  std::size_t overflowing = 0;   ///< materials left out, as their albedos are no finite numbers
  Worst least;                   ///< of the smallest value
  Worst reciprocity;             ///< of the largest relative defect
  Worst albedo;                  ///< of the steepest growth, without growth of the largest albedo
  bool is_non_negative = true;   ///< of all materials checked
  bool is_reciprocal = true;     ///< idem
  bool conserves_energy = true;  ///< idem
};

/// How closely models are looked at. As it is, for docs/plausibility.md.
struct CatalogueOptions {
  PlausibilityOptions material{
      ///< how each material is looked at
      .tolerance = 1e-3, .pairs = 1024, .angles = 13, .azimuths = 3, .levels = 4, .with_mean_albedo = false};
  std::size_t random = 4;  ///< materials at random places of the ranges, beside those at their ends
  /// Of quadrature: when a model has taken as many, no further material of it is begun.
  std::uint64_t nodes = std::numeric_limits<std::uint64_t>::max();
  bool is_pursued = true;  ///< from an albedo above 1 on to where it is larger
};

/// Materials over the ranges of a model's parameters: all at their defaults, or else a little above their middles; each
/// at either end beside the others as they were; all at either end; and `random` ones in between, the same in every
/// run. Ranges of several powers of 10 are taken by their logarithm, infinite ones end at 1e6. Anisotropic lobes more
/// than 20 times longer than wide are left out.
[[nodiscard]] std::vector<Material> parameter_samples(std::string_view model, std::size_t random);

/// Checks a model at parameter_samples().
/// \throws ArgumentError for an unknown model; as check_plausibility().
[[nodiscard]] ModelPlausibility check_model(const Device& device, std::string_view model,
                                            const CatalogueOptions& options = {});

/// Checks all models.
/// \throws as check_plausibility(); Cancelled.
[[nodiscard]] std::vector<ModelPlausibility> check_catalogue(const Device& device, const CatalogueOptions& options = {},
                                                             const ProgressCallback& progress = {});

/// Whether what was found of a model is what its traits declare: what they promise is kept, what they do not promise
/// is seen to be violated.
[[nodiscard]] bool agrees_with_traits(const ModelPlausibility& model);

}  // namespace lobe
