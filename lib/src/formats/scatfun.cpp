// Series of cosines over a grid of polar angles, of layered materials and renderers.
// Source: Jakob, d'Eon, Jakob and Marschner 2014 ("A comprehensive framework for rendering layered materials"); layout
// and interpolation of its implementation layerlab, and of pbrt-v3.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "formats/byte_reader.hpp"
#include "formats/format.hpp"
#include "formats/scatfun_writer.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr double kLeastCosine = 1e-9;  // the series is divided by the light's

/// Where the coefficients a_k of a pair of nodes begin, by channel one after the other, and how many a channel has.
struct Series {
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
};

/// f |mu_i| = sum a_k cos(k phi), mu = cos theta of the directions in which light travels: light from above has mu_i <
/// 0, and what is reflected mu_o > 0. phi = 0 is straight on, the mirror side.
struct Table {
  FileBytes file;
  std::size_t coefficients = 0;     // where they begin, 32-bit
  std::vector<double> nodes = {};   // of mu, rising; 0 twice
  std::vector<Series> series = {};  // outgoing nodes x incident nodes
  std::size_t channels = 1;
  std::size_t longest = 0;

  [[nodiscard]] const Series& at(std::size_t in, std::size_t out) const { return series[out * nodes.size() + in]; }
  [[nodiscard]] double coefficient(std::size_t index) const {
    return static_cast<double>(number_at<float>(file.content(), coefficients + index * sizeof(float)));
  }
};

/// Cubic interpolation with slopes from the neighbouring nodes (Catmull-Rom), one-sided at the ends: the values of four
/// nodes.
struct Spline {
  std::size_t first = 0;  // node of weight[0], plus 1
  std::array<double, 4> weight{};
};

Spline spline_at(std::span<const double> nodes, double mu) {
  const double x = std::clamp(mu, nodes.front(), nodes.back());
  const auto above = std::ranges::upper_bound(nodes, x) - nodes.begin();
  const std::size_t i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(nodes) - 2));
  const double width = nodes[i + 1] - nodes[i];
  const double t = (x - nodes[i]) / width;
  const double slope_before = t * (1 - t) * (1 - t) * width;  // weights of the slopes at both ends
  const double slope_after = t * t * (t - 1) * width;
  Spline spline{i, {0, (1 - t) * (1 - t) * (1 + 2 * t), t * t * (3 - 2 * t), 0}};
  const auto add_slope = [&](double slope, std::size_t from, std::size_t to) {
    const double per_value = slope / (nodes[to] - nodes[from]);
    spline.weight[to + 1 - i] += per_value;
    spline.weight[from + 1 - i] -= per_value;
  };
  add_slope(slope_before, i > 0 ? i - 1 : i, i + 1);
  add_slope(slope_after, i, i + 2 < nodes.size() ? i + 2 : i + 1);
  return spline;
}

/// sum a_k cos(k phi), by Clenshaw's recurrence.
double sum_of_cosines(std::span<const double> a, double cosine) {
  double next = 0;
  double after = 0;
  for (std::size_t k = a.size(); k-- > 1;) {
    const double now = a[k] + 2 * cosine * next - after;
    after = next;
    next = now;
  }
  return a.empty() ? 0 : a[0] + cosine * next - after;
}

/// The coefficients between the nodes, divided by |mu_i|: one vector for each channel.
std::vector<std::vector<double>> interpolated(const Table& table, double mu_in, double mu_out) {
  std::vector<std::vector<double>> a(table.channels, std::vector<double>(table.longest));
  const Spline in = spline_at(table.nodes, mu_in);
  const Spline out = spline_at(table.nodes, mu_out);
  for (std::size_t o = 0; o < 4; ++o) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double weight = in.weight[i] * out.weight[o] / std::abs(mu_in);
      if (weight == 0) continue;
      const Series& series = table.at(in.first + i - 1, out.first + o - 1);
      for (std::size_t c = 0; c < table.channels; ++c) {
        for (std::size_t k = 0; k < series.length; ++k) {
          a[c][k] += weight * table.coefficient(series.offset + c * series.length + k);
        }
      }
    }
  }
  return a;
}

/// \param side 1: light from above, -1: from below
BrdfValues evaluate(const Table& table, double side, std::span<const Directions> pairs) {
  BrdfValues values;
  values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(table.channels));
  std::vector<std::vector<double>> a;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [theta_in, theta_out, delta_phi, phi_in] = pairs[p];
    // Pairs usually come with the same polar angles one after the other.
    if (p == 0 || theta_in != pairs[p - 1].theta_in || theta_out != pairs[p - 1].theta_out) {
      a = interpolated(table, -side * std::max(std::cos(theta_in), kLeastCosine),
                       side * std::max(std::cos(theta_out), kLeastCosine));
    }
    auto row = values.value.row(static_cast<Eigen::Index>(p));
    for (std::size_t c = 0; c < table.channels; ++c) {
      row(static_cast<Eigen::Index>(c)) = sum_of_cosines(a[c], -std::cos(delta_phi));
    }
    if (table.channels == 3) {
      const double luminance = row(0);
      row(0) = row(1);
      row(1) = (luminance - kScatfunLuminance[0] * row(0) - kScatfunLuminance[2] * row(2)) / kScatfunLuminance[1];
    }
  }
  return values;
}

bool recognises(const FileBytes& head) {
  return head.content().starts_with(kScatfunMagic);
}

void check_nodes(const FileBytes& file, const std::vector<double>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool rises = i == 0 || nodes[i] > nodes[i - 1] || (nodes[i] == 0 && nodes[i - 1] == 0);
    if (!(std::abs(nodes[i]) <= 1) || !rises) {
      file.refuse_at(kScatfunHeader + i * sizeof(float),
                     fmt::format("node {}; expected cosines from -1 to 1, rising", nodes[i]));
    }
  }
  if (nodes.front() >= 0 || nodes.back() <= 0) file.refuse_at(kScatfunHeader, "nodes of one side only; expected both");
}

Table read_table(const FileBytes& file) {
  ByteReader reader(file, kScatfunMagic.size());
  if (reader.read<std::uint8_t>("the header") != 1) file.refuse_at(kScatfunMagic.size(), "no SCATFUN of version 1");
  std::array<std::uint32_t, 9> header{};
  for (auto& number : header) number = reader.read<std::uint32_t>("the header");
  const auto [flags, nodes, coefficients, longest, channels, bases, metadata, parameters, parameter_values] = header;
  (void)reader.bytes(kScatfunHeader - reader.offset(), "the header");
  if (flags != 1) file.refuse_at(8, fmt::format("flags {}; expected 1, plain series", flags));
  if (nodes < 2) file.refuse_at(12, fmt::format("{} nodes; expected at least 2", nodes));
  if (channels != 1 && channels != 3) file.refuse_at(24, fmt::format("{} channels; expected 1 or 3", channels));
  if (bases != 1 || parameters != 0 || parameter_values != 0) {
    file.refuse_at(28,
                   fmt::format("{} bases of {} texture parameters; expected a single reflectance", bases, parameters));
  }
  // Nodes, their distribution function and places of series, coefficients.
  const std::uint64_t squares = std::uint64_t{nodes} * nodes;
  const bool fits = squares <= file.size() / 12 && kScatfunHeader + 12 * squares + std::uint64_t{4} * nodes +
                                                           std::uint64_t{4} * coefficients + metadata ==
                                                       file.size();
  if (!fits) {
    file.refuse_at(12, fmt::format("{} nodes and {} coefficients do not make a file of {} bytes", nodes, coefficients,
                                   file.size()));
  }

  Table table{file};
  table.channels = channels;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    table.nodes.push_back(static_cast<double>(reader.read<float>("the nodes")));
  }
  check_nodes(file, table.nodes);
  (void)reader.bytes(4 * squares, "the distribution function");
  table.series.resize(squares);
  for (Series& series : table.series) {
    series = reader.read<Series>("the table of series");
    const std::uint64_t end = series.offset + std::uint64_t{series.length} * channels;
    if (series.length > longest || end > coefficients) {
      file.refuse_at(reader.offset() - 8, fmt::format("{} coefficients from {} on; expected up to {} of {}",
                                                      series.length, series.offset, longest, coefficients));
    }
    table.longest = std::max<std::size_t>(table.longest, series.length);
  }
  table.coefficients = reader.offset();
  for (std::size_t i = 0; i < coefficients; ++i) {
    if (!std::isfinite(table.coefficient(i))) {
      file.refuse_at(table.coefficients + i * sizeof(float), "a coefficient that is not finite");
    }
  }
  return table;
}

/// Series of one kind, by the signs of mu_i and mu_o, that are there, and those of them whose mean is negative.
struct Census {
  std::size_t count = 0;
  std::size_t negative = 0;
};

Census census(const Table& table, double sign_in, double sign_out) {
  Census found;
  for (std::size_t o = 0; o < table.nodes.size(); ++o) {
    for (std::size_t i = 0; i < table.nodes.size(); ++i) {
      if (table.nodes[i] * sign_in <= 0 || table.nodes[o] * sign_out <= 0 || table.at(i, o).length == 0) continue;
      ++found.count;
      if (table.coefficient(table.at(i, o).offset) < 0) ++found.negative;
    }
  }
  return found;
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  if (!options.component.empty() && options.component != "reflection front" && options.component != "reflection back") {
    throw ArgumentError(fmt::format("{} has no '{}'; known: reflection front, reflection back", file.path().string(),
                                    options.component));
  }
  const double side = options.component == "reflection back" ? -1 : 1;
  const auto table = std::make_shared<const Table>(read_table(file));
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kScatfunFormat.title;
  brdf.conventions =
      "f times the light's cosine, in sr^-1, as series of cosines of the azimuth, azimuth 0 being the mirror side; "
      "cubic "
      "splines in the cosines of both angles; beyond the last angles before the horizon values fall to 0 with the "
      "viewer's "
      "cosine; negative values of series are kept";
  brdf.is_bilateral = true;
  brdf.channels =
      table->channels == 3 ? std::vector<std::string>{"red", "green", "blue"} : std::vector<std::string>{"value"};
  const auto [count, negative] = census(*table, -side, side);
  if (count == 0) brdf.remarks.emplace_back("nothing is reflected on this side");
  if (negative > 0) {
    brdf.remarks.push_back(fmt::format("{} of {} means over azimuths are negative, and kept", negative, count));
  }
  if (census(*table, -side, -side).count > 0) brdf.remarks.emplace_back("transmission is left out");
  brdf.at = [table, side](std::span<const Directions> pairs) { return evaluate(*table, side, pairs); };
  return brdf;
}

}  // namespace

const Format kScatfunFormat{"scatfun",    "SCATFUN Fourier .bsdf (layerlab, pbrt)", recognises, read, false,
                            write_scatfun};

}  // namespace lobe
