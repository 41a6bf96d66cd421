// Reciprocal expansions of measured reflectances in Zernike polynomials (Koenderink and van Doorn 1998).
// Source: Germer 2017 ("Full four-dimensional and reciprocal Mueller matrix BRDF of sintered PTFE"), the part of
// unpolarised light.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "lobe/core/error.hpp"

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

bool is_order(double value) {
  return value == std::floor(value) && value >= 0 && value <= kHighestOrder;
}

Coefficient coefficient_of(const std::vector<double>& c, const LineReader& lines) {
  for (const std::size_t column : {2U, 3U, 5U}) {
    if (!is_order(c[column])) {
      lines.refuse(fmt::format("order {}; expected 0 to {}", c[column], kHighestOrder));
    }
  }
  const Coefficient found{static_cast<int>(c[2]), static_cast<int>(c[3]), static_cast<int>(c[5]), c[6], c[7]};
  for (const int order : {found.n, found.m}) {
    if (order < found.l || (order - found.l) % 2 != 0) {
      lines.refuse(fmt::format("R_{}^{} is no Zernike polynomial", order, found.l));
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

/// R_n^l(rho_i) R_m^l(rho_r) + R_m^l(rho_i) R_n^l(rho_r), its factors, and cos(l delta_phi).
double shape_of(const Coefficient& one, const Directions& pair) {
  const auto [n, m, l, p, a] = one;
  const double rho_i = std::numbers::sqrt2 * std::sin(pair.theta_in / 2);
  const double rho_r = std::numbers::sqrt2 * std::sin(pair.theta_out / 2);
  const double q = n == 0 || (n == m && l == 0) ? 4 : (n == m || l == 0 ? 2 : 1);
  const double both = radial(n, l, rho_i) * radial(m, l, rho_r) + radial(m, l, rho_i) * radial(n, l, rho_r);
  return a / (2 * pi) * std::sqrt((n + 1) * (m + 1) / q) * both * std::cos(l * pair.delta_phi);
}

BrdfValues evaluate(std::span<const Coefficient> coefficients, std::span<const double> micrometres,
                    std::span<const Directions> pairs) {
  BrdfValues values;
  values.value =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(micrometres.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const Coefficient& one : coefficients) {
      const double shape = shape_of(one, pairs[i]);
      for (std::size_t c = 0; c < micrometres.size(); ++c) {
        values.value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) +=
            std::pow(micrometres[c], one.p) * shape;
      }
    }
  }
  return values;
}

bool recognises(const FileBytes& head) {
  constexpr std::size_t kLongest = 400;  // characters of a line
  LineReader lines(head);
  if (!lines.next_filled() || lines.line().size() > kLongest) return false;
  const auto words = words_of(lines.line());
  double value = 0;
  return words.size() == kColumns && words[0] == "1" && words[1] == "1" &&
         std::ranges::all_of(words, [&](std::string_view word) { return parse_number(word, value); });
}

std::vector<Coefficient> read_coefficients(const FileBytes& file) {
  std::vector<Coefficient> coefficients;
  LineReader lines(file);
  coefficients.reserve(lines.most_rows(kColumns));
  while (lines.next_filled()) {
    const auto cells = lines.numbers(kColumns);
    if (cells.size() != kColumns) lines.refuse("no eight numbers i,j,n,m,k,l,p,a");
    if (cells[0] != 1 || cells[1] != 1) continue;  // of polarised light
    coefficients.push_back(coefficient_of(cells, lines));
  }
  return coefficients;
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  const auto coefficients = read_coefficients(file);
  const bool is_spectral = std::ranges::any_of(coefficients, [](const Coefficient& one) { return one.p != 0; });
  if (is_spectral && options.wavelengths.empty()) {
    throw ArgumentError(file.path().string() + " depends on the wavelength; expected wavelengths in nm");
  }
  if (!is_spectral && !options.wavelengths.empty()) {
    throw ArgumentError(file.path().string() + " does not depend on the wavelength; expected no wavelengths");
  }
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kZernikeFormat.title;
  brdf.conventions =
      "sr^-1 without cosine, unpolarised light; azimuth differences of 180 degrees are the mirror side; a reciprocal "
      "polynomial, fitted to angles up to 80 degrees";
  brdf.is_bilateral = true;
  brdf.wavelengths = options.wavelengths;
  std::vector<double> micrometres;
  for (const double wavelength : options.wavelengths) {
    if (!(wavelength > 0)) {
      throw ArgumentError(fmt::format("wavelength of {} nm; expected one above 0", shortest(wavelength)));
    }
    brdf.channels.push_back(shortest(wavelength) + " nm");
    micrometres.push_back(wavelength / 1000);
  }
  if (!is_spectral) {
    brdf.channels = {"value"};
    micrometres = {1};
  }
  brdf.at = [coefficients, micrometres](std::span<const Directions> pairs) {
    return evaluate(coefficients, micrometres, pairs);
  };
  return brdf;
}

}  // namespace

const Format kZernikeFormat{"nist-zernike", "NIST Zernike coefficients", recognises, read, true};

}  // namespace lobe
