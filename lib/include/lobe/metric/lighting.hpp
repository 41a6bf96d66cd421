#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace [[gnu::visibility("default")]] lobe {

class Device;
class HemisphereGrid;
class Reflectance;
struct BrdfTable;

/// A share in a mixture of patch lights.
struct PatchShare {
  double radius = 0;  ///< radius R of the patch light in the base plane, in (0, 2]
  double weight = 0;  ///< >= 0
};

/// A point in a density w(R) of patch lights, which is linear between points.
struct DensityPoint {
  double radius = 0;  ///< in [0, 2]
  double value = 0;   ///< >= 0
};

/// The lighting W in the scalar product f1 . f2 = integral of C_{f1,f2} W dmu dmu = tr(T1 T2 W*) (Neumann 2001, eq.
/// 5.23). An immutable value.
class Lighting {
 public:
  /// Kinds of lightings.
  enum class Kind {
    point,        ///< W = identity: integral of f1 f2 dmu dmu; a norm
    daylight,     ///< W = 1: integral of a1 a2 dmu (section 5.3.2); a semi-norm
    mean_albedo,  ///< pi^2 A1 A2 = integral of f1 times that of f2; a semi-norm, of no W
    patches,      ///< W = sum or integral of w(R) C_{eta_R}, eta_R the basic BRDF of radius R (4.2)
    table,        ///< W as tabulated, symmetrised (5.26)
    material      ///< W = C_eta of any reflectance eta: the point product of C_{eta,f} and C_{eta,g}
  };

  /// Makes light from single directions: f1 . f2 = integral of f1 f2 dmu dmu, a norm.
  [[nodiscard]] static Lighting point() { return Lighting(Kind::point); }
  /// Makes homogeneous light, W = 1: only albedos count.
  [[nodiscard]] static Lighting daylight() { return Lighting(Kind::daylight); }
  /// Makes the lighting under which only mean albedos count.
  [[nodiscard]] static Lighting mean_albedo() { return Lighting(Kind::mean_albedo); }
  /// Makes light from a disc of radius R in the base plane, eta_R = 1/(pi min(1, R^2)) where |L_P + V_P| <= R (4.2). R
  /// -> 0 gives `point`, R = 2 `daylight` / pi.
  /// \throws ArgumentError unless R is in (0, 2] (as all of these functions)
  [[nodiscard]] static Lighting patch(double radius);
  /// Makes a mixture of patch lights, W = sum of weight C_{eta_radius}.
  /// \throws ArgumentError for no shares, a negative weight, or no positive weight
  [[nodiscard]] static Lighting mixture(std::vector<PatchShare> shares);
  /// Makes a density of patch lights, W = integral of w(R) C_{eta_R} dR, with w linear between points of rising radius
  /// and zero outside.
  /// \throws ArgumentError for fewer than two points, radii that do not rise, and values that are negative or all zero
  [[nodiscard]] static Lighting density(std::vector<DensityPoint> points);
  /// Makes light from a table.
  /// \param name name of the file, for people
  /// \throws ArgumentError if W has several channels or is inconsistent
  [[nodiscard]] static Lighting table(BrdfTable table, std::string name);
  /// Makes light of the pattern of a reflectance eta: eta(L, X) is how much of the light about L arrives from X. f . g
  /// is the point product of C_{eta,f} and C_{eta,g}, so W = C_eta for reciprocal eta, and no square is negative. RRIM
  /// gives `point`, diffuse `daylight` / pi. A delta part of eta is the point light that it is: a mirror turns f.
  /// \param name name of eta; empty: its specification, or its own name where it has none
  /// \throws ArgumentError if eta has several channels
  [[nodiscard]] static Lighting material(Reflectance eta, std::string name = {});
  /// Makes a lighting known by name alone, as results record one that parse_lighting() cannot make. Of kind `table`,
  /// without its table.
  [[nodiscard]] static Lighting recorded(std::string name, std::string definition);

  /// Kind of the lighting.
  [[nodiscard]] Kind kind() const { return kind_; }
  /// Name of the lighting: "point", "daylight", "mean-albedo", "patch:0.5", "mixture:0.25=0.3,1=0.7",
  /// "density:0=1,2=0", "table:NAME" or "material:phong:n=20".
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Name as part of file names: "patch-0.5".
  [[nodiscard]] std::string stem() const;
  /// Definition of f.g, one line.
  [[nodiscard]] std::string definition() const;
  /// Power of sr in products: 0, 1 (daylight) or 2 (mean albedo); norms and distances have half of that power.
  [[nodiscard]] int product_power() const;

  /// Shares of the kind `patches`; a density becomes a Gauss rule with `nodes` nodes between its points.
  [[nodiscard]] std::vector<PatchShare> shares(int nodes) const;
  /// Radii of the kind `patches` at which the density is not smooth, and those of the shares.
  [[nodiscard]] std::vector<double> radii() const;
  /// Whether W is a table that is there.
  [[nodiscard]] bool has_table() const { return table_ != nullptr; }
  /// Table of the kind `table`.
  /// \throws ArgumentError for a lighting known by name alone
  [[nodiscard]] const BrdfTable& table() const;
  /// Reflectance eta of the kind `material`.
  /// \throws ArgumentError for a lighting known by name alone
  [[nodiscard]] const Reflectance& material() const;
  /// Whether parse_lighting() makes this lighting from its name: no table, and no material that is a file.
  [[nodiscard]] bool is_told_by_name() const { return is_told_by_name_; }

  /// Whether two lightings are equal; what their names do not tell must be the same object.
  friend bool operator==(const Lighting& a, const Lighting& b) {
    return a.name_ == b.name_ && a.table_ == b.table_ && a.is_told_by_name_ == b.is_told_by_name_ &&
           (a.is_told_by_name_ || a.material_ == b.material_);
  }

 private:
  explicit Lighting(Kind kind);

  Kind kind_;
  std::string name_;
  std::vector<PatchShare> shares_;
  std::vector<DensityPoint> density_;
  std::shared_ptr<const BrdfTable> table_;
  std::shared_ptr<const Reflectance> material_;
  bool is_told_by_name_ = true;
  std::string definition_;  ///< definition that results record
};

/// Reads a name as Lighting::name() gives it, except the name of a table or of a material that is a file.
/// \throws ArgumentError for anything else, with the nearest known word
[[nodiscard]] Lighting parse_lighting(std::string_view name);

/// Tabulates the lighting W as an operator on a grid, sr^-1. `point` is the identity (a RRIM part) and `daylight` is 1.
/// Patch lights have values at the nodes (isotropic; on the diagonal such that rows sum up to the albedo of W). A table
/// is brought to the grid and symmetrised (5.26); of a material it is the product of the tables of eta* and eta.
/// \throws ArgumentError for `mean-albedo`, which is not an integral with a W, and for patch lights on grids without
///   equal azimuths per ring; DeviceError
[[nodiscard]] BrdfTable lighting_table(const Device& device, const Lighting& lighting, const HemisphereGrid& grid);

}  // namespace lobe
