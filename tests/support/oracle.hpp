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
  std::vector<double> values;
  double uncertainty = 0;  ///< of the values, absolute; 0 where the file states none
};
std::ostream& operator<<(std::ostream& out, const OracleRecord& record);

/// All records of a quantity that the library's models cover. The file is LOBE_ORACLE where that names an existing
/// file, else tests/golden/oracle.json, a transcription of the part of it that is used here.
[[nodiscard]] std::vector<OracleRecord> oracle_records(const std::string& quantity);

/// The specifications of the family of materials behind the scalar products, in the file's order.
[[nodiscard]] std::vector<std::string> oracle_family();

/// "Ward(m=0.2)" -> "ward:m=0.2"; empty for a model that the library does not have.
[[nodiscard]] std::string oracle_material(const std::string& text);

}  // namespace lobe::test
