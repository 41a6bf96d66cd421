#pragma once

#include <functional>
#include <string>
#include <vector>

namespace lobe::test {

/// One WavelengthDataBlock of a file that a test writes.
struct XmlBlock {
  std::string direction = "Reflection Front";
  std::string band = "Visible";
  std::string bases;  ///< elements ColumnAngleBasis and RowAngleBasis, or AngleBasis
  std::string data;
  std::string unit = "Integral";
  std::string type = "BTDF";
};

/// ColumnAngleBasis and RowAngleBasis of a Klems basis: "Full".
std::string klems_bases(const std::string& name);

/// An XML of WINDOW.
/// \param definition content of DataDefinition
std::string window_xml(const std::string& definition, const std::vector<XmlBlock>& blocks);

/// A Klems basis as the tables of Radiance and CalcEngine have it: patches counted along azimuths, then rings.
struct KlemsPatches {
  std::vector<double> limits_deg;
  std::vector<int> counts;

  [[nodiscard]] std::size_t size() const;
  /// The patch of a direction; angles in radians.
  /// \param phi any
  [[nodiscard]] std::size_t find(double theta, double phi) const;
  [[nodiscard]] double solid_angle(std::size_t patch) const;  ///< projected, sr
};
KlemsPatches klems_patches(int count);

/// The numbers of the n-th ScatteringData of a file, by nothing but a search for its marks.
std::vector<double> scattering_data(const std::string& xml, const std::string& band, const std::string& direction);

std::string text_of(const std::string& path);

/// Every cut of a text and many with changed bytes are read or refused by one line.
void expect_robust(const std::string& text, std::size_t step, const std::function<void(const std::string&)>& read);

}  // namespace lobe::test
