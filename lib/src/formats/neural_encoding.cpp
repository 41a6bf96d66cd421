// Neural encodings of measured reflectances.
// Source: Sztrajman, Rainer, Ritschel and Weyrich 2021 ("Neural BRDF representation and importance sampling").
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/format.hpp"
#include "formats/plain_hdf5.hpp"
#include "hemisphere/unit_vector.hpp"

namespace lobe {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t kInputs = 6;
constexpr std::size_t kHidden = 21;
constexpr std::size_t kOutputs = 3;

/// y = x kernel + bias.
struct Layer {
  Matrix kernel;
  Eigen::RowVectorXd bias;

  [[nodiscard]] Matrix apply(const Matrix& x) const { return (x * kernel).rowwise() + bias; }
};

std::string weight_of(int layer, const char* name) {
  const std::string group = "/dense_" + std::to_string(layer);
  return group + group + "/" + name + ":0";
}

Layer read_layer(const PlainHdf5& file, int layer, std::size_t inputs, std::size_t outputs) {
  const std::size_t shape[] = {inputs, outputs};
  const auto kernel = file.read(weight_of(layer, "kernel"), shape);
  const auto bias = file.read(weight_of(layer, "bias"), std::span(shape).last(1));
  return {
      Eigen::Map<const Matrix>(kernel.data(), static_cast<Eigen::Index>(inputs), static_cast<Eigen::Index>(outputs)),
      Eigen::Map<const Eigen::RowVectorXd>(bias.data(), static_cast<Eigen::Index>(outputs))};
}

/// The half-vector turned to azimuth 0, and L in the frame about it (Rusinkiewicz 1998).
Eigen::Matrix<double, 1, kInputs> inputs_of(const Directions& pair) {
  const Eigen::Vector3d light = unit_vector(pair.theta_in, 0);
  const Eigen::Vector3d half = (light + unit_vector(pair.theta_out, pair.delta_phi)).normalized();
  const double phi = std::atan2(half.y(), half.x());
  const double sine = std::hypot(half.x(), half.y());
  const Eigen::Vector3d turned = Eigen::AngleAxisd(-phi, Eigen::Vector3d::UnitZ()) * light;
  const Eigen::Vector3d difference = Eigen::AngleAxisd(-std::atan2(sine, half.z()), Eigen::Vector3d::UnitY()) * turned;
  Eigen::Matrix<double, 1, kInputs> inputs;
  inputs << sine, 0, half.z(), difference.transpose();
  return inputs;
}

BrdfValues evaluate(std::span<const Layer> layers, std::span<const Directions> pairs) {
  constexpr std::size_t kBlock = 256;  // pairs whose numbers stay in the cache
  BrdfValues values;
  values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(kOutputs));
  for (std::size_t first = 0; first < pairs.size(); first += kBlock) {
    const auto block = pairs.subspan(first, std::min(kBlock, pairs.size() - first));
    const auto count = static_cast<Eigen::Index>(block.size());
    Matrix x(count, static_cast<Eigen::Index>(kInputs));
    for (Eigen::Index i = 0; i < count; ++i) x.row(i) = inputs_of(block[static_cast<std::size_t>(i)]);
    for (const Layer& layer : layers.first(layers.size() - 1)) x = layer.apply(x).cwiseMax(0);
    values.value.middleRows(static_cast<Eigen::Index>(first), count) =
        (layers.back().apply(x).array().exp() - 1).cwiseMax(0);
  }
  return values;
}

bool recognises(const FileBytes& head) {
  const std::string_view content = head.content();
  return content.starts_with("\x89HDF\r\n\x1a\n") && content.find("dense_1") != std::string_view::npos;
}

BrdfFunction read(const FileBytes& bytes, const ReadOptions&) {
  const PlainHdf5 file(bytes);
  BrdfFunction brdf;
  brdf.name = bytes.stem();
  brdf.format = kNeuralEncodingFormat.title;
  brdf.conventions =
      "sr^-1 without cosine, on the colour scale of MERL; half-vector and difference vector, the former at azimuth 0; "
      "values below 0 are 0 by the encoding itself; not exactly reciprocal";
  brdf.channels = {"red", "green", "blue"};
  const std::vector<Layer> layers{read_layer(file, 1, kInputs, kHidden), read_layer(file, 2, kHidden, kHidden),
                                  read_layer(file, 3, kHidden, kOutputs)};
  brdf.at = [layers](std::span<const Directions> pairs) { return evaluate(layers, pairs); };
  return brdf;
}

}  // namespace

const Format kNeuralEncodingFormat{"nbrdf", "NBRDF neural encoding", recognises, read};

}  // namespace lobe
