// Neural encodings of measured reflectances.
// Source: Sztrajman, Rainer, Ritschel and Weyrich 2021 ("Neural BRDF representation and importance sampling").
#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "io/hdf5_input.hpp"
#include "io/measured_formats.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr hsize_t kInputs = 6;
constexpr hsize_t kHidden = 21;
constexpr hsize_t kOutputs = 3;

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

Layer read_layer(const hdf5::InputFile& file, int layer, hsize_t inputs, hsize_t outputs) {
  const hsize_t shape[] = {inputs, outputs};
  const auto kernel = file.read(weight_of(layer, "kernel"), shape);
  const auto bias = file.read(weight_of(layer, "bias"), std::span(shape).last(1));
  for (const auto* list : {&kernel, &bias}) {
    for (const double value : *list) {
      if (!std::isfinite(value))
        file.refuse("layer " + std::to_string(layer) + " has a weight that is no finite number");
    }
  }
  return {
      Eigen::Map<const Matrix>(kernel.data(), static_cast<Eigen::Index>(inputs), static_cast<Eigen::Index>(outputs)),
      Eigen::Map<const Eigen::RowVectorXd>(bias.data(), static_cast<Eigen::Index>(outputs))};
}

Eigen::Vector3d direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The half-vector turned to azimuth 0, and L in the frame about it (Rusinkiewicz 1998).
Eigen::Matrix<double, 1, kInputs> inputs_of(const Directions& pair) {
  const Eigen::Vector3d light = direction(pair.theta_in, 0);
  const Eigen::Vector3d half = (light + direction(pair.theta_out, pair.delta_phi)).normalized();
  const double phi = std::atan2(half.y(), half.x());
  const double sine = std::hypot(half.x(), half.y());
  const Eigen::Vector3d turned = Eigen::AngleAxisd(-phi, Eigen::Vector3d::UnitZ()) * light;
  const Eigen::Vector3d difference = Eigen::AngleAxisd(-std::atan2(sine, half.z()), Eigen::Vector3d::UnitY()) * turned;
  Eigen::Matrix<double, 1, kInputs> inputs;
  inputs << sine, 0, half.z(), difference.transpose();
  return inputs;
}

class NeuralEncoding : public MeasuredBrdf {
 public:
  NeuralEncoding(MeasuredInfo info, std::vector<Layer> layers)
      : MeasuredBrdf(std::move(info)), layers_(std::move(layers)) {}

  [[nodiscard]] Eigen::MatrixXd evaluate(std::span<const Directions> pairs) const override {
    Matrix x(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(kInputs));
    for (std::size_t i = 0; i < pairs.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = inputs_of(pairs[i]);
    for (std::size_t k = 0; k + 1 < layers_.size(); ++k) x = layers_[k].apply(x).cwiseMax(0);
    return (layers_.back().apply(x).array().exp() - 1).cwiseMax(0);
  }

 private:
  std::vector<Layer> layers_;
};

}  // namespace

bool is_neural_encoding(const std::filesystem::path& path) {
  try {
    const hdf5::InputFile file(path);
    return file.has(weight_of(1, "kernel")) && file.has(weight_of(3, "bias"));
  } catch (const IoError&) {
    return false;
  }
}

std::unique_ptr<MeasuredBrdf> load_neural_encoding(const std::filesystem::path& path) {
  const hdf5::InputFile file(path);
  MeasuredInfo info{
      path.stem().string(),
      "NBRDF neural encoding",
      "sr^-1 without cosine, on the colour scale of MERL; half-vector and difference vector, the former at "
      "azimuth 0; values below 0 are 0 by the encoding itself; not exactly reciprocal",
      {"red", "green", "blue"}};
  return std::make_unique<NeuralEncoding>(
      std::move(info), std::vector<Layer>{read_layer(file, 1, kInputs, kHidden), read_layer(file, 2, kHidden, kHidden),
                                          read_layer(file, 3, kHidden, kOutputs)});
}

}  // namespace lobe
