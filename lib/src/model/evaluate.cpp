#include "model/evaluate.hpp"

#include <cmath>
#include <numbers>

#include "core/text.hpp"
#include "device/evaluate_lobes.hpp"
#include "hemisphere/geometry.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/lobes.hpp"
#include "model/values.hpp"

namespace lobe {
namespace {

void check(const Directions& directions) {
  const auto in_hemisphere = [](double theta) { return theta >= 0 && theta <= std::numbers::pi / 2; };
  if (!in_hemisphere(directions.theta_in) || !in_hemisphere(directions.theta_out)) {
    throw ArgumentError("angle from the normal of (" + shortest(directions.theta_in) + ", " +
                        shortest(directions.theta_out) + ") rad; expected both in [0, pi/2]");
  }
  if (!std::isfinite(directions.delta_phi)) throw ArgumentError("delta_phi is no finite number");
  if (!std::isfinite(directions.phi_in)) throw ArgumentError("phi_in is no finite number");
}

bool above_horizon(const Directions& directions) {
  return directions.theta_in < std::numbers::pi / 2 && directions.theta_out < std::numbers::pi / 2;
}

}  // namespace

void require_finite(const Eigen::MatrixXd& values, const std::string& name, std::span<const Directions> directions) {
  if (values.allFinite()) return;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    if (values.row(i).allFinite()) continue;
    const Directions& pair = directions[static_cast<std::size_t>(i)];
    throw NumericError("'" + name + "' is no finite number at theta_in = " + shortest(pair.theta_in / kDegree) +
                       ", theta_out = " + shortest(pair.theta_out / kDegree) + ", delta_phi = " +
                       shortest(pair.delta_phi / kDegree) + " degrees; check the parameters of the material");
  }
}

Eigen::MatrixXd evaluate(const Device& device, const Material& material, std::span<const Directions> directions,
                         Precision precision) {
  Eigen::MatrixXd values = unchecked_values(device, material, directions, precision);
  require_finite(values, material.name, directions);
  return values;
}

Eigen::MatrixXd unchecked_values(const Device& device, const Material& material, std::span<const Directions> directions,
                                 Precision precision) {
  const LobeSet lobes = make_lobe_set({&material, 1}, {.with_anisotropic = true});
  for (const auto& pair : directions) check(pair);
  const auto rows = static_cast<Eigen::Index>(directions.size());
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(lobes.channels()));
  if (directions.empty()) return values;

  const std::size_t capacity = std::min<std::size_t>(directions.size(), 4096);
  LobeEvaluator evaluator(device, lobes.batches, precision, capacity);
  NodeBlock block(capacity, evaluator.needs_tangents());
  Eigen::Index done = 0;
  const auto flush = [&] {
    const Eigen::MatrixXd samples = values_at(evaluator, block);  // lobes x nodes
    for (std::size_t c = 0; c < lobes.channels(); ++c) {
      values.block(done, static_cast<Eigen::Index>(c), samples.cols(), 1) = (lobes.mix[c] * samples).transpose();
    }
    done += samples.cols();
    block.clear();
  };
  for (const auto& pair : directions) {
    const Directions seen = above_horizon(pair) ? pair : Directions{};
    auto node = node_of_directions(seen);
    if (!above_horizon(pair)) node[NodeBlock::factor] = 0;
    if (block.has_tangents()) {
      block.push(node, tangents_of_directions(seen));
    } else {
      block.push(node);
    }
    if (block.full()) flush();
  }
  if (block.size() > 0) flush();
  return values;
}

}  // namespace lobe
