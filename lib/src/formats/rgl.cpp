// Measurements on grids adapted to the material: tensor files of the RGL material database.
// Source: Dupuy and Jakob 2018 ("An adaptive parameterization for efficient material acquisition and rendering").
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/byte_reader.hpp"
#include "formats/format.hpp"
#include "formats/number_census.hpp"
#include "formats/rgl_writer.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::string_view kMagic{"tensor_file\0", 12};
constexpr std::size_t kFieldsAt = 14;  // where the list of fields begins
constexpr std::uint32_t kMostFields = 256;
constexpr std::uint16_t kMostAxes = 8;
constexpr std::size_t kMostAngles = 4096;
constexpr double kLeastArea = 1e-30;  // which is divided by

enum class Type : std::uint8_t { u8 = 1, i8, u16, i16, u32, i32, u64, i64, f16, f32, f64 };

struct Field {
  std::string_view name;
  Type type;
  std::size_t offset;  // of its numbers in the file
  std::vector<std::size_t> shape;

  [[nodiscard]] std::size_t size() const {
    std::size_t product = 1;
    for (const std::size_t length : shape) product *= length;
    return product;
  }
};

std::size_t bytes_of(Type type) {
  switch (type) {
    case Type::u8:
    case Type::i8:
      return 1;
    case Type::u16:
    case Type::i16:
    case Type::f16:
      return 2;
    case Type::u32:
    case Type::i32:
    case Type::f32:
      return 4;
    default:
      return 8;
  }
}

/// The container: fields by name, all within the file.
class TensorFile {
 public:
  explicit TensorFile(FileBytes file) : file_(std::move(file)) {
    ByteReader reader(file_, kMagic.size());
    const auto major = reader.read<std::uint8_t>("the version");
    const auto minor = reader.read<std::uint8_t>("the version");
    if (major != 1) {
      file_.refuse_at(kMagic.size(), fmt::format("version {}.{} of tensor files; expected 1.0", major, minor));
    }
    const std::size_t at = reader.offset();
    const auto count = reader.read<std::uint32_t>("the number of fields");
    if (count > kMostFields) {
      file_.refuse_at(at, fmt::format("{} fields; expected up to {}", count, kMostFields));
    }
    std::size_t end = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      fields_.push_back(read_field(reader));
      end = std::max(end, fields_.back().offset + fields_.back().size() * bytes_of(fields_.back().type));
    }
    end = std::max(end, reader.offset());
    if (end != file_.size()) file_.refuse_at(end, fmt::format("{} bytes after the last field", file_.size() - end));
  }

  [[nodiscard]] const FileBytes& file() const { return file_; }

  [[nodiscard]] const Field* find(std::string_view name) const {
    const auto found = std::ranges::find(fields_, name, &Field::name);
    return found == fields_.end() ? nullptr : &*found;
  }

  /// \throws IoError where there is no such field of this type and number of axes
  [[nodiscard]] const Field& field(std::string_view name, Type type, std::size_t axes) const {
    const Field* found = find(name);
    if (found == nullptr) file_.refuse_at(kFieldsAt, fmt::format("there is no field '{}'", name));
    if (found->type != type) file_.refuse_at(found->offset, fmt::format("field '{}' is of another type", name));
    if (found->shape.size() != axes) {
      file_.refuse_at(found->offset,
                      fmt::format("field '{}' has {} axes; expected {}", name, found->shape.size(), axes));
    }
    if (found->size() == 0) file_.refuse_at(kFieldsAt, fmt::format("field '{}' is empty", name));
    return *found;
  }

  /// \throws IoError for numbers that are not finite or below a limit
  void check(const Field& field, double least) const {
    if (least == 0) {
      const NumberCensus found = census<float>(file_.content(), field.offset, field.size());
      if (found.negative + found.not_finite == 0) return;
    }
    for (std::size_t i = 0; i < field.size(); ++i) {
      const double value = number(field, i);
      if (!(value >= least && value <= std::numeric_limits<double>::max())) refuse_number(field, i, least);
    }
  }
  [[nodiscard]] double number(const Field& field, std::size_t index) const {
    return static_cast<double>(number_at<float>(file_.content(), field.offset + index * sizeof(float)));
  }

  [[noreturn]] void refuse_number(const Field& field, std::size_t index, double least) const {
    const std::size_t at = field.offset + index * sizeof(float);
    file_.refuse_at(at, std::isfinite(number_at<float>(file_.content(), at))
                            ? fmt::format("a value of '{}' is below {}", field.name, least)
                            : fmt::format("a value of '{}' is no finite number", field.name));
  }

 private:
  [[nodiscard]] Field read_field(ByteReader& reader) const {
    const std::size_t begin = reader.offset();
    Field field{};
    field.name = reader.bytes(reader.read<std::uint16_t>("the name of a field"), "the name of a field");
    const auto axes = reader.read<std::uint16_t>("the axes of a field");
    if (axes > kMostAxes) file_.refuse_at(begin, fmt::format("a field of {} axes; expected up to {}", axes, kMostAxes));
    field.type = Type{reader.read<std::uint8_t>("the type of a field")};
    if (field.type < Type::u8 || field.type > Type::f64) file_.refuse_at(begin, "a field of unknown type");
    const auto offset = reader.read<std::uint64_t>("the place of a field");
    if (offset > file_.size()) {
      file_.refuse_at(begin, fmt::format("a field lies at byte {}, but the file has {}", offset, file_.size()));
    }
    field.offset = static_cast<std::size_t>(offset);
    std::size_t room = (file_.size() - field.offset) / bytes_of(field.type);  // for further numbers, by axis
    for (std::uint16_t k = 0; k < axes; ++k) {
      const auto length = reader.read<std::uint64_t>("the shape of a field");
      if (length > room) refuse_length(begin, field);
      if (length > 0) room /= static_cast<std::size_t>(length);
      field.shape.push_back(static_cast<std::size_t>(length));
    }
    if (room == 0 && field.size() > 0) refuse_length(begin, field);
    return field;
  }

  [[noreturn]] void refuse_length(std::size_t begin, const Field& field) const {
    file_.refuse_at(begin, fmt::format("the field at byte {} does not end within the file of {} bytes", field.offset,
                                       file_.size()));
  }

  FileBytes file_;
  std::vector<Field> fields_;
};

/// A place in the unit square: x along the last axis of a grid (elevation), y along the one before (azimuth).
struct Place {
  double x;
  double y;
};

/// A cell between the nodes of an axis from 0 to 1, and where in it.
struct Cell {
  std::size_t index;
  double share;
};

Cell cell_of(double place, std::size_t nodes) {
  const double steps = std::clamp(place, 0.0, 1.0) * static_cast<double>(nodes - 1);
  const std::size_t index = std::min(static_cast<std::size_t>(steps), nodes - 2);
  return {index, steps - static_cast<double>(index)};
}

/// Grids of single precision, one after the other, in the file.
struct Grids {
  std::size_t offset = 0;
  std::size_t width = 0;
  std::size_t height = 0;

  [[nodiscard]] std::size_t size() const { return width * height; }
  [[nodiscard]] double at(std::string_view content, std::size_t index) const {
    return static_cast<double>(number_at<float>(content, offset + index * sizeof(float)));
  }
};

/// The four nodes about a place, and their weights.
struct Patch {
  std::array<std::size_t, 4> node{};
  std::array<double, 4> weight{};

  Patch(const Grids& grids, const Place& place) {
    const Cell x = cell_of(place.x, grids.width);
    const Cell y = cell_of(place.y, grids.height);
    const std::size_t first = y.index * grids.width + x.index;
    node = {first, first + 1, first + grids.width, first + grids.width + 1};
    weight = {(1 - x.share) * (1 - y.share), x.share * (1 - y.share), (1 - x.share) * y.share, x.share * y.share};
  }

  [[nodiscard]] double mean(std::string_view content, const Grids& grids, std::size_t grid = 0) const {
    const std::size_t first = grid * grids.size();
    double sum = 0;
    for (std::size_t k = 0; k < node.size(); ++k) sum += weight[k] * grids.at(content, first + node[k]);
    return sum;
  }
};

/// One of the light's directions that were measured, and its part in one that was not.
struct Share {
  std::size_t slice;
  double weight;
};

/// Densities of visible normals by the light's direction, with their integrals.
class VisibleNormals {
 public:
  VisibleNormals(const TensorFile& tensors, const Field& field, const Grids& grids)
      : grids_(grids), blocks_((grids.width - 1) / kBlock + 1) {
    tensors.check(field, 0);
    const std::size_t slices = field.shape[0] * field.shape[1];
    sums_.resize(slices * grids_.height * blocks_);
    across_.reserve(slices * grids_.height);
    along_.reserve(slices * grids_.height);
    const std::string_view content = tensors.file().content();
    for (std::size_t slice = 0; slice < slices; ++slice) {
      add_slice(content, slice);
      if (!(across_.back() > 0)) {
        tensors.file().refuse_at(field.offset + slice * grids_.size() * sizeof(float),
                                 "a density of 'vndf' has no integral above 0");
      }
    }
  }

  /// Where in the unit square of uniform density a normal lies: shares of the integral along x, then y.
  [[nodiscard]] Place uniform(std::string_view content, const Place& normal, std::span<const Share> shares) const {
    const Cell x = cell_of(normal.x, grids_.width);
    const Cell y = cell_of(normal.y, grids_.height);
    double below = 0;  // integral along x up to the cell
    double left = 0;   // densities at both ends of the cell
    double right = 0;
    std::array<double, 2> whole{};  // integrals along both rows
    double rows_below = 0;
    for (const auto& [slice, weight] : shares) {
      const double part = weight / across_[(slice + 1) * grids_.height - 1];
      const std::size_t first = slice * grids_.height + y.index;
      for (const std::size_t k : {0U, 1U}) {
        const double here = part * (k == 0 ? 1 - y.share : y.share);
        const std::size_t node = (first + k) * grids_.width + x.index;
        below += here * integral(content, first + k, x.index);
        left += here * grids_.at(content, node);
        right += here * grids_.at(content, node + 1);
        whole[k] += part * along_[first + k];
      }
      rows_below += part * across_[first];
    }
    const double row = (1 - y.share) * whole[0] + y.share * whole[1];
    const double sum = below + x.share * (left + x.share / 2 * (right - left));
    return {row > 0 ? sum / row : 0, rows_below + y.share * (whole[0] + y.share / 2 * (whole[1] - whole[0]))};
  }

 private:
  // Nodes between sums that are kept. Sums of all would take twice as much memory as the densities.
  static constexpr std::size_t kBlock = 4;

  void add_slice(std::string_view content, std::size_t slice) {
    for (std::size_t row = slice * grids_.height; row < (slice + 1) * grids_.height; ++row) {
      double sum = 0;
      double* const sums = &sums_[row * blocks_];
      for (std::size_t block = 0; block + 1 < blocks_; ++block) {
        sums[block] = sum;
        sum += sum_of_block(content, row * grids_.width + block * kBlock);
      }
      sums[blocks_ - 1] = sum;
      along_.push_back(integral(content, row, grids_.width - 1));
      const bool is_first = row == slice * grids_.height;
      across_.push_back(is_first ? 0 : across_.back() + (along_[row - 1] + along_[row]) / 2);
    }
  }

  [[nodiscard]] double sum_of(std::string_view content, std::size_t node, std::size_t count) const {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += grids_.at(content, node + i);
    return sum;
  }

  /// Sum over kBlock nodes, as vectors: conversions of single numbers would take most of the time of loading.
  [[nodiscard]] double sum_of_block(std::string_view content, std::size_t node) const {
    Eigen::Array<float, kBlock, 1> numbers;
    std::memcpy(numbers.data(), content.data() + grids_.offset + node * sizeof(float), kBlock * sizeof(float));
    const Eigen::Array<double, kBlock, 1> wide = numbers.cast<double>();
    return wide.sum();
  }

  /// Integral over a row from its left end to a node, in steps; by trapezoids.
  [[nodiscard]] double integral(std::string_view content, std::size_t row, std::size_t node) const {
    const std::size_t first = row * grids_.width;
    const std::size_t block = node / kBlock;
    return sums_[row * blocks_ + block] + sum_of(content, first + block * kBlock, node % kBlock) +
           (grids_.at(content, first + node) - grids_.at(content, first)) / 2;
  }

  Grids grids_;
  std::size_t blocks_;          // of a row
  std::vector<double> sums_;    // of all nodes of a row before a block, [slice][row][block]
  std::vector<double> along_;   // integrals of whole rows, [slice][row]
  std::vector<double> across_;  // integrals from the first row on, [slice][row]
};

/// Signs that turn and mirror all directions so that the light's is in the part of a turn that was measured.
struct Symmetry {
  double x = 1;
  double y = 1;
};

/// A light, the directions about it that were measured, and its share of the Jacobian.
struct Light {
  double theta;
  double azimuth;  // 0 where files are isotropic
  double sin_theta;
  double cos_theta;
  Symmetry symmetry;
  double x;  // of the azimuth, turned and mirrored
  double y;
  double phi;  // of that
  double jacobian;
  std::array<Share, 4> shares;
  std::size_t count;
};

/// Angles of H, in that part too.
struct Half {
  double theta;
  double phi;
};

double to_unit(double theta) {
  return std::sqrt(theta * 2 / pi);
}

double turn_to_unit(double phi) {
  const double turns = (phi + pi) / (2 * pi);
  return turns - std::floor(turns);
}

class RglFile {
 public:
  explicit RglFile(TensorFile tensors)
      : tensors_(std::move(tensors)),
        phi_(axis("phi_i")),
        theta_(axis("theta_i")),
        normals_of_surface_(grids("ndf", 2, 0)),
        visible_area_(grids("sigma", 2, kLeastArea)),
        visible_(grids_of(tensors_.field("vndf", Type::f32, 4))),
        normals_(tensors_, by_light("vndf", 4), visible_),
        values_(read_values()) {
    const Field& jacobian = tensors_.field("jacobian", Type::u8, 1);
    has_jacobian_ = tensors_.file().content()[jacobian.offset] != 0;
    if (!is_isotropic()) find_symmetry();
  }

  [[nodiscard]] bool is_isotropic() const { return phi_.size() <= 2; }
  [[nodiscard]] const std::vector<float>& wavelengths() const { return wavelengths_; }
  [[nodiscard]] std::size_t channels() const { return channels_; }

  [[nodiscard]] std::vector<std::string> remarks() const {
    if (negative_ == 0) return {};
    return {fmt::format("{} of {} values are negative, and kept", negative_,
                        phi_.size() * theta_.size() * channels_ * values_.size())};
  }

  [[nodiscard]] BrdfValues at(std::span<const Directions> pairs) const {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(channels_));
    Light light{};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Directions& pair = pairs[i];
      const double azimuth =
          is_isotropic() ? 0 : pair.phi_in + 0.0;  // 0 for -0, which is on the other side of a mirror
      // Integrals over the viewer ask for one light again and again.
      if (i == 0 || pair.theta_in != light.theta || azimuth != light.azimuth) light = light_of(pair.theta_in, azimuth);
      evaluate(light, pair, values.value.row(static_cast<Eigen::Index>(i)));
    }
    return values;
  }

 private:
  [[nodiscard]] std::vector<double> axis(std::string_view name) const {
    const Field& field = tensors_.field(name, Type::f32, 1);
    if (field.size() > kMostAngles) {
      tensors_.file().refuse_at(field.offset,
                                fmt::format("{} angles '{}'; expected up to {}", field.size(), name, kMostAngles));
    }
    tensors_.check(field, -4);
    std::vector<double> found;
    for (std::size_t i = 0; i < field.size(); ++i) found.push_back(tensors_.number(field, i));
    const auto fall = std::ranges::adjacent_find(found, std::ranges::greater_equal{});
    if (fall != found.end() || found.back() > 4) {
      tensors_.file().refuse_at(field.offset, fmt::format("the angles '{}' do not increase within a turn", name));
    }
    return found;
  }

  [[nodiscard]] Grids grids_of(const Field& field) const {
    const std::size_t width = field.shape.back();
    const std::size_t height = field.shape[field.shape.size() - 2];
    if (width < 2 || height < 2) {
      tensors_.file().refuse_at(
          field.offset, fmt::format("field '{}' has grids of {} x {}; expected two nodes at least along each axis",
                                    field.name, height, width));
    }
    return {field.offset, width, height};
  }

  /// Grids whose numbers are all finite and none below a limit.
  [[nodiscard]] Grids grids(std::string_view name, std::size_t axes, double least) const {
    const Field& field = tensors_.field(name, Type::f32, axes);
    tensors_.check(field, least);
    return grids_of(field);
  }

  /// A field with the light's azimuths and angles as its first axes.
  [[nodiscard]] const Field& by_light(std::string_view name, std::size_t axes) const {
    const Field& field = tensors_.field(name, Type::f32, axes);
    if (field.shape[0] != phi_.size() || field.shape[1] != theta_.size()) {
      tensors_.file().refuse_at(field.offset,
                                fmt::format("field '{}' has {} x {} directions of the light; expected {} x {}", name,
                                            field.shape[0], field.shape[1], phi_.size(), theta_.size()));
    }
    return field;
  }

  [[nodiscard]] Grids read_values() {
    const bool is_spectral = tensors_.find("spectra") != nullptr;
    const Field& field = by_light(is_spectral ? "spectra" : "rgb", 5);
    channels_ = field.shape[2];
    const Field* wavelengths = is_spectral ? &tensors_.field("wavelengths", Type::f32, 1) : nullptr;
    const std::size_t expected = is_spectral ? wavelengths->size() : 3;
    if (channels_ != expected) {
      tensors_.file().refuse_at(
          field.offset, fmt::format("field '{}' has {} channels; expected {}", field.name, channels_, expected));
    }
    if (is_spectral) {
      tensors_.check(*wavelengths, 1);
      for (std::size_t c = 0; c < channels_; ++c) {
        wavelengths_.push_back(static_cast<float>(tensors_.number(*wavelengths, c)));
      }
    }
    const Grids found = grids_of(field);
    const NumberCensus count = census<float>(tensors_.file().content(), field.offset, field.size());
    if (count.not_finite > 0) tensors_.check(field, std::numeric_limits<double>::lowest());
    negative_ = count.negative;
    return found;
  }

  /// Azimuths over a whole turn, over half of one (which then repeats) or over a quarter (mirrored).
  void find_symmetry() {
    constexpr double kSlack = 0.01;
    const double span = phi_.back() - phi_.front();
    for (const int parts : {1, 2, 4}) {
      if (std::abs(span - 2 * pi / parts) < kSlack && std::abs(phi_.front() + pi) < kSlack) parts_ = parts;
    }
    if (parts_ == 0) {
      tensors_.file().refuse_at(tensors_.find("phi_i")->offset,
                                fmt::format("azimuths from {:.4g} to {:.4g} degrees; expected a turn, a half or a "
                                            "quarter of it, from -180 degrees on",
                                            to_degrees(phi_.front()), to_degrees(phi_.back())));
    }
  }

  [[nodiscard]] Symmetry symmetry_of(double azimuth) const {
    Symmetry sign;
    if (parts_ >= 2 && !std::signbit(std::sin(azimuth))) {
      sign.y = -1;
      if (parts_ == 2) sign.x = -1;
    }
    if (parts_ == 4 && !std::signbit(std::cos(azimuth))) sign.x = -1;
    return sign;
  }

  [[nodiscard]] Light light_of(double theta, double azimuth) const {
    Light light{};
    light.theta = theta;
    light.azimuth = azimuth;
    light.sin_theta = std::sin(theta);
    light.cos_theta = std::cos(theta);
    light.symmetry = symmetry_of(azimuth);
    light.x = light.symmetry.x * std::cos(azimuth);
    light.y = light.symmetry.y * std::sin(azimuth);
    light.phi = is_isotropic() ? 0 : std::atan2(light.y, light.x);
    for (const auto& [p, weight_p] : shares_of(phi_, light.phi)) {
      for (const auto& [t, weight_t] : shares_of(theta_, theta)) {
        if (weight_p * weight_t > 0) light.shares[light.count++] = {p * theta_.size() + t, weight_p * weight_t};
      }
    }
    light.jacobian = 1;
    if (has_jacobian_) {
      const Place place{to_unit(theta), turn_to_unit(light.phi)};
      light.jacobian = 1 / (4 * Patch(visible_area_, place).mean(tensors_.file().content(), visible_area_));
    }
    return light;
  }

  [[nodiscard]] Half half_of(const Light& light, const Directions& pair, double cos_out) const {
    constexpr double kOpen = 1e-12;  // sine of the angle between H and the normal, of which rounding makes an azimuth
    const double sin_out = std::sin(pair.theta_out);
    const double x = light.sin_theta * light.x + sin_out * light.symmetry.x * std::cos(light.azimuth + pair.delta_phi);
    const double y = light.sin_theta * light.y + sin_out * light.symmetry.y * std::sin(light.azimuth + pair.delta_phi);
    const double z = light.cos_theta + cos_out;
    const double radius = std::sqrt(x * x + y * y);
    return {std::atan2(radius, z), radius < kOpen * z ? light.phi : std::atan2(y, x)};
  }

  /// Two nodes of an axis about a value, or one twice, with their weights; constant beyond both ends.
  [[nodiscard]] static std::array<Share, 2> shares_of(const std::vector<double>& axis, double value) {
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(axis, value) - axis.begin());
    if (above == 0) return {{{0, 1}, {0, 0}}};
    if (above == axis.size()) return {{{above - 1, 1}, {above - 1, 0}}};
    const double share = (value - axis[above - 1]) / (axis[above] - axis[above - 1]);
    return {{{above - 1, 1 - share}, {above, share}}};
  }

  template <typename Row>
  void evaluate(const Light& light, const Directions& pair, Row row) const {
    const std::string_view content = tensors_.file().content();
    const std::span<const Share> lights = std::span(light.shares).first(light.count);
    const double cos_out = std::cos(pair.theta_out);
    const auto [theta, phi] = half_of(light, pair, cos_out);
    const Place half{to_unit(theta), turn_to_unit(phi)};
    double factor = light.jacobian / cos_out;
    if (has_jacobian_) factor *= Patch(normals_of_surface_, half).mean(content, normals_of_surface_);
    const Patch patch(values_, normals_.uniform(content, half, lights));
    for (std::size_t c = 0; c < channels_; ++c) {
      double sum = 0;
      for (const auto& [slice, weight] : lights) {
        sum += weight * patch.mean(content, values_, slice * channels_ + c);
      }
      row[static_cast<Eigen::Index>(c)] = factor * sum;
    }
  }

  TensorFile tensors_;
  std::vector<double> phi_;
  std::vector<double> theta_;
  Grids normals_of_surface_;
  Grids visible_area_;
  Grids visible_;
  VisibleNormals normals_;
  std::vector<float> wavelengths_;
  std::size_t channels_ = 0;
  std::size_t negative_ = 0;
  Grids values_;
  bool has_jacobian_ = false;
  int parts_ = 0;  // of a turn that the azimuths make one of: 1, 2 or 4; 0: isotropic
};

bool recognises(const FileBytes& head) {
  return head.content().starts_with(kMagic);
}

BrdfFunction read(const FileBytes& file, const ReadOptions&) {
  const auto content = std::make_shared<const RglFile>(TensorFile(file));
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kRglFormat.title;
  brdf.conventions =
      "sr^-1 without cosine, the file's values being divided by that of the viewer; half-vector over the density of "
      "visible normals; linear between the light's angles; not exactly reciprocal";
  if (content->wavelengths().empty()) brdf.channels = {"red", "green", "blue"};
  for (const float wavelength : content->wavelengths()) {
    brdf.channels.push_back(fmt::format("{} nm", wavelength));
    brdf.wavelengths.push_back(static_cast<double>(wavelength));
  }
  brdf.remarks = content->remarks();
  brdf.is_isotropic = content->is_isotropic();
  brdf.at = [content](std::span<const Directions> pairs) { return content->at(pairs); };
  return brdf;
}

}  // namespace

const Format kRglFormat{"rgl", "RGL tensor_file .bsdf (Dupuy and Jakob 2018)", recognises, read, false, write_rgl};

}  // namespace lobe
