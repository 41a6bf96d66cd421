#include "reference/measured_files.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <queue>
#include <random>
#include <stdexcept>

#include "reference/quadrature.hpp"

namespace lobe::reference {
namespace {

using std::numbers::pi;

struct Vec {
  double x, y, z;
};

Vec at_angles(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Vec half_of(const Vec& a, const Vec& b) {
  const Vec sum{a.x + b.x, a.y + b.y, a.z + b.z};
  const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  return {sum.x / length, sum.y / length, sum.z / length};
}

// ---------------------------------------------------------------------------------------------- neural encodings

struct Weights {
  std::array<double, 6 * 21> first;
  std::array<double, 21> first_bias;
  std::array<double, 21 * 21> second;
  std::array<double, 21> second_bias;
  std::array<double, 21 * 3> third;
  std::array<double, 3> third_bias;
};

void read_doubles(hid_t file, const std::string& name, double* to, std::size_t count) {
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (set < 0) throw std::runtime_error("no dataset " + name);
  const hid_t space = H5Dget_space(set);
  const bool fits = H5Sget_simple_extent_npoints(space) == static_cast<hssize_t>(count);
  const bool is_read = fits && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, to) >= 0;
  H5Sclose(space);
  H5Dclose(set);
  if (!is_read) throw std::runtime_error("dataset " + name + " is not what it should be");
}

/// y = x K + b, K row by row.
template <std::size_t In, std::size_t Out>
std::array<double, Out> layer(const std::array<double, In>& x, const std::array<double, In * Out>& kernel,
                              const std::array<double, Out>& bias) {
  std::array<double, Out> y = bias;
  for (std::size_t i = 0; i < In; ++i) {
    for (std::size_t o = 0; o < Out; ++o) y[o] += x[i] * kernel[i * Out + o];
  }
  return y;
}

template <std::size_t N>
std::array<double, N> rectified(std::array<double, N> x) {
  for (double& value : x) value = std::max(value, 0.0);
  return x;
}

Rgb neural_value(const Weights& w, double theta_in, double theta_out, double delta_phi) {
  const Vec light = at_angles(theta_in, 0);
  const Vec half = half_of(light, at_angles(theta_out, delta_phi));
  const double sine = std::hypot(half.x, half.y);
  const double cosine = half.z;
  const double phi = sine > 0 ? std::atan2(half.y, half.x) : 0;
  // Turned about the normal until the half-vector has the azimuth 0, then about y until it is the normal.
  const Vec turned{std::cos(phi) * light.x + std::sin(phi) * light.y, std::cos(phi) * light.y - std::sin(phi) * light.x,
                   light.z};
  const Vec difference{cosine * turned.x - sine * turned.z, turned.y, sine * turned.x + cosine * turned.z};
  const auto hidden =
      rectified(layer<6, 21>({sine, 0, cosine, difference.x, difference.y, difference.z}, w.first, w.first_bias));
  const auto out = layer<21, 3>(rectified(layer<21, 21>(hidden, w.second, w.second_bias)), w.third, w.third_bias);
  Rgb value;
  for (std::size_t c = 0; c < 3; ++c) value[c] = std::max(std::exp(out[c]) - 1, 0.0);
  return value;
}

// -------------------------------------------------------------------------------------------------- tensor files

struct Field {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

template <typename T>
T number_at(const std::string& bytes, std::size_t at) {
  if (at + sizeof(T) > bytes.size()) throw std::runtime_error("the file is cut");
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::map<std::string, Field> tensor_fields(const std::string& bytes) {
  if (bytes.substr(0, 12) != std::string("tensor_file\0", 12)) throw std::runtime_error("not a tensor file");
  std::map<std::string, Field> fields;
  std::size_t at = 14;
  const auto count = number_at<std::uint32_t>(bytes, at);
  at += 4;
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto length = number_at<std::uint16_t>(bytes, at);
    const std::string name = bytes.substr(at + 2, length);
    at += 2U + length;
    const auto dimensions = number_at<std::uint16_t>(bytes, at);
    const auto type = number_at<std::uint8_t>(bytes, at + 2);
    const auto offset = number_at<std::uint64_t>(bytes, at + 3);
    at += 11;
    Field field;
    std::size_t volume = 1;
    for (unsigned d = 0; d < dimensions; ++d, at += 8) {
      field.shape.push_back(number_at<std::uint64_t>(bytes, at));
      volume *= field.shape.back();
    }
    for (std::size_t i = 0; i < volume; ++i) {
      if (type == 10) field.values.push_back(number_at<float>(bytes, offset + 4 * i));
      if (type == 1) field.values.push_back(static_cast<float>(number_at<std::uint8_t>(bytes, offset + i)));
    }
    fields[name] = field;
  }
  return fields;
}

/// A grid of vertices over the unit square, [row][column], and its slices at the angles of the light.
struct Slices {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<std::vector<double>> of;  // [slice][row * columns + column]
};

/// The two slices about an angle and the share of the second.
struct Between {
  std::size_t first;
  std::size_t second;
  double share;
};

Between between(const std::vector<double>& angles, double angle) {
  if (angles.size() == 1 || angle <= angles.front()) return {0, 0, 0};
  if (angle >= angles.back()) return {angles.size() - 1, angles.size() - 1, 0};
  std::size_t k = 0;
  while (angles[k + 1] < angle) ++k;
  return {k, k + 1, (angle - angles[k]) / (angles[k + 1] - angles[k])};
}

double mixed(const std::vector<std::vector<double>>& slices, const Between& place, std::size_t at) {
  return (1 - place.share) * slices[place.first][at] + place.share * slices[place.second][at];
}

double bilinear(const Slices& grid, const Between& place, double x, double y) {
  const double column = std::clamp(x, 0.0, 1.0) * static_cast<double>(grid.columns - 1);
  const double row = std::clamp(y, 0.0, 1.0) * static_cast<double>(grid.rows - 1);
  const auto i = std::min(static_cast<std::size_t>(column), grid.columns - 2);
  const auto j = std::min(static_cast<std::size_t>(row), grid.rows - 2);
  const double a = column - static_cast<double>(i);
  const double b = row - static_cast<double>(j);
  const std::size_t corner = j * grid.columns + i;
  return (1 - b) * ((1 - a) * mixed(grid.of, place, corner) + a * mixed(grid.of, place, corner + 1)) +
         b * ((1 - a) * mixed(grid.of, place, corner + grid.columns) +
              a * mixed(grid.of, place, corner + grid.columns + 1));
}

struct Tensor {
  std::vector<double> thetas;
  Slices ndf, sigma, vndf;
  std::vector<std::vector<double>> along_row;  // integrals of vndf from the left, [slice][row * columns + column]
  std::vector<std::vector<double>> of_rows;    // integrals of whole rows from the bottom, [slice][row]
  std::array<Slices, 3> rgb;
  bool has_jacobian = false;
};

Slices slices_of(const Field& field, std::size_t count, std::size_t stride, std::size_t first) {
  Slices slices;
  slices.rows = field.shape[field.shape.size() - 2];
  slices.columns = field.shape.back();
  const std::size_t area = slices.rows * slices.columns;
  for (std::size_t s = 0; s < count; ++s) {
    const auto begin = field.values.begin() + static_cast<std::ptrdiff_t>((s * stride + first) * area);
    slices.of.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(area));
  }
  return slices;
}

void integrate_slices(Tensor& tensor) {
  const std::size_t rows = tensor.vndf.rows;
  const std::size_t columns = tensor.vndf.columns;
  for (auto& v : tensor.vndf.of) {
    std::vector<double> along(rows * columns, 0.0);
    std::vector<double> of_rows(rows, 0.0);
    for (std::size_t j = 0; j < rows; ++j) {
      for (std::size_t i = 1; i < columns; ++i) {
        along[j * columns + i] = along[j * columns + i - 1] + (v[j * columns + i - 1] + v[j * columns + i]) / 2;
      }
      if (j > 0) {
        of_rows[j] = of_rows[j - 1] + (along[j * columns - 1] + along[(j + 1) * columns - 1]) / 2;
      }
    }
    const double all = of_rows.back();
    for (double& value : v) value /= all;
    for (double& value : along) value /= all;
    for (double& value : of_rows) value /= all;
    tensor.along_row.push_back(along);
    tensor.of_rows.push_back(of_rows);
  }
}

/// From a place in the square of half-vectors to the one of the samples: the conditional integral along the row that is
/// interpolated there, over the whole of it, and the marginal integral.
std::pair<double, double> sample_place(const Tensor& tensor, const Between& place, double x, double y) {
  const std::size_t n = tensor.vndf.columns;
  const std::size_t m = tensor.vndf.rows;
  const double column = std::clamp(x, 0.0, 1.0) * static_cast<double>(n - 1);
  const double row = std::clamp(y, 0.0, 1.0) * static_cast<double>(m - 1);
  const auto i = std::min(static_cast<std::size_t>(column), n - 2);
  const auto j = std::min(static_cast<std::size_t>(row), m - 2);
  const double a = column - static_cast<double>(i);
  const double b = row - static_cast<double>(j);
  const auto v = [&](std::size_t r, std::size_t c) { return mixed(tensor.vndf.of, place, r * n + c); };
  const auto along = [&](std::size_t r, std::size_t c) { return mixed(tensor.along_row, place, r * n + c); };
  const double left = (1 - b) * v(j, i) + b * v(j + 1, i);
  const double right = (1 - b) * v(j, i + 1) + b * v(j + 1, i + 1);
  const double lower = along(j, n - 1);
  const double upper = along(j + 1, n - 1);
  const double so_far = a * (left + a * (right - left) / 2) + (1 - b) * along(j, i) + b * along(j + 1, i);
  const double sample_x = so_far / ((1 - b) * lower + b * upper);
  const double sample_y = b * (lower + b * (upper - lower) / 2) + mixed(tensor.of_rows, place, j);
  return {sample_x, sample_y};
}

Rgb tensor_value(const Tensor& tensor, double theta_in, double theta_out, double delta_phi) {
  const Vec light = at_angles(theta_in, 0);
  const Vec half = half_of(light, at_angles(theta_out, delta_phi));
  const double theta_half = std::atan2(std::hypot(half.x, half.y), half.z);
  const double phi_half = std::atan2(half.y, half.x);  // the light's azimuth is 0
  const auto unit_angle = [](double theta) { return std::sqrt(2 * theta / pi); };
  const double turn = (phi_half + pi) / (2 * pi);
  const double around = turn - std::floor(turn);
  const Between place = between(tensor.thetas, theta_in);
  const auto [x, y] = sample_place(tensor, place, unit_angle(theta_half), around);
  double scale = 1 / std::cos(theta_out);
  if (tensor.has_jacobian) {
    const Between alone{0, 0, 0};
    scale *= bilinear(tensor.ndf, alone, unit_angle(theta_half), around) /
             (4 * bilinear(tensor.sigma, alone, unit_angle(theta_in), 0.5));
  }
  Rgb value;
  for (std::size_t c = 0; c < 3; ++c) value[c] = scale * bilinear(tensor.rgb[c], place, x, y);
  return value;
}

// ----------------------------------------------------------------------------------------------------- integrals

struct Panel {
  double a, b;
  Rgb value, error;
  [[nodiscard]] double worst() const { return *std::max_element(error.begin(), error.end()); }
};

/// g may be a sum that has an error of its own, which is handed through.
Panel panel_of(const std::function<RgbIntegral(double)>& g, double a, double b) {
  static const GaussRule coarse = gauss_legendre(7);
  static const GaussRule fine = gauss_legendre(15);
  Panel panel{a, b, {}, {}};
  Rgb other{};
  Rgb inner{};
  const double centre = (a + b) / 2;
  const double reach = (b - a) / 2;
  for (std::size_t k = 0; k < fine.nodes.size(); ++k) {
    const RgbIntegral found = g(centre + reach * fine.nodes[k]);
    for (std::size_t c = 0; c < 3; ++c) {
      panel.value[c] += reach * fine.weights[k] * found.value[c];
      inner[c] += reach * fine.weights[k] * found.error[c];
    }
  }
  for (std::size_t k = 0; k < coarse.nodes.size(); ++k) {
    const RgbIntegral found = g(centre + reach * coarse.nodes[k]);
    for (std::size_t c = 0; c < 3; ++c) other[c] += reach * coarse.weights[k] * found.value[c];
  }
  for (std::size_t c = 0; c < 3; ++c) panel.error[c] = std::abs(panel.value[c] - other[c]) + inner[c];
  return panel;
}

RgbIntegral adaptive(const std::function<RgbIntegral(double)>& g, double a, double b, std::vector<double> cuts,
                     double tolerance, std::size_t most) {
  cuts.insert(cuts.end(), {a, b});
  for (double& cut : cuts) cut = std::clamp(cut, a, b);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  const auto is_better = [](const Panel& p, const Panel& q) { return p.worst() < q.worst(); };
  std::priority_queue<Panel, std::vector<Panel>, decltype(is_better)> panels(is_better);
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) panels.push(panel_of(g, cuts[k], cuts[k + 1]));
  double left = 0;
  for (auto copy = panels; !copy.empty(); copy.pop()) left += copy.top().worst();
  while (left > tolerance && panels.size() < most) {
    const Panel worst = panels.top();
    panels.pop();
    left -= worst.worst();
    const double middle = (worst.a + worst.b) / 2;
    for (const Panel& part : {panel_of(g, worst.a, middle), panel_of(g, middle, worst.b)}) {
      left += part.worst();
      panels.push(part);
    }
  }
  RgbIntegral sum;
  for (; !panels.empty(); panels.pop()) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum.value[c] += panels.top().value[c];
      sum.error[c] += panels.top().error[c];
    }
  }
  return sum;
}

/// Ends of the first panels: distances from the mirror direction, and steps that do not let kinks of networks hide.
std::vector<double> about(double peak) {
  constexpr int kSteps = 24;  // of a turn
  std::vector<double> cuts{peak};
  for (int k = 0; k < kSteps; ++k) cuts.push_back(2 * pi * k / kSteps);
  for (double distance = 0.002; distance < pi; distance *= 4) {
    cuts.push_back(peak - distance);
    cuts.push_back(peak + distance);
  }
  return cuts;
}

}  // namespace

MeasuredFile read_nbrdf(const std::filesystem::path& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) throw std::runtime_error("cannot open " + path.string());
  auto weights = std::make_shared<Weights>();
  const auto read = [&](int k, const char* part, double* to, std::size_t count) {
    const std::string name = "dense_" + std::to_string(k);
    read_doubles(file, name + "/" + name + "/" + part + ":0", to, count);
  };
  read(1, "kernel", weights->first.data(), weights->first.size());
  read(1, "bias", weights->first_bias.data(), weights->first_bias.size());
  read(2, "kernel", weights->second.data(), weights->second.size());
  read(2, "bias", weights->second_bias.data(), weights->second_bias.size());
  read(3, "kernel", weights->third.data(), weights->third.size());
  read(3, "bias", weights->third_bias.data(), weights->third_bias.size());
  H5Fclose(file);
  return {path.stem().string(),
          [weights](double theta_in, double theta_out, double delta_phi) {
            return neural_value(*weights, theta_in, theta_out, delta_phi);
          },
          false, 0};
}

MeasuredFile read_rgl(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const auto fields = tensor_fields(bytes);
  const auto field = [&](const std::string& name) -> const Field& {
    const auto found = fields.find(name);
    if (found == fields.end()) throw std::runtime_error("no field " + name);
    return found->second;
  };
  if (field("phi_i").values.size() > 2) throw std::runtime_error("the file is anisotropic");
  auto tensor = std::make_shared<Tensor>();
  const auto& angles = field("theta_i").values;
  tensor->thetas.assign(angles.begin(), angles.end());
  const std::size_t count = angles.size();
  tensor->ndf = slices_of(field("ndf"), 1, 1, 0);
  tensor->sigma = slices_of(field("sigma"), 1, 1, 0);
  tensor->vndf = slices_of(field("vndf"), count, 1, 0);
  for (std::size_t c = 0; c < 3; ++c) tensor->rgb[c] = slices_of(field("rgb"), count, 3, c);
  tensor->has_jacobian = field("jacobian").values.front() != 0;
  integrate_slices(*tensor);
  return {path.stem().string(),
          [tensor](double theta_in, double theta_out, double delta_phi) {
            return tensor_value(*tensor, theta_in, theta_out, delta_phi);
          },
          false, tensor->thetas.back()};
}

RgbIntegral integrate(const std::function<Rgb(double)>& g, double a, double b, std::vector<double> cuts,
                      double tolerance, std::size_t most) {
  return adaptive([&](double x) { return RgbIntegral{g(x), {}}; }, a, b, std::move(cuts), tolerance, most);
}

RgbIntegral albedo(const MeasuredFile& file, double theta_in, double tolerance, double theta_max) {
  // Panels about the mirror direction, in azimuth as seen from the normal.
  const double stretch = 1 / std::max(std::sin(theta_in), 0.02);
  std::vector<double> around = about(0);
  for (double& cut : around) cut = pi + std::clamp(cut * stretch, -pi, pi);
  const auto ring = [&](double theta_out) {
    const auto g = [&](double delta_phi) { return file.f(theta_in, theta_out, delta_phi); };
    // dw cos: what the outer integral takes of an error here is at most its length times half.
    RgbIntegral sum = integrate(g, file.is_even ? pi : 0, 2 * pi, around, tolerance / 2, 400);
    const double weight = (file.is_even ? 2 : 1) * std::sin(theta_out) * std::cos(theta_out);
    for (std::size_t c = 0; c < 3; ++c) {
      sum.value[c] *= weight;
      sum.error[c] *= weight;
    }
    return sum;
  };
  return adaptive(ring, 0, theta_max, about(theta_in), tolerance, 400);
}

MeasuredFile luminance_of(const MeasuredFile& file) {
  MeasuredFile single = file;
  single.f = [f = file.f](double theta_in, double theta_out, double delta_phi) {
    const Rgb rgb = f(theta_in, theta_out, delta_phi);
    const double value = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    return Rgb{value, value, value};
  };
  return single;
}

namespace {

/// Ends of panels that shrink towards two places.
std::vector<double> about_both(double a, double b, double finest) {
  std::vector<double> cuts;
  for (const double peak : {a, b}) {
    cuts.push_back(peak);
    for (double distance = finest; distance < pi; distance *= 4) {
      cuts.push_back(peak - distance);
      cuts.push_back(peak + distance);
    }
  }
  return cuts;
}

RgbIntegral scaled(RgbIntegral sum, double factor) {
  for (std::size_t c = 0; c < 3; ++c) {
    sum.value[c] *= factor;
    sum.error[c] *= factor;
  }
  return sum;
}

}  // namespace

RgbIntegral self_composition(const MeasuredFile& file, double theta_in, double theta_out, double delta_phi,
                             double tolerance) {
  constexpr double kFinest = 0.01;
  // Azimuths from the mirror direction of L, over a turn.
  const double of_v = std::remainder(delta_phi, 2 * pi);
  const double stretch = 1 / std::max({std::sin(theta_in), std::sin(theta_out), 0.02});
  std::vector<double> around = about_both(0, of_v, kFinest * stretch);
  const auto ring = [&](double theta) {
    const auto g = [&](double turn) {
      const double phi = turn + pi;
      Rgb product = file.f(theta_in, theta, phi);
      const Rgb other = file.f(theta, theta_out, delta_phi - phi);
      for (std::size_t c = 0; c < 3; ++c) product[c] *= other[c];
      return product;
    };
    return scaled(integrate(g, -pi, pi, around, tolerance / 2, 200), std::sin(theta) * std::cos(theta));
  };
  return adaptive(ring, 0, pi / 2, about_both(theta_in, theta_out, kFinest), tolerance, 100);
}

RgbIntegral self_composition_mean(const MeasuredFile& file, double tolerance) {
  MeasuredFile turned = file;
  turned.f = [f = file.f](double theta_in, double theta_out, double delta_phi) {
    return f(theta_out, theta_in, -delta_phi);
  };
  const auto g = [&](double theta) {
    const RgbIntegral in = albedo(file, theta, tolerance / 2);
    const RgbIntegral out = albedo(turned, theta, tolerance / 2);
    RgbIntegral product;
    for (std::size_t c = 0; c < 3; ++c) {
      product.value[c] = in.value[c] * out.value[c];
      product.error[c] = in.error[c] * std::abs(out.value[c]) + std::abs(in.value[c]) * out.error[c];
    }
    return scaled(product, 2 * std::sin(theta) * std::cos(theta));
  };
  return adaptive(g, 0, pi / 2, {0.7, 1.2, 1.45}, tolerance, 6);
}

namespace {

double square_by_series(const MeasuredFile& file, std::size_t nodes) {
  using Complex = std::complex<double>;
  const GaussRule rule = gauss_legendre(static_cast<int>(nodes));
  const std::size_t azimuths = 2 * nodes;
  std::vector<double> theta;
  std::vector<double> weight;
  for (std::size_t k = 0; k < nodes; ++k) {
    theta.push_back(pi / 4 * (1 + static_cast<double>(rule.nodes[k])));
    weight.push_back(pi / 4 * static_cast<double>(rule.weights[k]) * std::sin(theta[k]) * std::cos(theta[k]));
  }
  std::vector<Complex> turns;
  for (std::size_t k = 0; k < azimuths; ++k) {
    turns.push_back(std::polar(1.0 / static_cast<double>(azimuths),
                               -2 * pi * static_cast<double>(k) / static_cast<double>(azimuths)));
  }
  // Coefficients by order, in and out; those of negative orders are their conjugates.
  std::vector<std::vector<Complex>> series(nodes + 1, std::vector<Complex>(nodes * nodes));
  std::vector<double> values(azimuths);
  for (std::size_t i = 0; i < nodes; ++i) {
    for (std::size_t j = 0; j < nodes; ++j) {
      for (std::size_t k = 0; k < azimuths; ++k) {
        values[k] = file.f(theta[i], theta[j], 2 * pi * static_cast<double>(k) / static_cast<double>(azimuths))[0];
      }
      for (std::size_t m = 0; m <= nodes; ++m) {
        Complex sum = 0;
        for (std::size_t k = 0; k < azimuths; ++k) sum += values[k] * turns[m * k % azimuths];
        series[m][i * nodes + j] = sum;
      }
    }
  }
  double square = 0;
  for (std::size_t m = 0; m <= nodes; ++m) {
    const auto& f = series[m];
    for (std::size_t i = 0; i < nodes; ++i) {
      std::vector<Complex> row(nodes);
      for (std::size_t x = 0; x < nodes; ++x) {
        const Complex left = 2 * pi * weight[x] * f[i * nodes + x];
        for (std::size_t j = 0; j < nodes; ++j) row[j] += left * f[x * nodes + j];
      }
      for (std::size_t j = 0; j < nodes; ++j) {
        const double both_signs = m == 0 || m == nodes ? 1 : 2;
        square += 4 * pi * pi * both_signs * weight[i] * weight[j] * std::norm(row[j]);
      }
    }
  }
  return square;
}

}  // namespace

RgbIntegral self_composition_square(const MeasuredFile& file, std::size_t nodes) {
  RgbIntegral square;
  square.value[0] = square_by_series(file, nodes);
  square.error[0] = std::abs(square.value[0] - square_by_series(file, 2 * nodes / 3));
  return square;
}

PairMeans pair_means(const MeasuredFile& file, double theta_max, double width, std::size_t points, std::size_t shifts,
                     unsigned seed, const MeasuredFile* other) {
  // The density of V: an equal mixture of the projected solid angle and of lobes about the mirror direction of two
  // widths, which are those of half-vectors whose squared tangent is exponential (Beckmann's).
  const std::array<double, 2> widths{width, std::min(4 * width, 0.5)};
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Rgb> albedos;
  std::vector<Rgb> squares;
  // The generalised golden ratio of four dimensions (Roberts' R4 sequence).
  constexpr double kRoot = 1.1673039782614187;
  const double largest = std::sin(theta_max) * std::sin(theta_max);
  for (std::size_t shift = 0; shift < shifts; ++shift) {
    std::array<double, 4> start{};
    for (double& u : start) u = uniform(engine);
    Rgb albedo{};
    Rgb square{};
    for (std::size_t k = 0; k < points; ++k) {
      std::array<double, 4> u{};
      double step = 1;
      for (std::size_t d = 0; d < 4; ++d) {
        step /= kRoot;
        const double place = start[d] + step * static_cast<double>(k + 1);
        u[d] = place - std::floor(place);
      }
      const double theta_in = std::asin(std::sqrt(largest * u[0]));
      const Vec light = at_angles(theta_in, 0);
      Vec view{};
      const auto which = std::min(static_cast<std::size_t>(3 * u[3]), std::size_t{2});
      const double phi = 2 * pi * u[2];
      if (which == 0) {
        view = at_angles(std::asin(std::sqrt(u[1])), phi);
      } else {
        const double m = widths[which - 1];
        const double tangent = m * std::sqrt(-std::log1p(-u[1]));
        const double cosine = 1 / std::sqrt(1 + tangent * tangent);
        const Vec half{tangent * cosine * std::cos(phi), tangent * cosine * std::sin(phi), cosine};
        const double twice = 2 * (light.x * half.x + light.y * half.y + light.z * half.z);
        view = {twice * half.x - light.x, twice * half.y - light.y, twice * half.z - light.z};
      }
      if (view.z <= std::cos(theta_max)) continue;
      const Vec half = half_of(light, view);
      const double tangent2 = (half.x * half.x + half.y * half.y) / (half.z * half.z);
      const double l_dot_h = light.x * half.x + light.y * half.y + light.z * half.z;
      double density = view.z / pi;
      for (const double m : widths) {
        const double of_half = std::exp(-tangent2 / (m * m)) / (pi * m * m * std::pow(half.z, 3));
        density += of_half / (4 * l_dot_h);
      }
      const double theta_out = std::atan2(std::hypot(view.x, view.y), view.z);
      const Rgb f = file.f(theta_in, theta_out, std::atan2(view.y, view.x));
      const Rgb g = other == nullptr ? f : other->f(theta_in, theta_out, std::atan2(view.y, view.x));
      const double weight = pi * largest * view.z / (density / 3) / static_cast<double>(points);
      for (std::size_t c = 0; c < 3; ++c) {
        albedo[c] += weight * f[c] / pi;
        square[c] += weight * f[c] * g[c];
      }
    }
    albedos.push_back(albedo);
    squares.push_back(square);
  }
  const auto summary = [&](const std::vector<Rgb>& all) {
    RgbIntegral result;
    for (std::size_t c = 0; c < 3; ++c) {
      for (const Rgb& one : all) result.value[c] += one[c] / static_cast<double>(shifts);
      for (const Rgb& one : all) result.error[c] += std::pow(one[c] - result.value[c], 2);
      result.error[c] = std::sqrt(result.error[c] / static_cast<double>(shifts * (shifts - 1)));
    }
    return result;
  };
  return {summary(albedos), summary(squares)};
}

}  // namespace lobe::reference
