#include "reference/file_formats.hpp"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace lobe::reference {
namespace {

using std::numbers::pi;

constexpr double kDegrees = pi / 180;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

/// gzopen() also reads what is not compressed.
std::string content_of(const std::filesystem::path& path) {
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) refuse(path, "cannot be opened");
  std::string content;
  std::vector<char> block(1U << 16);
  for (int got = 0; (got = gzread(file, block.data(), static_cast<unsigned>(block.size()))) > 0;) {
    content.append(block.data(), static_cast<std::size_t>(got));
  }
  gzclose(file);
  return content;
}

std::vector<std::string> lines_of(const std::string& content) {
  std::vector<std::string> lines;
  std::istringstream stream(content);
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

/// All numbers of a text, between blanks, commas and whatever else is none.
std::vector<double> numbers_of(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (std::string word; stream >> word;) {
    double number = 0;
    const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    const auto [stop, code] = std::from_chars(begin, end, number);
    if (code == std::errc() && stop == end) numbers.push_back(number);
  }
  return numbers;
}

std::string stem_of(std::filesystem::path path) {
  if (path.extension() == ".gz") path = path.stem();
  return path.stem().string();
}

// ---------------------------------------------------------------------------------------------------- Fourier tables

template <typename T>
std::vector<T> array_at(const std::string& bytes, std::size_t at, std::size_t count) {
  if (at + count * sizeof(T) > bytes.size()) throw std::runtime_error("the file is cut");
  std::vector<T> values(count);
  std::memcpy(values.data(), bytes.data() + at, count * sizeof(T));
  return values;
}

struct Fourier {
  std::vector<double> nodes;
  std::vector<std::uint32_t> places;  // offset and length of each pair, incident nodes fastest
  std::vector<float> coefficients;
  std::size_t channels = 1;
  // Series between the nodes of the last pair of angles.
  double theta_in = -1, theta_out = -1;
  std::vector<std::vector<double>> series;
};

/// pbrt-v3, CatmullRomWeights(): the node before x less one, and weights of the four from there on.
std::pair<long, std::array<double, 4>> catmull_rom(const std::vector<double>& nodes, double x) {
  const auto n = static_cast<long>(nodes.size());
  x = std::clamp(x, nodes.front(), nodes.back());
  long i = 0;
  while (i + 2 < n && nodes[static_cast<std::size_t>(i + 1)] <= x) ++i;
  const auto at = [&](long k) { return nodes[static_cast<std::size_t>(k)]; };
  const double x0 = at(i);
  const double x1 = at(i + 1);
  const double t = (x - x0) / (x1 - x0);
  std::array<double, 4> w{0, 2 * t * t * t - 3 * t * t + 1, -2 * t * t * t + 3 * t * t, 0};
  const double left = t * t * t - 2 * t * t + t;
  if (i > 0) {
    const double w0 = left * (x1 - x0) / (x1 - at(i - 1));
    w[0] = -w0;
    w[2] += w0;
  } else {
    w[1] -= left;
    w[2] += left;
  }
  const double right = t * t * t - t * t;
  if (i + 2 < n) {
    const double w3 = right * (x1 - x0) / (at(i + 2) - x0);
    w[1] -= w3;
    w[3] = w3;
  } else {
    w[1] -= right;
    w[2] += right;
  }
  return {i - 1, w};
}

Rgb fourier_value(Fourier& table, double theta_in, double theta_out, double delta_phi) {
  if (theta_in != table.theta_in || theta_out != table.theta_out) {
    table.theta_in = theta_in;
    table.theta_out = theta_out;
    table.series.assign(table.channels, {});
    // Light travels downwards.
    const auto [first_in, in] = catmull_rom(table.nodes, -std::cos(theta_in));
    const auto [first_out, out] = catmull_rom(table.nodes, std::cos(theta_out));
    for (long o = 0; o < 4; ++o) {
      for (long i = 0; i < 4; ++i) {
        const double weight = in[static_cast<std::size_t>(i)] * out[static_cast<std::size_t>(o)];
        if (weight == 0) continue;
        const auto node =
            static_cast<std::size_t>(first_out + o) * table.nodes.size() + static_cast<std::size_t>(first_in + i);
        const std::size_t offset = table.places[2 * node];
        const std::size_t length = table.places[2 * node + 1];
        for (std::size_t c = 0; c < table.channels; ++c) {
          if (table.series[c].size() < length) table.series[c].resize(length);
          for (std::size_t k = 0; k < length; ++k) {
            table.series[c][k] += weight * static_cast<double>(table.coefficients[offset + c * length + k]);
          }
        }
      }
    }
  }
  std::array<double, 3> sums{};
  // The azimuth between the way of the light and the viewer.
  const double phi = delta_phi - pi;
  const std::size_t longest =
      std::max_element(table.series.begin(), table.series.end(), [](const auto& a, const auto& b) {
        return a.size() < b.size();
      })->size();
  // cos(k phi) by turning a vector, set right now and then.
  const double turn_x = std::cos(phi);
  const double turn_y = std::sin(phi);
  double x = 1;
  double y = 0;
  for (std::size_t k = 0; k < longest; ++k) {
    if (k % 64 == 0) {
      x = std::cos(static_cast<double>(k) * phi);
      y = std::sin(static_cast<double>(k) * phi);
    }
    for (std::size_t c = 0; c < table.channels; ++c) {
      if (k < table.series[c].size()) sums[c] += table.series[c][k] * x;
    }
    const double next = x * turn_x - y * turn_y;
    y = x * turn_y + y * turn_x;
    x = next;
  }
  for (double& sum : sums) sum /= std::cos(theta_in);
  if (table.channels == 1) return {sums[0], sums[0], sums[0]};
  // Luminance, red and blue of linear sRGB.
  return {sums[1], (sums[0] - 0.212671 * sums[1] - 0.072169 * sums[2]) / 0.715160, sums[2]};
}

// ------------------------------------------------------------------------------------------------ Zernike polynomials

double factorial(int n) {
  return std::tgamma(n + 1.0);
}

/// Coefficients of R_n^l(rho) = sum over s of (-1)^s (n-s)! / (s! ((n+l)/2-s)! ((n-l)/2-s)!) rho^(n-2s), by powers.
std::vector<double> radial(int n, int l) {
  std::vector<double> powers(static_cast<std::size_t>(n) + 1);
  for (int s = 0; s <= (n - l) / 2; ++s) {
    powers[static_cast<std::size_t>(n - 2 * s)] =
        (s % 2 == 0 ? 1 : -1) * factorial(n - s) /
        (factorial(s) * factorial((n + l) / 2 - s) * factorial((n - l) / 2 - s));
  }
  return powers;
}

struct Coefficient {
  int n, m, l;
  double a;
};

struct Zernike {
  std::vector<Coefficient> coefficients;
  std::vector<std::pair<int, int>> orders;  // (n, l) that occur
  std::vector<std::vector<double>> radials;
  double last_theta = -1;  // integrals take one angle of the light after the other
  std::vector<double> last;

  /// R_n^l in the order of `orders`.
  [[nodiscard]] std::vector<double> at(double theta) {
    if (theta == last_theta) return last;
    const double rho = std::numbers::sqrt2 * std::sin(theta / 2);
    std::vector<double> values;
    for (const auto& powers : radials) {
      double sum = 0;
      for (std::size_t k = powers.size(); k-- > 0;) sum = sum * rho + powers[k];
      values.push_back(sum);
    }
    last_theta = theta;
    last = values;
    return values;
  }
};

// -------------------------------------------------------------------------------------------------------------- XML

/// Text between a tag and the next `<`, from a place on; npos where there is none.
std::string text_after(const std::string& xml, const std::string& tag, std::size_t& at) {
  at = xml.find("<" + tag, at);
  if (at == std::string::npos) return {};
  at = xml.find('>', at) + 1;
  const std::size_t end = xml.find('<', at);
  return xml.substr(at, end - at);
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

struct Block {
  std::string channel, direction, data;
};

/// The blocks of a file, each with the wavelength that stands before it.
std::vector<Block> blocks_of(const std::string& xml) {
  std::vector<Block> blocks;
  std::size_t at = 0;
  while ((at = xml.find("<WavelengthDataBlock>", at)) != std::string::npos) {
    Block block;
    std::size_t before = xml.rfind("<Wavelength ", at);
    block.channel = trimmed(text_after(xml, "Wavelength ", before));
    std::size_t place = at;
    block.direction = trimmed(text_after(xml, "WavelengthDataDirection", place));
    place = at;
    block.data = text_after(xml, "ScatteringData>", place);
    blocks.push_back(block);
    ++at;
  }
  return blocks;
}

/// Those of reflection front, or else back.
std::vector<Block> reflection_of(const std::filesystem::path& path, const std::string& xml) {
  const auto all = blocks_of(xml);
  for (const char* side : {"Reflection Front", "Reflection Back"}) {
    std::vector<Block> chosen;
    std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
                 [&](const Block& block) { return block.direction == side; });
    if (!chosen.empty()) return chosen;
  }
  refuse(path, "no reflection");
}

// ------------------------------------------------------------------------------------------------------ tensor trees

/// A node of a tree: its parts, or a grid of numbers.
struct Node {
  std::vector<Node> parts;
  std::vector<double> grid;
};

Node node_of(const std::vector<std::string>& words, std::size_t& at) {
  if (words.at(at) != "{") throw std::runtime_error("no '{' where a tree begins");
  Node node;
  for (++at; words.at(at) != "}";) {
    if (words[at] == "{") {
      node.parts.push_back(node_of(words, at));
    } else {
      node.grid.push_back(std::stod(words[at++]));
    }
  }
  ++at;
  return node;
}

std::size_t level_of(const Node& node) {
  if (node.parts.empty()) {
    return static_cast<std::size_t>(std::lround(std::log2(static_cast<double>(node.grid.size())) / 3));
  }
  std::size_t deepest = 0;
  for (const Node& part : node.parts) deepest = std::max(deepest, level_of(part));
  return deepest + 1;
}

/// \param x in [0, 1)^3
double value_at(const Node& node, std::array<double, 3> x) {
  if (!node.parts.empty()) {
    std::size_t part = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] *= 2;
      if (x[k] >= 1) {
        x[k] -= 1;
        part += std::size_t{1} << k;
      }
    }
    return value_at(node.parts.at(part), x);
  }
  const auto side = static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(node.grid.size()))));
  std::size_t index = 0;
  for (std::size_t k = 0; k < 3; ++k) index = index * side + static_cast<std::size_t>(x[k] * static_cast<double>(side));
  return node.grid.at(index);
}

// ----------------------------------------------------------------------------------------------------------- samples

struct Direction {
  double x, y, z;
};

Direction at_angles(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

bool is_number_line(const std::string& line) {
  const auto first = line.find_first_not_of(" \t");
  return first != std::string::npos && (std::isdigit(static_cast<unsigned char>(line[first])) != 0 ||
                                        line[first] == '-' || line[first] == '+' || line[first] == '.');
}

/// pbrt-v2: comments, the number of wavelengths, these, and rows of four angles and values.
std::vector<Sample> cornell_samples(const std::vector<std::string>& lines, std::size_t channel) {
  std::string text;
  for (const std::string& line : lines) text += line.substr(0, line.find('#')) + "\n";
  const auto numbers = numbers_of(text);
  const auto n = static_cast<std::size_t>(numbers.at(0));
  std::vector<Sample> samples;
  for (std::size_t at = 1 + n; at + 4 + n <= numbers.size(); at += 4 + n) {
    samples.push_back({numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3], numbers[at + 4 + channel]});
  }
  return samples;
}

/// Columns lambda, thetai, phi, thetar, phir, f_r11, ...; angles below 0 lie on the other side of the normal.
std::vector<Sample> nist_samples(const std::vector<std::string>& lines, std::size_t channel) {
  std::vector<double> wavelengths;
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto row = numbers_of(lines[k]);
    if (row.size() < 6) continue;
    rows.push_back(row);
    if (std::find(wavelengths.begin(), wavelengths.end(), row[0]) == wavelengths.end()) wavelengths.push_back(row[0]);
  }
  std::sort(wavelengths.begin(), wavelengths.end());
  std::vector<Sample> samples;
  for (const auto& row : rows) {
    if (row[0] != wavelengths.at(channel)) continue;
    const auto turned = [](double theta, double phi) {
      return theta < 0 ? std::pair{-theta * kDegrees, phi * kDegrees + pi}
                       : std::pair{theta * kDegrees, phi * kDegrees};
    };
    const auto [theta_in, phi_in] = turned(row[1], row[2]);
    const auto [theta_out, phi_out] = turned(row[3], row[4]);
    samples.push_back({theta_in, phi_in, theta_out, phi_out, row[5]});
  }
  return samples;
}

/// Bidirectional reflectance factors by zenith angle and azimuth of source and viewer.
std::vector<Sample> brf_samples(const std::vector<std::string>& lines, std::size_t channel) {
  std::vector<Sample> samples;
  bool is_table = false;
  for (const std::string& line : lines) {
    if (line.rfind("src_z", 0) == 0) is_table = true;
    if (!is_table || !is_number_line(line)) continue;
    const auto row = numbers_of(line);
    samples.push_back({row.at(0) * kDegrees, row.at(1) * kDegrees, row.at(2) * kDegrees, row.at(3) * kDegrees,
                       row.at(4 + channel) / pi});
  }
  return samples;
}

/// Blocks of the specular direction, two numbers, and of scattered ones with their values, three.
std::vector<Sample> fred_samples(const std::vector<std::string>& lines) {
  std::vector<Sample> samples;
  double theta = 0;
  double phi = 0;
  for (const std::string& line : lines) {
    if (!is_number_line(line)) continue;
    const auto row = numbers_of(line);
    if (row.size() == 2) {
      theta = row[0] * kDegrees;
      phi = row[1] * kDegrees;
    } else if (row.size() == 3) {
      // The light comes from half a turn away.
      samples.push_back({theta, phi + pi, row[0] * kDegrees, row[1] * kDegrees, row[2]});
    }
  }
  return samples;
}

/// Angles from the specular direction, and azimuths about it from the direction towards the normal.
std::vector<Sample> zemax_samples(const std::vector<std::string>& lines) {
  const std::array<std::string, 4> keys{"SampleRotation", "AngleOfIncidence", "ScatterAzimuth", "ScatterRadial"};
  std::array<std::vector<double>, 4> axes;
  std::vector<double> values;
  bool is_data = false;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::string& line = lines[k];
    for (std::size_t a = 0; a < 4; ++a) {
      if (!is_data && line.rfind(keys[a], 0) == 0) axes[a] = numbers_of(lines.at(k + 1));
    }
    if (line.rfind("DataBegin", 0) == 0) is_data = true;
    if (line.rfind("DataEnd", 0) == 0) is_data = false;
    if (!is_data || !is_number_line(line)) continue;
    const auto row = numbers_of(line);
    values.insert(values.end(), row.begin(), row.end());
  }
  std::vector<Sample> samples;
  std::size_t at = 0;
  for (const double rotation : axes[0]) {
    for (const double incidence : axes[1]) {
      for (const double azimuth : axes[2]) {
        for (const double radius : axes[3]) {
          const double value = values.at(at++);
          if (value == 0) continue;
          // Light from azimuth 180 degrees, the specular direction at 0, both turned by the sample.
          const double theta = incidence * kDegrees;
          const Direction specular = at_angles(theta, 0);
          const Direction up = at_angles(theta - pi / 2, 0);  // towards the normal, across the specular direction
          const Direction side{specular.y * up.z - specular.z * up.y, specular.z * up.x - specular.x * up.z,
                               specular.x * up.y - specular.y * up.x};
          const double r = radius * kDegrees;
          const double a = azimuth * kDegrees;
          const auto part = [&](double s, double u, double v) {
            return std::cos(r) * s + std::sin(r) * (std::cos(a) * u + std::sin(a) * v);
          };
          const Direction view{part(specular.x, up.x, side.x), part(specular.y, up.y, side.y),
                               part(specular.z, up.z, side.z)};
          if (view.z <= 0) continue;
          const double turn = -rotation * kDegrees;
          samples.push_back({theta, pi + turn, std::atan2(std::hypot(view.x, view.y), view.z),
                             std::atan2(view.y, view.x) + turn, value});
        }
      }
    }
  }
  return samples;
}

std::vector<Sample> alta_samples(const std::filesystem::path& path, const std::vector<std::string>& lines,
                                 std::size_t channel) {
  std::string inputs;
  bool has_cosine = false;
  std::vector<Sample> samples;
  for (const std::string& line : lines) {
    if (line.rfind("#PARAM_IN", 0) == 0) inputs = trimmed(line.substr(9));
    if (line.rfind("#PARAM_OUT", 0) == 0) has_cosine = trimmed(line.substr(10)) == "INV_STERADIAN_COSINE_FACTOR";
    if (!is_number_line(line)) continue;
    const auto row = numbers_of(line);
    Sample sample{};
    if (inputs == "ISOTROPIC_TL_TV_PROJ_DPHI") {
      sample = {row.at(0), 0, std::hypot(row.at(1), row.at(2)), std::atan2(row[2], row[1]), row.at(3 + channel)};
    } else if (inputs == "ISOTROPIC_TV_TL_DPHI") {
      sample = {row.at(1), 0, row.at(0), row.at(2), row.at(3 + channel)};
    } else {
      refuse(path, "inputs " + inputs);
    }
    if (has_cosine && std::cos(sample.theta_out) < 1e-3) continue;
    if (has_cosine) sample.value /= std::cos(sample.theta_out);
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace

MeasuredFile read_scatfun(const std::filesystem::path& path) {
  const std::string bytes = content_of(path);
  if (bytes.substr(0, 7) != "SCATFUN") refuse(path, "not a Fourier table");
  const auto header = array_at<std::uint32_t>(bytes, 8, 9);
  const std::size_t nodes = header[1];
  const std::size_t bases = header[5];
  auto table = std::make_shared<Fourier>();
  table->channels = header[4];
  std::size_t at = 64;
  for (const float mu : array_at<float>(bytes, at, nodes)) table->nodes.push_back(static_cast<double>(mu));
  // Behind the nodes: counts and positions of parameters, of tables with texture, and the cumulative densities.
  at += 4 * nodes + 4 * (std::size_t{header[7]} + header[8]) + 4 * bases * nodes * nodes;
  table->places = array_at<std::uint32_t>(bytes, at, 2 * nodes * nodes);
  at += 8 * nodes * nodes;
  table->coefficients = array_at<float>(bytes, at, header[2]);
  MeasuredFile file{stem_of(path),
                    [table](double theta_in, double theta_out, double delta_phi) {
                      return fourier_value(*table, theta_in, theta_out, delta_phi);
                    },
                    true, 0};
  file.channels = table->channels;
  return file;
}

MeasuredFile read_zernike(const std::filesystem::path& path, double wavelength) {
  auto sum = std::make_shared<Zernike>();
  for (const std::string& line : lines_of(content_of(path))) {
    if (!is_number_line(line)) continue;
    const auto row = numbers_of(line);
    if (row.size() != 8) refuse(path, "no coefficient: " + line);
    if (row[0] != 1 || row[1] != 1) continue;  // polarised
    const int n = static_cast<int>(row[2]);
    const int m = static_cast<int>(row[3]);
    const int l = static_cast<int>(row[5]);
    const double q = n == 0 || (n == m && l == 0) ? 4 : n == m || l == 0 ? 2 : 1;
    const double a = row[7] * std::pow(wavelength, row[6]) / (2 * pi) * std::sqrt((n + 1) * (m + 1) / q);
    sum->coefficients.push_back({n, m, l, a});
    for (const int order : {n, m}) {
      if (std::find(sum->orders.begin(), sum->orders.end(), std::pair{order, l}) == sum->orders.end()) {
        sum->orders.emplace_back(order, l);
      }
    }
  }
  for (const auto& [n, l] : sum->orders) sum->radials.push_back(radial(n, l));
  const auto place = [orders = sum->orders](int n, int l) {
    return static_cast<std::size_t>(std::find(orders.begin(), orders.end(), std::pair{n, l}) - orders.begin());
  };
  std::vector<std::array<std::size_t, 2>> places;
  for (const Coefficient& c : sum->coefficients) places.push_back({place(c.n, c.l), place(c.m, c.l)});
  MeasuredFile file{stem_of(path),
                    [sum, places](double theta_in, double theta_out, double delta_phi) {
                      const auto out = sum->at(theta_out);
                      const auto in = sum->at(theta_in);
                      double f = 0;
                      for (std::size_t k = 0; k < places.size(); ++k) {
                        const auto [n, m] = places[k];
                        f += sum->coefficients[k].a * (in[n] * out[m] + in[m] * out[n]) *
                             std::cos(sum->coefficients[k].l * delta_phi);
                      }
                      return Rgb{f, f, f};
                    },
                    true, 0};
  file.channels = 1;
  return file;
}

bool depends_on_wavelength(const std::filesystem::path& path) {
  const auto lines = lines_of(content_of(path));
  return std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
    const auto row = numbers_of(line);
    return row.size() == 8 && row[6] != 0;
  });
}

MeasuredFile read_alta_slice(const std::filesystem::path& path) {
  const auto lines = lines_of(content_of(path));
  if (std::none_of(lines.begin(), lines.end(), [](const std::string& line) {
        return line.rfind("#PARAM_IN", 0) == 0 && trimmed(line.substr(9)) == "COS_TH";
      })) {
    refuse(path, "no slice over COS_TH");
  }
  std::vector<std::pair<double, Rgb>> slice;  // by theta_h
  for (const std::string& line : lines) {
    if (!is_number_line(line)) continue;
    const auto row = numbers_of(line);
    slice.push_back({std::acos(row.at(0)), {row.at(1), row.at(2), row.at(3)}});
  }
  std::sort(slice.begin(), slice.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return {stem_of(path),
          [slice](double theta_in, double theta_out, double delta_phi) {
            const Direction a = at_angles(theta_in, 0);
            const Direction b = at_angles(theta_out, delta_phi);
            const double theta = std::atan2(std::hypot(a.x + b.x, a.y + b.y), a.z + b.z);
            if (theta <= slice.front().first) return slice.front().second;
            if (theta >= slice.back().first) return slice.back().second;
            const auto above = std::upper_bound(slice.begin(), slice.end(), theta,
                                                [](double t, const auto& entry) { return t < entry.first; });
            const auto below = above - 1;
            const double share = (theta - below->first) / (above->first - below->first);
            Rgb value;
            for (std::size_t c = 0; c < 3; ++c) value[c] = (1 - share) * below->second[c] + share * above->second[c];
            return value;
          },
          true, 0};
}

std::size_t CellFile::cell_at(double theta, double phi) const {
  std::size_t first = 0;
  for (const Ring& ring : rings) {
    if (theta < ring.high) {
      const double turn = phi / (2 * pi) * static_cast<double>(ring.count) + 0.5;
      const double whole = std::floor(turn / static_cast<double>(ring.count)) * static_cast<double>(ring.count);
      return first + static_cast<std::size_t>(turn - whole) % ring.count;
    }
    first += ring.count;
  }
  throw std::runtime_error("an angle beyond the horizon");
}

CellFile read_klems(const std::filesystem::path& path) {
  const std::string xml = content_of(path);
  // The full basis.
  const std::array<double, 10> bounds{0, 5, 15, 25, 35, 45, 55, 65, 75, 90};
  const std::array<std::size_t, 9> counts{1, 8, 16, 20, 24, 24, 24, 16, 12};
  CellFile file;
  file.name = stem_of(path);
  std::vector<std::size_t> opposite;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    file.rings.push_back({bounds[r] * kDegrees, bounds[r + 1] * kDegrees, counts[r]});
    const std::size_t first = file.measure.size();
    for (std::size_t j = 0; j < counts[r]; ++j) {
      file.measure.push_back(
          pi * (std::pow(std::cos(bounds[r] * kDegrees), 2) - std::pow(std::cos(bounds[r + 1] * kDegrees), 2)) /
          static_cast<double>(counts[r]));
      opposite.push_back(first + (j + counts[r] / 2) % counts[r]);
    }
  }
  std::size_t at = 0;
  const std::string order = trimmed(text_after(xml, "IncidentDataStructure", at));
  if (order != "Columns" && order != "Rows") refuse(path, "no matrix");
  const std::size_t n = file.measure.size();
  for (const Block& block : reflection_of(path, xml)) {
    const auto numbers = numbers_of(block.data);
    if (numbers.size() != n * n) refuse(path, "not on the full basis");
    std::vector<double> values(n * n);
    for (std::size_t o = 0; o < n; ++o) {
      for (std::size_t i = 0; i < n; ++i) {
        // The file has incident light by where it goes to.
        values[opposite[i] * n + o] = order == "Columns" ? numbers[o * n + i] : numbers[i * n + o];
      }
    }
    file.channels.push_back(block.channel);
    file.values.push_back(values);
  }
  return file;
}

double albedo(const CellFile& file, std::size_t channel, std::size_t in) {
  double sum = 0;
  const std::size_t n = file.measure.size();
  for (std::size_t o = 0; o < n; ++o) sum += file.values[channel][in * n + o] * file.measure[o];
  return sum;
}

double mean_albedo(const CellFile& file, std::size_t channel) {
  double sum = 0;
  for (std::size_t i = 0; i < file.measure.size(); ++i) sum += file.measure[i] * albedo(file, channel, i) / pi;
  return sum;
}

double product(const CellFile& f, const CellFile& g, std::size_t channel, double theta_max) {
  std::size_t n = 0;
  for (const auto& ring : f.rings) {
    if (ring.high <= theta_max + 1e-9) n += ring.count;
  }
  const std::size_t all = f.measure.size();
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t o = 0; o < n; ++o) {
      sum += f.measure[i] * f.measure[o] * f.values[channel][i * all + o] * g.values[channel][i * all + o];
    }
  }
  return sum;
}

CellFile self_composition(const CellFile& file) {
  CellFile composed = file;
  const std::size_t n = file.measure.size();
  for (std::size_t c = 0; c < file.values.size(); ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t o = 0; o < n; ++o) {
        double sum = 0;
        for (std::size_t x = 0; x < n; ++x) {
          sum += file.values[c][i * n + x] * file.measure[x] * file.values[c][x * n + o];
        }
        composed.values[c][i * n + o] = sum;
      }
    }
  }
  return composed;
}

RingFile read_tensor_tree3(const std::filesystem::path& path) {
  const std::string xml = content_of(path);
  std::size_t at = 0;
  if (trimmed(text_after(xml, "IncidentDataStructure", at)) != "TensorTree3") refuse(path, "no tree of 3 dimensions");
  std::string data = reflection_of(path, xml).front().data;
  std::string spaced;
  for (const char letter : data) {
    if (letter == '{' || letter == '}') {
      spaced += std::string(" ") + letter + " ";
    } else {
      spaced += letter == ',' ? ' ' : letter;
    }
  }
  std::istringstream stream(spaced);
  const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
  std::size_t word = 0;
  const Node root = node_of(words, word);
  RingFile file;
  file.name = stem_of(path);
  file.side = std::size_t{1} << level_of(root);
  file.rings = std::max<std::size_t>(file.side / 2, 1);
  const auto middle = [&](std::size_t k) { return (static_cast<double>(k) + 0.5) / static_cast<double>(file.side); };
  for (std::size_t r = 0; r < file.rings; ++r) {
    // Dimension 0 is 1/2 - 1/2 sin theta: from the middle downwards.
    const double sine = (static_cast<double>(r) + 0.5) / static_cast<double>(file.rings);
    for (std::size_t x = 0; x < file.side; ++x) {
      for (std::size_t y = 0; y < file.side; ++y) {
        file.values.push_back(value_at(root, {0.5 - 0.5 * sine, middle(x), middle(y)}));
      }
    }
  }
  return file;
}

double albedo(const RingFile& file, double theta_in) {
  const auto ring =
      std::min(static_cast<std::size_t>(std::sin(theta_in) * static_cast<double>(file.rings)), file.rings - 1);
  const std::size_t cells = file.side * file.side;
  double sum = 0;
  for (std::size_t k = 0; k < cells; ++k) sum += file.values[ring * cells + k];
  return sum * pi / static_cast<double>(cells);
}

namespace {

/// Projected solid angle of a ring of the light.
double ring_measure(const RingFile& file, std::size_t ring) {
  const auto sine = [&](std::size_t k) { return static_cast<double>(k) / static_cast<double>(file.rings); };
  return pi * (std::pow(sine(ring + 1), 2) - std::pow(sine(ring), 2));
}

}  // namespace

double mean_albedo(const RingFile& file) {
  double sum = 0;
  for (std::size_t r = 0; r < file.rings; ++r) {
    const double theta = std::asin((static_cast<double>(r) + 0.5) / static_cast<double>(file.rings));
    sum += ring_measure(file, r) * albedo(file, theta) / pi;
  }
  return sum;
}

double squared_norm(const RingFile& file) {
  const std::size_t cells = file.side * file.side;
  double sum = 0;
  for (std::size_t r = 0; r < file.rings; ++r) {
    for (std::size_t k = 0; k < cells; ++k) {
      sum += ring_measure(file, r) * pi / static_cast<double>(cells) * std::pow(file.values[r * cells + k], 2);
    }
  }
  return sum;
}

std::vector<Sample> read_samples(const std::filesystem::path& path, std::size_t channel) {
  const auto lines = lines_of(content_of(path));
  const auto has = [&](const std::string& begin) {
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.rfind(begin, 0) == 0; });
  };
  if (path.extension() == ".brdf") return cornell_samples(lines, channel);
  if (has("lambda,thetai")) return nist_samples(lines, channel);
  if (has("src_z")) return brf_samples(lines, channel);
  if (has("type bsdf_data")) return fred_samples(lines);
  if (has("ScatterRadial")) return zemax_samples(lines);
  if (has("#PARAM_IN")) return alta_samples(path, lines, channel);
  refuse(path, "no samples that are known");
}

std::vector<Sample> lonely(const std::vector<Sample>& samples, bool is_isotropic, double distance, std::size_t most) {
  // Both directions of a sample and of what counts as the same, as vectors.
  const auto images_of = [&](const Sample& sample) {
    std::vector<std::array<Direction, 2>> images;
    const double start = is_isotropic ? sample.phi_in : 0;
    const double delta_phi = sample.phi_out - sample.phi_in;
    const Direction in = at_angles(sample.theta_in, sample.phi_in - start);
    const Direction out = at_angles(sample.theta_out, sample.phi_out - start);
    images.push_back({in, out});
    if (!is_isotropic) {
      images.push_back({out, in});
      return images;
    }
    images.push_back({in, at_angles(sample.theta_out, -delta_phi)});
    images.push_back({at_angles(sample.theta_out, 0), at_angles(sample.theta_in, delta_phi)});
    images.push_back({at_angles(sample.theta_out, 0), at_angles(sample.theta_in, -delta_phi)});
    return images;
  };
  const auto gap = [](const Direction& a, const Direction& b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
  };
  std::vector<Sample> alone;
  std::vector<std::array<Direction, 2>> places;
  for (const Sample& sample : samples) places.push_back(images_of(sample).front());
  const std::size_t step = std::max<std::size_t>(1, samples.size() / most);
  for (std::size_t k = 0; k < samples.size(); k += step) {
    // At the normal azimuths are all the same.
    if (is_isotropic && std::min(samples[k].theta_in, samples[k].theta_out) < distance) continue;
    bool is_alone = true;
    for (const auto& image : images_of(samples[k])) {
      for (std::size_t j = 0; j < samples.size() && is_alone; ++j) {
        is_alone = j == k || gap(image[0], places[j][0]) > distance || gap(image[1], places[j][1]) > distance;
      }
    }
    if (is_alone) alone.push_back(samples[k]);
  }
  return alone;
}

}  // namespace lobe::reference
