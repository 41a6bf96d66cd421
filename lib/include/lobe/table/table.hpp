#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/memory_bound.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Allocator on cache lines, so that devices that share the host's memory can use tables in place. It leaves numbers
/// uninitialised: a table may have gigabytes that are written next anyway. While a MemoryBound lives, large tables lie
/// in files.
template <typename T>
struct TableAllocator {
  using value_type = T;  ///< type of the elements

  TableAllocator() = default;
  template <typename U>
  /// Converts from an allocator of another type; all allocators are the same.
  explicit TableAllocator(const TableAllocator<U>&) {}
  /// Allocates memory for `count` values, uninitialised.
  T* allocate(std::size_t count) { return static_cast<T*>(allocate_table_memory(count * sizeof(T))); }
  /// Releases memory.
  void deallocate(T* pointer, std::size_t count) { release_table_memory(pointer, count * sizeof(T)); }
  template <typename U>
  /// Default-initialises a value, which leaves numbers as they are.
  void construct(U* pointer) {
    ::new (static_cast<void*>(pointer)) U;
  }
  template <typename U, typename... Arguments>
  /// Constructs a value from arguments.
  void construct(U* pointer, Arguments&&... arguments) {
    ::new (static_cast<void*>(pointer)) U(std::forward<Arguments>(arguments)...);
  }
  /// Whether allocators are interchangeable: they always are.
  friend bool operator==(const TableAllocator&, const TableAllocator&) { return true; }
};
/// Storage for the values of a table.
using TableValues = std::vector<double, TableAllocator<double>>;

/// Forms of a table, by the values it has.
enum class TableForm {
  isotropic,  ///< f[theta_in, theta_out, delta_phi] on a product grid, delta_phi = 0 .. pi
  general     ///< f[in, out] for every pair of nodes
};

/// Albedos of one factor in a composition, channels x rings (isotropic) or nodes (general), as the bounds (1.23) and
/// (1.25) need them.
struct FactorAlbedo {
  std::string expression;   ///< expression of the factor, as in BrdfTable
  std::vector<double> in;   ///< integral over V
  std::vector<double> out;  ///< integral over L
};

/// A reflectance as an operator on a discretised hemisphere: T = T_smooth + diag(mirror) R + diag(retro) I, with the
/// ideal mirror R (1.29) and the retro-reflecting ideal mirror RRIM I (1.26). Rows are indexed by L, columns by V.
///
/// Below, "rows" are rings for isotropic tables and nodes for general ones.
struct BrdfTable {
  HemisphereGrid grid = HemisphereGrid::gauss(1, 2);  ///< discretised directions
  TableForm form = TableForm::isotropic;              ///< form of the values
  std::size_t channels = 1;                           ///< number of channels

  /// Smooth part, sr^-1, row-major:
  /// isotropic [channel][theta_in][theta_out][k], delta_phi = 2 pi k / n_phi, k = 0 .. n_phi/2;
  /// general [channel][node_in][node_out].
  TableValues values;
  /// Factors of the ideal mirror by row of L, channels x rows; empty if there is none.
  std::vector<double> mirror;
  std::vector<double> retro;  ///< factors of the retro-reflecting mirror, in the same layout
  /// Bound on the error of the values over all azimuths, sr^-1, [channel][ring_in][ring_out]; NaN where unknown. For a
  /// composition it contains the error of its quadrature.
  std::vector<double> error;
  /// Root mean square over azimuth of the error of the even part, sr^-1, [channel][ring_in][ring_out]; empty if
  /// unknown. If a reflectance distinguishes delta_phi from -delta_phi, its isotropic table holds the mean of both, and
  /// `error` contains half of their difference. Sums over azimuth contain nothing of that difference, so the two parts
  /// are also kept separately.
  std::vector<double> even_error;
  std::vector<double> odd_part;  ///< root mean square over azimuth of half the difference between both signs

  /// Origin of the table, for people: "compose(phong:n=20, ward:m=0.2)".
  std::string expression;
  /// Names of the channels: "red", "532 nm"; empty if they have only numbers.
  std::vector<std::string> channel_names;
  /// Format of a measured file and its conventions (units, directions, colour scale); empty otherwise.
  std::string conventions;
  /// Formulas whose product f_1 o f_2 o ... the smooth part is, each without delta parts; empty if unknown. A tabulated
  /// material has one. They make it possible to measure the error of compositions.
  std::vector<Material> source;
  /// Resolution of the smooth part by the grid: relative error of integral(f(L, V)^2 dmu(V)), mean over L; NaN if
  /// unknown.
  double resolution_error = 0;
  /// Whether the table was made with --allow-unresolved although the grid does not resolve it.
  bool is_unresolved = false;
  /// First and second factor of a composition, if neither has negative values; empty otherwise.
  std::vector<FactorAlbedo> factors;

  /// Number of rows of a matrix: rings or nodes.
  [[nodiscard]] std::size_t rows() const { return form == TableForm::isotropic ? grid.rings().size() : grid.nodes(); }
  /// Number of values per channel.
  [[nodiscard]] std::size_t size() const {
    return form == TableForm::isotropic ? rows() * rows() * grid.half_azimuths() : rows() * rows();
  }
  /// Values of a channel, read-only.
  [[nodiscard]] std::span<const double> channel(std::size_t c) const { return {values.data() + c * size(), size()}; }
  /// Values of a channel, for writing.
  [[nodiscard]] std::span<double> channel(std::size_t c) { return {values.data() + c * size(), size()}; }
  /// Whether there is a mirror or a retro-reflecting part.
  [[nodiscard]] bool has_delta() const { return !mirror.empty() || !retro.empty(); }
};

/// Options for making a table.
struct TabulateOptions {
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  /// Largest resolution_error that counts as resolved.
  double tolerance = 0.1;
  /// Whether to keep a table whose grid does not resolve a lobe, marked as such, instead of throwing.
  bool allow_unresolved = false;
  /// Form of the table. It is always general for anisotropic materials, and on grids other than product grids.
  TableForm form = TableForm::isotropic;
  /// Points per coordinate of each cell from which averages over cells start; they are refined from there.
  std::size_t cell_points = 4;
  bool exact_grid = false;         ///< refuse tables on other grids instead of interpolating them
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Expands a table to a value for every pair of nodes. An isotropic table on a product grid becomes the dense 4D one; a
/// general table is returned unchanged.
[[nodiscard]] BrdfTable to_general(const BrdfTable& table);

/// Albedos by row of the whole operator, delta parts included (1.22): in(L) = integral over V, out(V) = integral over
/// L. The errors contain the errors of the values and of the grid's quadrature, estimated by an embedded rule that
/// takes every second ring and azimuth (averages over cells sum up exactly).
struct TableAlbedo {
  std::vector<std::vector<Estimate>> in;   ///< [channel][row]
  std::vector<std::vector<Estimate>> out;  ///< [channel][row]
  std::vector<Estimate> mean;              ///< [channel], (1.24)
};
/// Computes the albedos of all rows.
/// \throws ArgumentError if the table is inconsistent
[[nodiscard]] TableAlbedo row_albedos(const BrdfTable& table);

/// Relative error of a table: root mean square of the error bounds over that of the values, both weighted by dmu dmu,
/// in the worst channel; NaN where errors are unknown, 0 without a smooth part.
/// \throws ArgumentError if the table is inconsistent
[[nodiscard]] double relative_error(const BrdfTable& table);

/// Checks a table built by hand or read from a file.
/// \throws ArgumentError if the sizes of its parts do not fit each other
void check(const BrdfTable& table);

}  // namespace lobe
