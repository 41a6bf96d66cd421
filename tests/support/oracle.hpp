#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace lobe::test {

/// A number computed apart from this library, to compare with: a table of one quantity of one material or pair.
struct OracleRecord {
  std::string name;                    ///< what is compared, with its parameters; unique
  std::string quantity;                ///< as in the file
  std::vector<std::string> materials;  ///< specifications for parse_material: one, or two of products and compositions
  std::vector<double> theta_deg;       ///< where the quantity is a function of the angle; of a composition: theta_in,
                                       ///< theta_out, delta_phi
  double light_radius = 0;             ///< R of the patch light of a scalar product under one
  std::vector<double> values;
  double uncertainty = 0;  ///< of the values, absolute; 0 where the file states none
  std::string printed;     ///< what a publication prints instead; empty where the file says nothing of it
};
std::ostream& operator<<(std::ostream& out, const OracleRecord& record);

/// All records of a quantity that the library's models cover. The file is LOBE_ORACLE where that names an existing
/// file, else tests/golden/oracle.json, a transcription of the part of it that is used here.
[[nodiscard]] std::vector<OracleRecord> oracle_records(const std::string& quantity);

/// A best approximation by a linear combination.
struct OracleFit {
  std::string name;      ///< "point", "daylight" or "patch:R", and whether non-negative
  std::string lighting;  ///< as parse_lighting() reads it
  bool non_negative = false;
  std::string target;                 ///< specification for parse_material
  std::vector<std::string> basis;     ///< specifications
  std::vector<double> coefficients;   ///< one per basis material
  std::vector<double> uncertainties;  ///< of the coefficients; empty where the file states none
  double residual = 0;                ///< its norm
  double relative_residual = 0;       ///< over that of the target
};
std::ostream& operator<<(std::ostream& out, const OracleFit& fit);

/// All approximations of the file.
[[nodiscard]] std::vector<OracleFit> oracle_fits();

/// The specifications of the family of materials behind the scalar products, in the file's order.
[[nodiscard]] std::vector<std::string> oracle_family();

/// "Ward(m=0.2)" -> "ward:m=0.2"; empty for a model that the library does not have.
[[nodiscard]] std::string oracle_material(const std::string& text);

}  // namespace lobe::test
