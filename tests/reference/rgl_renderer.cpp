#include "reference/rgl_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

namespace lobe::reference {
namespace {

constexpr float kPi = 3.14159265358979F;
constexpr float kAlmostOne = 0x1.fffffep-1F;

/// The last node of an increasing function whose value is below a limit, but for the last one.
template <typename Below>
std::size_t interval(std::size_t nodes, const Below& is_below) {
  std::size_t found = 0;
  while (found + 2 < nodes && is_below(found + 1)) ++found;
  return found;
}

/// Solves a x + (b - a) x^2 / 2 = integral, as the loaders do.
float linear_inverse(float a, float b, float integral) {
  if (std::abs(a - b) < 1e-4F * (a + b)) return 2 * integral / (a + b);
  return (a - std::sqrt(std::max(a * a - 2 * integral * (a - b), 0.0F))) / (a - b);
}

float dot(const Vec3f& a, const Vec3f& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

float elevation(const Vec3f& d) {
  const float dz = d[2] - 1;
  return 2 * std::asin(std::min(std::sqrt(d[0] * d[0] + d[1] * d[1] + dz * dz) / 2, 1.0F));
}

float to_unit(float theta) {
  return std::sqrt(theta * (2 / kPi));
}

float turn_to_unit(float phi) {
  return (phi + kPi) / (2 * kPi);
}

std::array<float, 2> place_of(const Vec3f& normal, float turned) {
  const float turn = turn_to_unit(std::atan2(normal[1], normal[0]) - turned);
  return {to_unit(elevation(normal)), turn - std::floor(turn)};
}

Vec3f half_of(const Vec3f& a, const Vec3f& b) {
  Vec3f sum{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  const float length = std::sqrt(dot(sum, sum));
  for (float& x : sum) x /= length;
  return sum;
}

float jacobian_of(const Vec3f& in, const Vec3f& normal, float x, float sin_theta) {
  return std::max(2 * kPi * kPi * x * sin_theta, 1e-6F) * 4 * dot(in, normal);
}

}  // namespace

Marginal2D::Marginal2D(std::vector<float> data, std::size_t width, std::size_t height,
                       std::vector<std::vector<float>> parameters, bool is_density)
    : width_(width), height_(height), parameters_(std::move(parameters)), data_(std::move(data)) {
  if (!is_density) return;
  const std::size_t size = width * height;
  conditional_.resize(data_.size());
  marginal_.resize(data_.size() / width);
  for (std::size_t slice = 0; slice < data_.size() / size; ++slice) {
    float* const data_of = &data_[slice * size];
    float* const conditional = &conditional_[slice * size];
    float* const marginal = &marginal_[slice * height];
    for (std::size_t y = 0; y < height; ++y) {
      double sum = 0;
      for (std::size_t x = 0; x + 1 < width; ++x) {
        sum += 0.5 * (static_cast<double>(data_of[y * width + x]) + static_cast<double>(data_of[y * width + x + 1]));
        conditional[y * width + x + 1] = static_cast<float>(sum);
      }
    }
    double sum = 0;
    for (std::size_t y = 0; y + 1 < height; ++y) {
      sum += 0.5 * (static_cast<double>(conditional[(y + 1) * width - 1]) +
                    static_cast<double>(conditional[(y + 2) * width - 1]));
      marginal[y + 1] = static_cast<float>(sum);
    }
    const float scale = 1 / marginal[height - 1];
    for (std::size_t k = 0; k < size; ++k) {
      data_of[k] *= scale;
      conditional[k] *= scale;
    }
    for (std::size_t y = 0; y < height; ++y) marginal[y] *= scale;
  }
}

std::vector<Marginal2D::Slice> Marginal2D::slices_at(const std::vector<float>& parameters) const {
  std::vector<Slice> slices{{0, 1}};
  for (std::size_t d = 0; d < parameters_.size(); ++d) {
    const auto& axis = parameters_[d];
    std::vector<Slice> next;
    for (const Slice& slice : slices) {
      if (axis.size() == 1) {
        next.push_back({slice.index, slice.weight});
        continue;
      }
      const std::size_t k = interval(axis.size(), [&](std::size_t i) { return axis[i] <= parameters[d]; });
      const float share = std::clamp((parameters[d] - axis[k]) / (axis[k + 1] - axis[k]), 0.0F, 1.0F);
      next.push_back({slice.index * axis.size() + k, slice.weight * (1 - share)});
      next.push_back({slice.index * axis.size() + k + 1, slice.weight * share});
    }
    slices = std::move(next);
  }
  return slices;
}

Marginal2D::Found Marginal2D::sample(std::array<float, 2> uniform, const std::vector<float>& parameters) const {
  for (float& u : uniform) u = std::clamp(u, 1 - kAlmostOne, kAlmostOne);
  const auto slices = slices_at(parameters);
  const auto look_up = [&](const std::vector<float>& numbers, std::size_t size, std::size_t at) {
    float sum = 0;
    for (const Slice& slice : slices) sum += slice.weight * numbers[slice.index * size + at];
    return sum;
  };
  const std::size_t size = width_ * height_;
  const auto marginal = [&](std::size_t y) { return look_up(marginal_, height_, y); };
  const std::size_t row = interval(height_, [&](std::size_t y) { return marginal(y) < uniform[1]; });
  const float lower = look_up(conditional_, size, (row + 1) * width_ - 1);
  const float upper = look_up(conditional_, size, (row + 2) * width_ - 1);
  const float b = linear_inverse(lower, upper, uniform[1] - marginal(row));
  const auto across = [&](const std::vector<float>& numbers, std::size_t x) {
    return (1 - b) * look_up(numbers, size, row * width_ + x) + b * look_up(numbers, size, (row + 1) * width_ + x);
  };
  const float along = uniform[0] * ((1 - b) * lower + b * upper);
  const std::size_t column = interval(width_, [&](std::size_t x) { return across(conditional_, x) < along; });
  const float left = across(data_, column);
  const float right = across(data_, column + 1);
  const float a = linear_inverse(left, right, along - across(conditional_, column));
  const auto columns = static_cast<float>(width_ - 1);
  const auto rows = static_cast<float>(height_ - 1);
  return {{(static_cast<float>(column) + a) / columns, (static_cast<float>(row) + b) / rows},
          ((1 - a) * left + a * right) * columns * rows};
}

Marginal2D::Found Marginal2D::invert(std::array<float, 2> place, const std::vector<float>& parameters) const {
  const auto slices = slices_at(parameters);
  const auto look_up = [&](const std::vector<float>& numbers, std::size_t size, std::size_t at) {
    float sum = 0;
    for (const Slice& slice : slices) sum += slice.weight * numbers[slice.index * size + at];
    return sum;
  };
  const std::size_t size = width_ * height_;
  const auto columns = static_cast<float>(width_ - 1);
  const auto rows = static_cast<float>(height_ - 1);
  const auto column = std::min(static_cast<std::size_t>(place[0] * columns), width_ - 2);
  const auto row = std::min(static_cast<std::size_t>(place[1] * rows), height_ - 2);
  const float a = place[0] * columns - static_cast<float>(column);
  const float b = place[1] * rows - static_cast<float>(row);
  const auto across = [&](const std::vector<float>& numbers, std::size_t x) {
    return (1 - b) * look_up(numbers, size, row * width_ + x) + b * look_up(numbers, size, (row + 1) * width_ + x);
  };
  const float left = across(data_, column);
  const float right = across(data_, column + 1);
  const float lower = look_up(conditional_, size, (row + 1) * width_ - 1);
  const float upper = look_up(conditional_, size, (row + 2) * width_ - 1);
  const float along = a * (left + a * (right - left) / 2) + across(conditional_, column);
  return {
      {along / ((1 - b) * lower + b * upper), b * (lower + b * (upper - lower) / 2) + look_up(marginal_, height_, row)},
      ((1 - a) * left + a * right) * columns * rows};
}

float Marginal2D::eval(std::array<float, 2> place, const std::vector<float>& parameters) const {
  const auto columns = static_cast<float>(width_ - 1);
  const auto rows = static_cast<float>(height_ - 1);
  const auto column = std::min(static_cast<std::size_t>(place[0] * columns), width_ - 2);
  const auto row = std::min(static_cast<std::size_t>(place[1] * rows), height_ - 2);
  const float a = place[0] * columns - static_cast<float>(column);
  const float b = place[1] * rows - static_cast<float>(row);
  float sum = 0;
  for (const Slice& slice : slices_at(parameters)) {
    const float* const corner = &data_[slice.index * width_ * height_ + row * width_ + column];
    sum += slice.weight *
           ((1 - b) * ((1 - a) * corner[0] + a * corner[1]) + b * ((1 - a) * corner[width_] + a * corner[width_ + 1]));
  }
  // Data that are no densities are handed out as they are.
  return marginal_.empty() ? sum : sum * columns * rows;
}

std::vector<TensorField> tensor_fields_of(const std::string& content) {
  std::size_t at = 0;
  const auto take = [&]<typename Number>(Number number) {
    if (at + sizeof(Number) > content.size()) throw std::runtime_error("the file is cut");
    std::memcpy(&number, content.data() + at, sizeof(Number));
    at += sizeof(Number);
    return number;
  };
  if (content.substr(0, 14) != std::string("tensor_file\0\1\0", 14)) throw std::runtime_error("not a tensor file 1.0");
  at = 14;
  std::vector<TensorField> fields(take(std::uint32_t{}));
  constexpr std::array<std::size_t, 12> kBytes{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
  for (TensorField& field : fields) {
    const std::size_t length = take(std::uint16_t{});
    field.name = content.substr(at, length);
    at += length;
    const std::size_t axes = take(std::uint16_t{});
    field.type = take(std::uint8_t{});
    if (field.type == 0 || field.type >= kBytes.size()) throw std::runtime_error("a field of unknown type");
    field.offset = take(std::uint64_t{});
    std::size_t size = kBytes[field.type];
    for (std::size_t k = 0; k < axes; ++k) {
      field.shape.push_back(take(std::uint64_t{}));
      size *= field.shape.back();
    }
    if (field.offset + size > content.size()) throw std::runtime_error("the file is cut in " + field.name);
    field.bytes = content.substr(field.offset, size);
    if (field.type == 10) {
      field.floats.resize(size / sizeof(float));
      std::memcpy(field.floats.data(), field.bytes.data(), size);
    }
  }
  return fields;
}

RglRenderer::RglRenderer(const std::string& content) {
  constexpr unsigned kU8 = 1;
  constexpr unsigned kF32 = 10;
  std::map<std::string, TensorField> fields;
  for (TensorField& field : tensor_fields_of(content)) fields[field.name] = field;
  const auto field = [&](const std::string& name, unsigned type, std::size_t axes) -> const TensorField& {
    const auto found = fields.find(name);
    if (found == fields.end()) throw std::runtime_error("no field " + name);
    if (found->second.type != type || found->second.shape.size() != axes) throw std::runtime_error("field " + name);
    return found->second;
  };
  const auto require = [](bool is_met, const char* what) {
    if (!is_met) throw std::runtime_error(what);
  };
  static_cast<void>(field("description", kU8, 1));
  const auto& theta = field("theta_i", kF32, 1);
  const auto& phi = field("phi_i", kF32, 1);
  const auto& ndf = field("ndf", kF32, 2);
  const auto& sigma = field("sigma", kF32, 2);
  const auto& vndf = field("vndf", kF32, 4);
  const auto& luminance = field("luminance", kF32, 4);
  const auto& jacobian = field("jacobian", kU8, 1);
  const bool is_spectral = fields.contains("wavelengths");
  const auto& values = field(is_spectral ? "spectra" : "rgb", kF32, 5);
  wavelengths_ = is_spectral ? field("wavelengths", kF32, 1).floats : std::vector<float>{0, 1, 2};
  for (const TensorField* part : {&vndf, &luminance, &values}) {
    require(part->shape[0] == phi.shape[0] && part->shape[1] == theta.shape[0], "directions of the light");
  }
  require(luminance.shape[2] == luminance.shape[3], "luminance is no square");
  require(values.shape[2] == wavelengths_.size(), "wavelengths");
  require(values.shape[3] == luminance.shape[2] && values.shape[4] == luminance.shape[3], "values are no square");
  // pbrt-v4 and powitacq multiply by the Jacobian without asking.
  require(jacobian.shape[0] == 1 && jacobian.bytes[0] == 1, "jacobian");
  is_isotropic_ = phi.shape[0] <= 2;
  if (!is_isotropic_) {
    // Nor do they know parts of a turn.
    require(std::rint(2 * kPi / (phi.floats.back() - phi.floats.front())) == 1, "azimuths are no turn");
  }
  const auto grid = [&](const TensorField& of, std::vector<std::vector<float>> parameters, bool is_density) {
    return Marginal2D(of.floats, of.shape.back(), of.shape[of.shape.size() - 2], std::move(parameters), is_density);
  };
  ndf_ = grid(ndf, {}, false);
  sigma_ = grid(sigma, {}, false);
  vndf_ = grid(vndf, {phi.floats, theta.floats}, true);
  luminance_ = grid(luminance, {phi.floats, theta.floats}, true);
  values_ = grid(values, {phi.floats, theta.floats, wavelengths_}, false);
}

std::vector<float> RglRenderer::values(const std::array<float, 2>& place, const Vec3f& in,
                                       const std::array<float, 2>& normal) const {
  const float theta = elevation(in);
  const float phi = std::atan2(in[1], in[0]);
  const float scale = ndf_.eval(normal, {}) / (4 * sigma_.eval({to_unit(theta), turn_to_unit(phi)}, {}));
  std::vector<float> found;
  for (const float wavelength : wavelengths_) found.push_back(scale * values_.eval(place, {phi, theta, wavelength}));
  return found;
}

std::vector<float> RglRenderer::eval(const Vec3f& in, const Vec3f& out) const {
  if (in[2] <= 0 || out[2] <= 0) return std::vector<float>(channels(), 0);
  const float phi = std::atan2(in[1], in[0]);
  const auto normal = place_of(half_of(in, out), is_isotropic_ ? phi : 0);
  return values(vndf_.invert(normal, {phi, elevation(in)}).place, in, normal);
}

float RglRenderer::pdf(const Vec3f& in, const Vec3f& out) const {
  if (in[2] <= 0 || out[2] <= 0) return 0;
  const float phi = std::atan2(in[1], in[0]);
  const Vec3f half = half_of(in, out);
  const auto normal = place_of(half, is_isotropic_ ? phi : 0);
  const std::vector<float> light{phi, elevation(in)};
  const auto uniform = vndf_.invert(normal, light);
  return uniform.density * luminance_.eval(uniform.place, light) /
         jacobian_of(in, half, normal[0], std::hypot(half[0], half[1]));
}

std::optional<RglRenderer::Drawn> RglRenderer::sample(const Vec3f& in, float u0, float u1) const {
  const float phi = std::atan2(in[1], in[0]);
  const std::vector<float> light{phi, elevation(in)};
  const auto bright = luminance_.sample({u1, u0}, light);
  const auto visible = vndf_.sample(bright.place, light);
  const float theta_m = visible.place[0] * visible.place[0] * kPi / 2;
  const float phi_m = (2 * visible.place[1] - 1) * kPi + (is_isotropic_ ? phi : 0);
  const Vec3f m{std::sin(theta_m) * std::cos(phi_m), std::sin(theta_m) * std::sin(phi_m), std::cos(theta_m)};
  const float twice = 2 * dot(m, in);
  Drawn drawn{.out = {twice * m[0] - in[0], twice * m[1] - in[1], twice * m[2] - in[2]}, .pdf = 0, .weight = {}};
  if (drawn.out[2] <= 0) return std::nullopt;
  drawn.pdf = visible.density * bright.density / jacobian_of(in, m, visible.place[0], std::sin(theta_m));
  for (const float value : values(bright.place, in, visible.place)) drawn.weight.push_back(value / drawn.pdf);
  return drawn;
}

}  // namespace lobe::reference
