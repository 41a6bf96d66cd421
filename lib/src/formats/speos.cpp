// Tables of scatter as Ansys SPEOS (OPTIS) writes them as text: .brdf, one distribution for each wavelength, and
// .anisotropicbsdf, one for each angle of a surface with a direction, with a spectrum that scales them.
// Sources: the help of Ansys ("Structure of BRDF files", "Structure of Anisotropic BSDF Files", "Anisotropic BSDF
// Surface Overview"), and Ansys' converter (ansys/optical-automation, BSDF_converter.py).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kMostAngles = 10000;  // of a list, also keeps sizes small
constexpr double kLeastCosine = 1e-3;  // that intensities are divided by
constexpr std::string_view kMaker = "OPTIS - ";
constexpr std::string_view kBrdf = "brdf surface file";
constexpr std::string_view kAnisotropic = "anisotropic bsdf surface file";

enum class Kind { brdf, anisotropic, unknown };

Kind kind_of(std::string_view line) {
  if (!line.starts_with(kMaker)) return Kind::unknown;
  const std::string rest = lowercase(line.substr(kMaker.size()));
  if (rest.starts_with(kBrdf)) return Kind::brdf;
  return rest.starts_with(kAnisotropic) ? Kind::anisotropic : Kind::unknown;
}

bool recognises(const FileBytes& head) {
  LineReader lines(head);
  return lines.next() && kind_of(lines.line()) != Kind::unknown;
}

// --- A table by the angles of the viewer.

/// Between which of rising numbers a place lies, and how far from the first to the second.
struct Place {
  std::size_t before;
  std::size_t after;
  double share;
};

Place place_between(const std::vector<double>& nodes, double at) {
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(nodes, at) - nodes.begin());
  if (above == 0) return {0, 0, 0};
  if (above == nodes.size()) return {above - 1, above - 1, 0};
  return {above - 1, above, (at - nodes[above - 1]) / (nodes[above] - nodes[above - 1])};
}

/// On a circle.
/// \param at in [0, 2 pi)
Place place_around(const std::vector<double>& nodes, double at) {
  if (nodes.size() == 1 || (at >= nodes.front() && at <= nodes.back())) return place_between(nodes, at);
  const double gap = nodes.front() + 2 * pi - nodes.back();
  return {nodes.size() - 1, 0, (at > nodes.back() ? at - nodes.back() : at + 2 * pi - nodes.back()) / gap};
}

double within_circle(double angle) {
  const double turned = std::fmod(angle, 2 * pi);
  return turned < 0 ? turned + 2 * pi : turned;
}

struct Table {
  std::vector<double> theta;   ///< rising, radians
  std::vector<double> phi;     ///< rising, 0 the mirror side
  std::vector<double> values;  ///< theta x phi: proportional to f, or to f times the viewer's cosine

  /// Half a turn serves both sides.
  [[nodiscard]] bool folds() const { return phi.back() <= pi + 1e-9; }

  [[nodiscard]] double at(double theta_out, double turn) const {
    const Place t = place_between(theta, theta_out);
    const Place p =
        folds() ? place_between(phi, std::abs(std::remainder(turn, 2 * pi))) : place_around(phi, within_circle(turn));
    const auto along = [&](std::size_t row) {
      const double* const line = values.data() + row * phi.size();
      return (1 - p.share) * line[p.before] + p.share * line[p.after];
    };
    return (1 - t.share) * along(t.before) + t.share * along(t.after);
  }

  /// The mean over azimuths of what at() is, at a node of theta.
  [[nodiscard]] double mean(std::size_t row) const {
    const double* const line = values.data() + row * phi.size();
    const double whole = folds() ? pi : 2 * pi;
    double sum = 0;
    for (std::size_t k = 1; k < phi.size(); ++k) sum += (phi[k] - phi[k - 1]) * (line[k] + line[k - 1]) / 2;
    if (folds()) {
      sum += phi.front() * line[0] + (pi - phi.back()) * line[phi.size() - 1];
    } else {
      sum += (phi.front() + 2 * pi - phi.back()) * (line[0] + line[phi.size() - 1]) / 2;
    }
    return sum / whole;
  }

  /// The integral of the light over the hemisphere, exactly that of what at() is.
  /// \param has_cosine the values hold the viewer's cosine
  [[nodiscard]] double integral(bool has_cosine) const {
    // Antiderivatives of w and theta w, where w dtheta is the solid angle, or that times the cosine, over 2 pi.
    const auto area = [&](double t) { return has_cosine ? -std::cos(t) : std::sin(t) * std::sin(t) / 2; };
    const auto moment = [&](double t) {
      return has_cosine ? std::sin(t) - t * std::cos(t) : std::sin(2 * t) / 8 - t * std::cos(2 * t) / 4;
    };
    double sum =
        mean(0) * (area(theta.front()) - area(0)) + mean(theta.size() - 1) * (area(pi / 2) - area(theta.back()));
    for (std::size_t k = 1; k < theta.size(); ++k) {
      const double slope = (mean(k) - mean(k - 1)) / (theta[k] - theta[k - 1]);
      sum += (mean(k - 1) - slope * theta[k - 1]) * (area(theta[k]) - area(theta[k - 1])) +
             slope * (moment(theta[k]) - moment(theta[k - 1]));
    }
    return 2 * pi * sum;
  }
};

// --- Reading.

/// Rows of a file, with what they hold for complaints.
class SpeosLines {
 public:
  explicit SpeosLines(const FileBytes& file) : lines_(file), size_(file.size()) {}

  /// The next line, also a blank one.
  std::string_view text(std::string_view what) {
    if (!lines_.next()) refuse_end(what);
    return lines_.line();
  }
  /// The numbers of the next line that is not blank.
  std::vector<double> numbers(std::string_view what, std::size_t count) {
    if (!lines_.next_filled()) refuse_end(what);
    auto found = lines_.numbers(count);
    if (found.size() != count) refuse(fmt::format("{} numbers; expected {}, {}", found.size(), count, what));
    return found;
  }
  std::size_t whole(std::string_view what, double least, double most) {
    return whole_of(numbers(what, 1)[0], what, least, most);
  }
  [[nodiscard]] std::size_t whole_of(double value, std::string_view what, double least, double most) const {
    if (value != std::floor(value) || !(value >= least && value <= most)) {
      refuse(fmt::format("{} of {}; expected {} to {}", what, shortest(value), least, most));
    }
    return static_cast<std::size_t>(value);
  }
  /// Rising angles, as radians.
  std::vector<double> angles(std::string_view what, std::size_t count, double most) {
    auto list = numbers(what, count);
    for (std::size_t i = 0; i < list.size(); ++i) check_angle(list, i, what, most);
    for (double& angle : list) angle *= kDegree;
    return list;
  }
  void check_angle(const std::vector<double>& list, std::size_t i, std::string_view what, double most) const {
    if (!(list[i] >= 0 && list[i] <= most) || (i > 0 && list[i] <= list[i - 1])) {
      refuse(fmt::format("{} {}; expected rising ones from 0 to {} degrees", what, shortest(list[i]), most));
    }
  }
  /// How many rows of as many numbers there can be from here on; a number has two characters at least.
  [[nodiscard]] std::size_t most_rows(std::size_t numbers) const {
    return (size_ - lines_.offset()) / (2 * numbers) + 1;
  }
  /// Tables take memory of their own, beside that of their numbers.
  void check_tables(double count) const {
    constexpr std::size_t kSmallTable = 64;  // characters
    constexpr std::size_t kFewTables = 1000;
    if (count > static_cast<double>(size_ / kSmallTable + kFewTables)) refuse("more tables than the file can hold");
  }
  [[noreturn]] void refuse(std::string_view complaint) const { lines_.refuse(complaint); }

 private:
  [[noreturn]] void refuse_end(std::string_view what) const { refuse(fmt::format("the file ends; expected {}", what)); }

  LineReader lines_;
  std::size_t size_;
};

struct Speos {
  Kind kind = Kind::brdf;
  bool has_transmission = false;
  bool has_cosine = false;
  std::vector<double> wavelengths;              ///< nm
  std::vector<double> rotations{0};             ///< rotations of the surface's direction, radians
  std::vector<std::vector<double>> incidences;  ///< by rotation, radians
  std::vector<std::vector<std::size_t>> first;  ///< index of the first table, by rotation and incidence
  std::vector<Table> tables;
  std::vector<double> factors;  ///< .brdf: by table; else by wavelength: what makes reflectances of values
  std::size_t negative = 0;

  [[nodiscard]] double value(const Table& table, double theta_out, double turn) const {
    const double found = table.at(theta_out, turn);
    return has_cosine ? found / std::max(std::cos(theta_out), kLeastCosine) : found;
  }
};

void read_start(SpeosLines& lines, Speos& speos) {
  constexpr double kLeastBrdf = 8;
  constexpr double kLeastAnisotropic = 7;
  const std::string_view title = lines.text("the name of the format");
  speos.kind = kind_of(title);
  double version = 0;
  const std::string_view word = trim(title.substr(title.find_last_of(" \t") + 1));
  const double least = speos.kind == Kind::brdf ? kLeastBrdf : kLeastAnisotropic;
  if (!word.starts_with('v') || !parse_number(word.substr(1), version) || version < least) {
    lines.refuse(fmt::format("version '{}'; expected v{}.0 or later", word.substr(0, 40), least));
  }
  if (lines.whole("the mode (0: text)", 0, 1) == 1)
    lines.refuse("it is binary; expected a text (SPEOS saves it as such)");
  (void)lines.text("a comment");
  const std::size_t length = lines.whole("the length of the description", 0, 1e9);
  // Its lines, of which there is one where it is empty, too.
  for (std::size_t read = 0; read == 0 || read < length;) read += lines.text("the description").size() + 1;
  if (speos.kind == Kind::anisotropic) (void)lines.numbers("the direction of the surface", 3);
  const auto sides = lines.numbers("whether there is reflection and transmission", 2);
  speos.has_transmission = sides[1] != 0;
  if (sides[0] == 0) lines.refuse("it holds transmission only; expected a reflection");
  speos.has_cosine = lines.whole("the kind of values (1: reflectance, 0: intensity)", 0, 1) == 0;
}

Table read_table(SpeosLines& lines, Speos& speos) {
  const auto sizes = lines.numbers("numbers of polar angles and azimuths", 2);
  const std::size_t rows = lines.whole_of(sizes[0], "polar angles", 1, kMostAngles);
  const std::size_t columns = lines.whole_of(sizes[1], "azimuths", 1, kMostAngles);
  Table table;
  table.phi = lines.angles("azimuth", columns, 360);
  std::vector<double> degrees;
  table.values.reserve(std::min(rows, lines.most_rows(columns + 1)) * columns);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto numbers = lines.numbers("a polar angle and values", columns + 1);
    degrees.push_back(numbers[0]);
    lines.check_angle(degrees, row, "polar angle", 90);
    for (const double value : std::span(numbers).subspan(1)) {
      if (value < 0) ++speos.negative;
      table.values.push_back(value);
    }
  }
  for (const double angle : degrees) table.theta.push_back(angle * kDegree);
  return table;
}

/// Factor that gives the integral of a table this share of the light.
/// \param percent of the light that is reflected
double factor_of(const SpeosLines& lines, const Table& table, bool has_cosine, double percent) {
  if (!(percent >= 0)) lines.refuse(fmt::format("a reflectance of {} %; expected one from 0 on", shortest(percent)));
  const double integral = table.integral(has_cosine);
  if (percent == 0) return 0;
  if (!(integral > 0)) {
    lines.refuse(fmt::format("values whose integral is {}, for a reflectance of {} %", integral, shortest(percent)));
  }
  return percent / 100 / integral;
}

void read_brdf(SpeosLines& lines, Speos& speos) {
  const auto sizes = lines.numbers("numbers of incident angles and wavelengths", 2);
  const std::size_t incidences = lines.whole_of(sizes[0], "incident angles", 1, kMostAngles);
  const std::size_t wavelengths = lines.whole_of(sizes[1], "wavelengths", 1, kMostAngles);
  speos.incidences = {lines.angles("incident angle", incidences, 90)};
  speos.wavelengths = lines.numbers("wavelengths", wavelengths);
  lines.check_tables(static_cast<double>(incidences) * static_cast<double>(wavelengths));
  speos.first.resize(1);
  for (std::size_t i = 0; i < incidences; ++i) {
    speos.first[0].push_back(speos.tables.size());
    for (std::size_t w = 0; w < wavelengths; ++w) {
      const double percent = lines.numbers("a reflectance in percent", 1)[0];
      speos.tables.push_back(read_table(lines, speos));
      speos.factors.push_back(factor_of(lines, speos.tables.back(), speos.has_cosine, percent));
    }
  }
}

struct Angles {
  std::vector<double> rotations;
  std::vector<std::vector<double>> incidences;
};

Angles read_directions(SpeosLines& lines) {
  Angles angles;
  const std::size_t rotations = lines.whole("the number of anisotropy angles", 1, kMostAngles);
  angles.rotations = lines.angles("anisotropy angle", rotations, 360);
  for (std::size_t r = 0; r < rotations; ++r) {
    const std::size_t incidences = lines.whole("the number of incident angles", 1, kMostAngles);
    angles.incidences.push_back(lines.angles("incident angle", incidences, 90));
  }
  return angles;
}

/// A measured spectrum, at one incident direction.
struct Spectrum {
  double theta = 0;
  double rotation = 0;
  std::vector<double> wavelengths;
  std::vector<double> percent;
};

Spectrum read_spectrum(SpeosLines& lines) {
  Spectrum spectrum;
  const auto direction = lines.numbers("the direction of the spectrum", 2);
  spectrum.theta = direction[0] * kDegree;
  spectrum.rotation = direction[1] * kDegree;
  (void)lines.text("a description of the spectrum");
  const std::size_t count = lines.whole("the number of wavelengths", 1, kMostAngles);
  for (std::size_t w = 0; w < count; ++w) {
    const auto row = lines.numbers("a wavelength and its reflectance in percent", 2);
    spectrum.wavelengths.push_back(row[0]);
    spectrum.percent.push_back(row[1]);
  }
  return spectrum;
}

void read_anisotropic(SpeosLines& lines, Speos& speos) {
  Angles angles = read_directions(lines);
  speos.rotations = std::move(angles.rotations);
  speos.incidences = std::move(angles.incidences);
  if (speos.has_transmission) (void)read_directions(lines);
  Spectrum spectrum = read_spectrum(lines);
  if (speos.has_transmission) (void)read_spectrum(lines);
  double tables = 0;
  for (const auto& incidences : speos.incidences) tables += static_cast<double>(incidences.size());
  lines.check_tables(tables);
  for (const auto& incidences : speos.incidences) {
    auto& first = speos.first.emplace_back();
    for (std::size_t i = 0; i < incidences.size(); ++i) {
      first.push_back(speos.tables.size());
      speos.tables.push_back(read_table(lines, speos));
    }
  }
  // The spectrum is that of the direction where it was measured; between two of them factors count by the distance.
  const auto nearest = std::ranges::min_element(speos.rotations, {}, [&](double rotation) {
    return std::abs(std::remainder(rotation - spectrum.rotation, 2 * pi));
  });
  const auto rotation = static_cast<std::size_t>(nearest - speos.rotations.begin());
  const Place place = place_between(speos.incidences[rotation], spectrum.theta);
  const auto unit = [&](std::size_t i) {
    return factor_of(lines, speos.tables[speos.first[rotation][i]], speos.has_cosine, 100);
  };
  const double factor = (1 - place.share) * unit(place.before) + place.share * unit(place.after);
  for (const double percent : spectrum.percent) {
    if (!(percent >= 0)) lines.refuse(fmt::format("a reflectance of {} %; expected one from 0 on", shortest(percent)));
    speos.factors.push_back(factor * percent / 100);
  }
  speos.wavelengths = std::move(spectrum.wavelengths);
}

void check_wavelengths(const SpeosLines& lines, const Speos& speos) {
  for (std::size_t w = 0; w < speos.wavelengths.size(); ++w) {
    if (!(speos.wavelengths[w] > 0) || (w > 0 && speos.wavelengths[w] <= speos.wavelengths[w - 1])) {
      lines.refuse(fmt::format("wavelength {}; expected rising ones above 0 nm", shortest(speos.wavelengths[w])));
    }
  }
}

/// Linear in each angle: of the surface, of the light, and of the viewer about the mirror direction's azimuth.
BrdfValues evaluate(const Speos& speos, std::span<const Directions> pairs) {
  const std::size_t channels = speos.wavelengths.size();
  BrdfValues found;
  found.value.setZero(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(channels));
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [theta_in, theta_out, delta_phi, phi_in] = pairs[p];
    // The surface's direction from the azimuth that the light goes on to, which is opposite to the light's own.
    const Place turned = place_around(speos.rotations, within_circle(pi - phi_in));
    for (const auto& [rotation, part] : {std::pair{turned.before, 1 - turned.share}, {turned.after, turned.share}}) {
      if (part == 0) continue;
      const Place lit = place_between(speos.incidences[rotation], theta_in);
      for (const auto& [incidence, share] : {std::pair{lit.before, 1 - lit.share}, {lit.after, lit.share}}) {
        if (share == 0) continue;
        const std::size_t first = speos.first[rotation][incidence];
        double value = 0;
        for (std::size_t c = 0; c < channels; ++c) {
          const std::size_t table = speos.kind == Kind::brdf ? first + c : first;
          if (c == 0 || table != first) value = speos.value(speos.tables[table], theta_out, delta_phi - pi);
          const double factor = speos.factors[speos.kind == Kind::brdf ? table : c];
          found.value(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(c)) += part * share * factor * value;
        }
      }
    }
  }
  return found;
}

BrdfFunction read(const FileBytes& file, const ReadOptions&) {
  SpeosLines lines(file);
  Speos speos;
  read_start(lines, speos);
  if (speos.kind == Kind::brdf) {
    read_brdf(lines, speos);
  } else {
    read_anisotropic(lines, speos);
  }
  check_wavelengths(lines, speos);
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kSpeosFormat.title;
  brdf.wavelengths = speos.wavelengths;
  for (const double wavelength : speos.wavelengths) brdf.channels.push_back(shortest(wavelength) + " nm");
  brdf.conventions = fmt::format(
      "{}, scaled to the reflectances in percent that the file states; degrees from the normal, azimuths from the "
      "mirror "
      "side; linear between the angles, the outermost values beyond them",
      speos.has_cosine ? "intensities, divided by the cosine of the viewer" : "proportional to sr^-1");
  if (speos.has_transmission) brdf.remarks.emplace_back("its transmission is left out");
  if (speos.negative > 0) brdf.remarks.push_back(fmt::format("{} values are negative, and kept", speos.negative));
  brdf.is_isotropic = speos.rotations.size() == 1;
  brdf.is_bilateral = brdf.is_isotropic && std::ranges::all_of(speos.tables, &Table::folds);
  brdf.at = [tables = std::make_shared<const Speos>(std::move(speos))](std::span<const Directions> pairs) {
    return evaluate(*tables, pairs);
  };
  return brdf;
}

}  // namespace

const Format kSpeosFormat{"speos", "Ansys SPEOS .brdf and .anisotropicbsdf, text", recognises, read};

}  // namespace lobe
