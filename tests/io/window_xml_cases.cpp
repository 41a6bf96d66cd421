#include "io/window_xml_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <numeric>
#include <random>
#include <sstream>

#include "lobe/core/error.hpp"

namespace lobe::test {

using std::numbers::pi;

std::string klems_bases(const std::string& name) {
  return "<ColumnAngleBasis>LBNL/Klems " + name + "</ColumnAngleBasis><RowAngleBasis>LBNL/Klems " + name +
         "</RowAngleBasis>";
}

std::string window_xml(const std::string& definition, const std::vector<XmlBlock>& blocks) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<WindowElement xmlns=\"http://windows.lbl.gov\">\n<Optical><Layer>\n"
      "<Material><Name>Cloth &amp; co</Name><Manufacturer>Nobody</Manufacturer></Material>\n<DataDefinition>" +
      definition + "</DataDefinition>\n";
  for (const XmlBlock& block : blocks) {
    text += "<WavelengthData><Wavelength unit=\"" + block.unit + "\">" + block.band +
            "</Wavelength>\n<WavelengthDataBlock><WavelengthDataDirection>" + block.direction +
            "</WavelengthDataDirection>" + block.bases + "<ScatteringDataType>" + block.type +
            "</ScatteringDataType>\n<ScatteringData>" + block.data +
            "</ScatteringData></WavelengthDataBlock></WavelengthData>\n";
  }
  return text + "</Layer></Optical></WindowElement>\n";
}

std::size_t KlemsPatches::size() const {
  return static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), 0));
}

std::size_t KlemsPatches::find(double theta, double phi) const {
  int first = 0;
  for (std::size_t ring = 0; ring < counts.size(); ++ring) {
    if (theta * 180 / pi < limits_deg[ring + 1]) {
      const double turn = phi / (2 * pi) - std::floor(phi / (2 * pi));
      return static_cast<std::size_t>(first + static_cast<int>(std::lround(turn * counts[ring])) % counts[ring]);
    }
    first += counts[ring];
  }
  throw std::runtime_error("below the horizon");
}

double KlemsPatches::solid_angle(std::size_t patch) const {
  auto rest = static_cast<int>(patch);
  std::size_t ring = 0;
  while (rest >= counts[ring]) rest -= counts[ring++];
  const double low = std::cos(limits_deg[ring] * pi / 180);
  const double high = std::cos(limits_deg[ring + 1] * pi / 180);
  return pi * (low * low - high * high) / counts[ring];
}

KlemsPatches klems_patches(int count) {
  if (count == 145) return {{0, 5, 15, 25, 35, 45, 55, 65, 75, 90}, {1, 8, 16, 20, 24, 24, 24, 16, 12}};
  if (count == 77) return {{0, 6.5, 19.5, 32.5, 45.5, 58.5, 71.5, 90}, {1, 8, 12, 16, 20, 12, 8}};
  if (count == 73) return {{0, 6.5, 19.5, 32.5, 46.5, 61.5, 76.5, 90}, {1, 8, 12, 16, 20, 12, 4}};
  return {{0, 9, 27, 46, 66, 90}, {1, 8, 12, 12, 8}};
}

std::vector<double> scattering_data(const std::string& xml, const std::string& band, const std::string& direction) {
  for (std::size_t at = xml.find("<WavelengthData>"); at != std::string::npos;
       at = xml.find("<WavelengthData>", at + 1)) {
    const std::string block = xml.substr(at, xml.find("</WavelengthData>", at) - at);
    if (block.find(">" + band + "<") == std::string::npos || block.find(direction) == std::string::npos) continue;
    const std::size_t begin = block.find("<ScatteringData>") + 16;
    std::string text = block.substr(begin, block.find("</ScatteringData>") - begin);
    std::ranges::replace(text, ',', ' ');
    std::istringstream words(text);
    std::vector<double> values;
    for (double value = 0; words >> value;) values.push_back(value);
    return values;
  }
  return {};
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void expect_robust(const std::string& text, std::size_t step, const std::function<void(const std::string&)>& read) {
  const auto check = [&](const std::string& damaged) {
    try {
      read(damaged);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  };
  for (std::size_t size = 0; size < text.size(); size += step) check(text.substr(0, size));
  std::mt19937 engine(7);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = text;
    for (int k = 0; k < 3; ++k) damaged[engine() % damaged.size()] = static_cast<char>(engine() % 256);
    check(damaged);
  }
}

}  // namespace lobe::test
