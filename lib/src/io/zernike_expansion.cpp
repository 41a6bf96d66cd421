// Reciprocal expansions of measured reflectances in Zernike polynomials (Koenderink and van Doorn 1998).
// Source: Germer 2017 ("Full four-dimensional and reciprocal Mueller matrix BRDF of sintered PTFE"), the part of
// unpolarised light.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <utility>

#include "core/files.hpp"
#include "core/text.hpp"
#include "io/measured_formats.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kColumns = 8;
constexpr int kHighestOrder = 12;  // up to which the alternating sums of radial() keep twelve digits

/// a lambda^p c [R_n^l(rho_i) R_m^l(rho_r) + R_m^l(rho_i) R_n^l(rho_r)] cos(l (phi_r - phi_i)); lambda in micrometres,
/// rho = sqrt(2) sin(theta/2).
struct Coefficient {
  int n, m, l;
  double p;
  double a;
};

struct Line {
  std::size_t number;
  std::vector<double> cells;
};

std::vector<double> numbers_of(std::string_view line) {
  std::vector<double> cells;
  for (const auto part : split(line, ',')) {
    double value = 0;
    if (!parse_number(trim(part), value)) return {};
    cells.push_back(value);
  }
  return cells;
}

[[noreturn]] void refuse(const std::filesystem::path& path, std::size_t line, std::string_view complaint) {
  throw IoError(fmt::format("cannot read {}: line {} {}", path.string(), line, complaint));
}

bool is_order(double value) {
  return value == std::floor(value) && value >= 0 && value <= kHighestOrder;
}

Coefficient coefficient_of(const Line& line, const std::filesystem::path& path) {
  const auto& c = line.cells;
  for (const std::size_t column : {2U, 3U, 5U}) {
    if (!is_order(c[column])) {
      refuse(path, line.number, fmt::format("has the order {}; expected 0 to {}", c[column], kHighestOrder));
    }
  }
  const Coefficient found{static_cast<int>(c[2]), static_cast<int>(c[3]), static_cast<int>(c[5]), c[6], c[7]};
  for (const int order : {found.n, found.m}) {
    if (order < found.l || (order - found.l) % 2 != 0) {
      refuse(path, line.number, fmt::format("has R_{}^{}, which is no Zernike polynomial", order, found.l));
    }
  }
  return found;
}

/// Radial Zernike polynomial, by its sum.
double radial(int n, int l, double rho) {
  double sum = 0;
  double term = 1;  // (-1)^s (n-s)! / (s! ((n+l)/2-s)! ((n-l)/2-s)!)
  for (int k = 1; k <= (n - l) / 2; ++k) term *= static_cast<double>((n + l) / 2 + k) / k;
  for (int s = 0; s <= (n - l) / 2; ++s) {
    sum += term * std::pow(rho, n - 2 * s);
    term *= -static_cast<double>(((n + l) / 2 - s) * ((n - l) / 2 - s)) / ((s + 1) * static_cast<double>(n - s));
  }
  return sum;
}

class ZernikeExpansion : public MeasuredBrdf {
 public:
  ZernikeExpansion(MeasuredInfo info, std::vector<Coefficient> coefficients, std::vector<double> micrometres)
      : MeasuredBrdf(std::move(info)), coefficients_(std::move(coefficients)), micrometres_(std::move(micrometres)) {}

  [[nodiscard]] Eigen::MatrixXd evaluate(std::span<const Directions> pairs) const override {
    Eigen::MatrixXd values =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(micrometres_.size()));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (const Coefficient& one : coefficients_) {
        const double shape = shape_of(one, pairs[i]);
        for (std::size_t c = 0; c < micrometres_.size(); ++c) {
          values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) +=
              std::pow(micrometres_[c], one.p) * shape;
        }
      }
    }
    return values;
  }

 private:
  static double shape_of(const Coefficient& one, const Directions& pair) {
    const auto [n, m, l, p, a] = one;
    const double rho_i = std::numbers::sqrt2 * std::sin(pair.theta_in / 2);
    const double rho_r = std::numbers::sqrt2 * std::sin(pair.theta_out / 2);
    const double q = n == 0 || (n == m && l == 0) ? 4 : (n == m || l == 0 ? 2 : 1);
    const double both = radial(n, l, rho_i) * radial(m, l, rho_r) + radial(m, l, rho_i) * radial(n, l, rho_r);
    return a / (2 * pi) * std::sqrt((n + 1) * (m + 1) / q) * both * std::cos(l * pair.delta_phi);
  }

  std::vector<Coefficient> coefficients_;
  std::vector<double> micrometres_;
};

std::vector<Line> read_lines(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw IoError("cannot read " + path.string() + ": cannot open it");
  std::vector<Line> lines;
  std::string text;
  for (std::size_t number = 1; std::getline(file, text); ++number) {
    if (trim(text).empty()) continue;
    Line line{number, numbers_of(text)};
    if (line.cells.size() != kColumns) refuse(path, number, "is not eight numbers i,j,n,m,k,l,p,a");
    if (!std::ranges::all_of(line.cells, [](double value) { return std::isfinite(value); })) {
      refuse(path, number, "has a number that is not finite");
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace

bool is_zernike_expansion(const std::filesystem::path& path) {
  constexpr std::size_t kLongest = 400;  // characters of a line
  std::ifstream file(path);
  std::string start(4 * kLongest, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  const auto first = start.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return false;
  const auto cells = numbers_of(std::string_view(start).substr(first, start.find('\n', first) - first));
  return cells.size() == kColumns && cells[0] == 1 && cells[1] == 1;
}

std::unique_ptr<MeasuredBrdf> load_zernike_expansion(const std::filesystem::path& path,
                                                     const MeasuredOptions& options) {
  std::vector<Coefficient> coefficients;
  bool is_spectral = false;
  for (const Line& line : read_lines(path)) {
    if (line.cells[0] != 1 || line.cells[1] != 1) continue;  // of polarised light
    coefficients.push_back(coefficient_of(line, path));
    is_spectral = is_spectral || coefficients.back().p != 0;
  }
  if (is_spectral && options.wavelengths.empty()) {
    throw ArgumentError(path.string() + " depends on the wavelength; expected wavelengths in nm");
  }
  if (!is_spectral && !options.wavelengths.empty()) {
    throw ArgumentError(path.string() + " does not depend on the wavelength; expected no wavelengths");
  }
  MeasuredInfo info{
      path.stem().string(),
      "NIST Zernike coefficients",
      "sr^-1 without cosine, unpolarised light; azimuth differences of 180 degrees are the mirror side; a "
      "reciprocal polynomial, fitted to angles up to 80 degrees",
      {}};
  std::vector<double> micrometres;
  for (const double wavelength : options.wavelengths) {
    if (!(wavelength > 0)) {
      throw ArgumentError(fmt::format("wavelength of {} nm; expected one above 0", shortest(wavelength)));
    }
    info.channels.push_back(shortest(wavelength) + " nm");
    micrometres.push_back(wavelength / 1000);
  }
  if (!is_spectral) {
    info.channels.emplace_back("value");
    micrometres.push_back(1);
  }
  return std::make_unique<ZernikeExpansion>(std::move(info), std::move(coefficients), std::move(micrometres));
}

}  // namespace lobe
