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
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// Allocates on cache lines, so that devices that share the host's memory use it in place, and leaves numbers
/// uninitialised: a table may have gigabytes that are written next anyway.
template <typename T>
struct TableAllocator {
  using value_type = T;                               ///< what is allocated
  static constexpr std::align_val_t kAlignment{128};  ///< bytes

  TableAllocator() = default;
  template <typename U>
  /// Of another type: all allocators are the same.
  explicit TableAllocator(const TableAllocator<U>&) {}
  /// Memory for `count` values, uninitialised.
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kAlignment)); }
  /// Gives memory back.
  void deallocate(T* pointer, std::size_t) { ::operator delete(pointer, kAlignment); }
  template <typename U>
  /// Leaves a value as its type's default initialisation has it.
  void construct(U* pointer) {
    ::new (static_cast<void*>(pointer)) U;
  }
  template <typename U, typename... Arguments>
  /// Makes a value from arguments.
  void construct(U* pointer, Arguments&&... arguments) {
    ::new (static_cast<void*>(pointer)) U(std::forward<Arguments>(arguments)...);
  }
  /// All are equal: any may give back what another has allocated.
  friend bool operator==(const TableAllocator&, const TableAllocator&) { return true; }
};
/// Values of a table.
using TableValues = std::vector<double, TableAllocator<double>>;

/// Which values a table has.
enum class TableForm {
  isotropic,  ///< f[theta_in, theta_out, delta_phi] on a product grid, delta_phi = 0 .. pi
  general     ///< f[in, out] for every pair of nodes
};

/// Albedos of one factor of a composition, channels x rings (isotropic) or nodes (general): what the bounds (1.23) and
/// (1.25) need.
struct FactorAlbedo {
  std::string expression;   ///< of the factor, as BrdfTable has it
  std::vector<double> in;   ///< integral over V
  std::vector<double> out;  ///< integral over L
};

/// A reflectance as an operator on a discretised hemisphere: T = T_smooth + diag(mirror) R + diag(retro) I, with R the
/// ideal mirror (1.29) and I the retro-reflecting ideal mirror RRIM (1.26). L indexes rows, V columns.
///
/// "Rows" below are rings for isotropic tables and nodes for general ones.
struct BrdfTable {
  HemisphereGrid grid = HemisphereGrid::gauss(1, 2);  ///< discretised directions
  TableForm form = TableForm::isotropic;              ///< which values there are
  std::size_t channels = 1;                           ///< number of channels

  /// Smooth part, sr^-1, row-major:
  /// isotropic [channel][theta_in][theta_out][k], delta_phi = 2 pi k / n_phi, k = 0 .. n_phi/2;
  /// general [channel][node_in][node_out].
  TableValues values;
  /// Factors of the ideal mirror and of the RRIM by row of L, channels x rows; empty: none.
  std::vector<double> mirror;
  std::vector<double> retro;  ///< of the retro-reflecting one
  /// Bound on the error of the values, sr^-1, [channel][ring_in][ring_out], over all azimuths; NaN where unknown. For
  /// a composition it contains the error of its quadrature.
  std::vector<double> error;
  /// Of an isotropic table of a reflectance that tells delta_phi from -delta_phi the values are the mean of both, and
  /// `error` contains half their difference. Sums over azimuth have nothing of that. So where they are known the two
  /// are also kept apart, as root mean squares over azimuth, sr^-1, [channel][ring_in][ring_out]; else both are empty.
  std::vector<double> even_error;
  std::vector<double> odd_part;  ///< half the difference of both signs of delta_phi

  /// How the table came about, for people: "compose(phong:n=20, ward:m=0.2)".
  std::string expression;
  /// Names of the channels: "red", "532 nm"; empty: they have none but their numbers.
  std::vector<std::string> channel_names;
  /// Of measurements, format of the file and its conventions (units, directions, colour scale); else empty.
  std::string conventions;
  /// The formulas of the smooth part where it is known to be a product of such, f_1 o f_2 o ..., each without delta
  /// parts; empty: not known. A tabulated material has one. They let the error of compositions be measured.
  std::vector<Material> source;
  /// How well the grid resolves the smooth part: relative error of integral(f(L, V)^2 dmu(V)), mean over L. NaN:
  /// unknown.
  double resolution_error = 0;
  /// Made with --allow-unresolved although the grid does not resolve it.
  bool is_unresolved = false;
  /// Of a composition of reflectances without negative values: first and second factor; else empty.
  std::vector<FactorAlbedo> factors;

  /// Rows of a matrix: rings or nodes.
  [[nodiscard]] std::size_t rows() const { return form == TableForm::isotropic ? grid.rings().size() : grid.nodes(); }
  /// Values per channel.
  [[nodiscard]] std::size_t size() const {
    return form == TableForm::isotropic ? rows() * rows() * grid.half_azimuths() : rows() * rows();
  }
  /// Values of a channel.
  [[nodiscard]] std::span<const double> channel(std::size_t c) const { return {values.data() + c * size(), size()}; }
  /// Values of a channel, to be written.
  [[nodiscard]] std::span<double> channel(std::size_t c) { return {values.data() + c * size(), size()}; }
  /// Whether there is a mirror or a retro-reflecting part.
  [[nodiscard]] bool has_delta() const { return !mirror.empty() || !retro.empty(); }
};

/// How a table is made.
struct TabulateOptions {
  Precision precision = Precision::double_precision;  ///< of the models
  /// The resolution_error that still counts as resolved.
  double tolerance = 0.1;
  /// Keep a table whose grid does not resolve a lobe, marked as such, instead of throwing.
  bool allow_unresolved = false;
  /// What anisotropic materials, and grids other than product grids, give is always general.
  TableForm form = TableForm::isotropic;
  /// On grids of cells: at how many points per coordinate of each cell the average begins; it is refined from there.
  std::size_t samples = 4;
  bool exact_grid = false;         ///< refuse tables on other grids instead of interpolating them
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// The same operator with a value for every pair of nodes. An isotropic table on a product grid becomes the dense 4D
/// one; a general table is returned as it is.
[[nodiscard]] BrdfTable to_general(const BrdfTable& table);

/// Albedos by row: in(L) = integral over V, out(V) = integral over L of the whole operator, delta parts included
/// (1.22). The errors contain those of the values and of the grid's quadrature, judged by an embedded rule of every
/// second ring and azimuth (averages over cells sum up exactly).
struct TableAlbedo {
  std::vector<std::vector<Estimate>> in;   ///< [channel][row]
  std::vector<std::vector<Estimate>> out;  ///< [channel][row]
  std::vector<Estimate> mean;              ///< [channel], (1.24)
};
/// Albedos of all rows.
/// \throws ArgumentError where the table is inconsistent.
[[nodiscard]] TableAlbedo row_albedos(const BrdfTable& table);

/// Root mean square of the error bounds over that of the values, both weighted by dmu dmu, of the worst channel; NaN
/// where errors are unknown, 0 without smooth part.
[[nodiscard]] double relative_error(const BrdfTable& table);

/// Checks a table built by hand or by a file.
/// \throws ArgumentError when sizes of its parts do not fit each other.
void check(const BrdfTable& table);

}  // namespace lobe
