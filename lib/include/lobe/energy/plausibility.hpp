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

namespace [[gnu::visibility("default")]] lobe {

/// Options for checks of plausibility. A reflectance is plausible if it has no value below 0, f(L, V) = f(V, L), and no
/// albedo above 1 (Neumann 2001, eq. 1.10 and 1.14). The check searches values and albedos; it proves nothing. A
/// violation that it reports exists, but it may miss one that is narrower than the search.
struct PlausibilityOptions {
  double tolerance = 1e-5;                            ///< relative tolerance of albedos
  Precision precision = Precision::double_precision;  ///< arithmetic of albedos; values are always computed in double
  std::size_t pairs = 8192;                           ///< pairs of directions examined before the search narrows
  std::size_t angles = 46;                            ///< angles of incidence over the quarter circle
  /// For anisotropic materials over half a turn; for functions, and materials that half a turn about the normal
  /// changes, twice as many over a turn.
  std::size_t azimuths = 6;
  /// Quadrature nodes after which an albedo is no longer refined, at least 1; three times as many where sums cancel.
  std::size_t most_nodes = 1'000'000;
  bool with_mean_albedo = true;  ///< whether to compute the mean albedo (white furnace), too
};

/// The difference between f(L, V) and f(V, L).
struct ReciprocityDefect {
  double absolute = 0;     ///< the largest difference, sr^-1
  Directions absolute_at;  ///< its place
  /// The largest difference relative to the larger of both values, or to a thousandth of their mean size if that is
  /// larger. For tables, the root mean square of the differences over that of the values, both weighted by dmu dmu.
  double relative = 0;
  Directions relative_at;  ///< its place; for tables the same as absolute_at
};

/// The least upper bound of the albedo, as far as the search found it.
struct AlbedoBound {
  /// The largest albedo found. Its error includes that of the search, and by how much less certain albedos may be
  /// larger.
  Estimate largest;
  Direction at;  ///< its place, radians
  /// Exponent p, with its error, if the albedo grows as (N.L)^-p towards grazing incidence. The largest albedo found
  /// then means nothing.
  std::optional<Estimate> growth;
};

/// Plausibility of one channel.
struct ChannelPlausibility {
  PlacedValue least;  ///< the smallest value found; its error is rounding, for tables the error of the value
  ReciprocityDefect reciprocity;        ///< the difference between f(L, V) and f(V, L)
  AlbedoBound albedo;                   ///< the largest albedo
  std::optional<Estimate> mean_albedo;  ///< the result of a white furnace; none if not requested or not computable

  bool is_non_negative = true;  ///< whether no value is below 0 by more than its error
  bool is_reciprocal = true;    ///< whether the defect is within rounding, for tables within their errors
  /// Whether no albedo is above 1 by more than its own error, that of the search, and the 2e-6 by which the curves of
  /// adjusted formulas may be off; and none grows without bound.
  bool conserves_energy = true;
  /// Whether none of these three is violated.
  [[nodiscard]] bool is_plausible() const { return is_non_negative && is_reciprocal && conserves_energy; }
};

/// An edge that a model declares: at a distance in the base plane (4.1) from the mirror direction or from the retro
/// direction.
struct SmoothnessBreak {
  bool is_about_retro = false;  ///< whether it lies about the retro direction rather than the mirror direction
  double radius = 0;            ///< its distance; across the edge if that is anisotropic
  std::vector<double> jump;     ///< height by channel, sr^-1, where L and V are symmetrical about N; 0 for a kink
  bool is_anisotropic = false;  ///< whether the edge differs between azimuths
};

/// Results of a check.
struct Plausibility {
  std::vector<ChannelPlausibility> channels;  ///< one per channel
  std::vector<SmoothnessBreak> breaks;        ///< edges of the model; unknown for tables
  std::size_t pairs = 0;                      ///< pairs of directions examined
  std::size_t incident = 0;                   ///< directions of incidence whose albedos were computed
  std::size_t unresolved = 0;  ///< directions of these where the quadrature missed the tolerance and errors are larger
  double least_elevation = 0;  ///< elevation of the most grazing direction above the horizon, radians; tables: 0
  std::uint64_t nodes = 0;     ///< quadrature nodes for these albedos
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< for tables and functions: the grid that was examined
  /// Whether all channels are plausible.
  [[nodiscard]] bool is_plausible() const;
};

/// Checks a reflectance, delta parts included.
///
/// Formulas. Values are checked at `pairs` pairs of directions, in equal shares anywhere, about the mirror direction,
/// about the retro direction and at grazing angles (with distances spread logarithmically from 1e-6 to 1), then around
/// the eight worst in boxes that shrink from 0.3 to 1e-5 rad. Albedos are checked at `angles` angles, then at
/// elevations that fall by half powers of 10 down to 1e-7, or for lobes of width w (radians) to w^2/100, at least
/// 1e-12; then around the largest one. The growth is the exponent between the last two powers of 10, if it is above its
/// error, which is the difference from the exponent before.
///
/// Tables. Values, differences across the diagonal, and albedos of the rows are checked with their errors; unknown
/// errors (NaN) count as 0.
///
/// Functions. Values and differences are those of the table on their natural_grid(). Albedos are integrated as by
/// albedo() at `angles` angles up to 89.99 degrees, of anisotropic functions at 2 `azimuths`, and then between the best
/// direction and those beside it. The error of the largest one contains by how much it may be larger between the last
/// of these, if it bends down there.
/// \throws ArgumentError for options out of range and inconsistent tables; NumericError for albedos that are not
///   finite; as adjusted(); DeviceError
[[nodiscard]] Plausibility check_plausibility(const Device& device, const Reflectance& reflectance,
                                              const PlausibilityOptions& options = {});

/// The worst results for a model over the ranges of its parameters, at scale 1.
struct ModelPlausibility {
  /// A material and its result.
  struct Worst {
    Material material;          ///< the material
    ChannelPlausibility found;  ///< its result
  };
  std::string_view model;        ///< name in the catalogue
  std::size_t materials = 0;     ///< number of materials checked
  std::size_t overflowing = 0;   ///< number of materials left out because their albedos are not finite
  Worst least;                   ///< material with the smallest value
  Worst reciprocity;             ///< material with the largest relative defect
  Worst albedo;                  ///< material with the steepest growth or, without growth, the largest albedo
  bool is_non_negative = true;   ///< whether this holds for all materials checked
  bool is_reciprocal = true;     ///< whether this holds for all materials checked
  bool conserves_energy = true;  ///< whether this holds for all materials checked
};

/// Options for checks of models, with the values used for docs/plausibility.md.
struct CatalogueOptions {
  PlausibilityOptions material{
      ///< how each material is looked at
      .tolerance = 1e-3, .pairs = 1024, .angles = 13, .azimuths = 3, .most_nodes = 100'000, .with_mean_albedo = false};
  std::size_t random = 4;  ///< materials at random places in the ranges, beside those at the ends
  /// Quadrature nodes after which no further material of a model is begun.
  std::uint64_t nodes = std::numeric_limits<std::uint64_t>::max();
  bool is_pursued = true;  ///< whether to follow an albedo above 1 to where it is larger
};

/// Makes materials over the ranges of a model's parameters: all at their defaults, or a little above their middles;
/// each parameter at either end with the others unchanged; all at either end; and `random` ones in between, the same in
/// every run. Places in ranges over several powers of 10 are spaced logarithmically; infinite ranges end at 1e6.
/// Anisotropic lobes more than 20 times longer than wide are left out.
[[nodiscard]] std::vector<Material> checked_materials(std::string_view model, std::size_t random);

/// Checks a model at checked_materials().
/// \throws ArgumentError for an unknown model; as check_plausibility()
[[nodiscard]] ModelPlausibility check_model(const Device& device, std::string_view model,
                                            const CatalogueOptions& options = {});

/// Checks all models.
/// \throws as check_plausibility(); Cancelled
[[nodiscard]] std::vector<ModelPlausibility> check_catalogue(const Device& device, const CatalogueOptions& options = {},
                                                             const ProgressCallback& progress = {});

/// Whether the results for a model agree with its declared traits: promised traits hold, and a violation was seen of
/// each trait that is not promised.
[[nodiscard]] bool agrees_with_traits(const ModelPlausibility& model);

}  // namespace lobe
