#include "model/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

struct MaterialValues::Implementation {
  Implementation(const Device& device, const Material& material, Precision precision, NodeMaking node_making,
                 std::size_t at_once)
      : making(node_making),
        lobes(make_lobe_set({&material, 1}, {.with_anisotropic = true})),
        evaluator(device, lobes.batches, precision, at_once),
        block(at_once, evaluator.needs_tangents()) {}

  void place(std::span<const Directions> directions) {
    block.clear();
    for (const auto& pair : directions) {
      const bool is_seen = above_horizon(pair);
      const Directions seen = is_seen ? pair : Directions{};
      const double factor = is_seen ? 1 : 0;
      if (making == NodeMaking::quickly) {
        place_directions(block, seen, factor);
        continue;
      }
      auto node = node_of_directions(seen);
      node[NodeBlock::factor] = factor;
      if (block.has_tangents()) {
        block.push(node, tangents_of_directions(seen));
      } else {
        block.push(node);
      }
    }
    if (making == NodeMaking::quickly) complete_directions(block, 0, block.size());
  }

  NodeMaking making;
  LobeSet lobes;
  LobeEvaluator evaluator;
  NodeBlock block;
};

MaterialValues::MaterialValues(const Device& device, const Material& material, Precision precision, NodeMaking making,
                               std::size_t at_once)
    : implementation_(
          std::make_unique<Implementation>(device, material, precision, making, std::max<std::size_t>(at_once, 1))) {}

MaterialValues::~MaterialValues() = default;

Eigen::MatrixXd MaterialValues::at(std::span<const Directions> directions) {
  const LobeSet& lobes = implementation_->lobes;
  const NodeBlock& block = implementation_->block;
  for (const auto& pair : directions) check(pair);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(directions.size()), static_cast<Eigen::Index>(lobes.channels()));
  for (std::size_t done = 0; done < directions.size(); done += block.size()) {
    implementation_->place(directions.subspan(done, std::min(block.capacity(), directions.size() - done)));
    const Eigen::MatrixXd samples = values_at(implementation_->evaluator, block);  // lobes x nodes
    for (std::size_t c = 0; c < lobes.channels(); ++c) {
      values.block(static_cast<Eigen::Index>(done), static_cast<Eigen::Index>(c), samples.cols(), 1) =
          (lobes.mix[c] * samples).transpose();
    }
  }
  return values;
}

Eigen::MatrixXd unchecked_values(const Device& device, const Material& material, std::span<const Directions> directions,
                                 Precision precision) {
  // Before kernels are built for nothing.
  for (const auto& pair : directions) check(pair);
  if (directions.empty()) {
    const LobeSet lobes = make_lobe_set({&material, 1}, {.with_anisotropic = true});
    return Eigen::MatrixXd::Zero(0, static_cast<Eigen::Index>(lobes.channels()));
  }
  const std::size_t at_once = std::min<std::size_t>(directions.size(), MaterialValues::kAtOnce);
  return MaterialValues(device, material, precision, NodeMaking::closely, at_once).at(directions);
}

}  // namespace lobe
