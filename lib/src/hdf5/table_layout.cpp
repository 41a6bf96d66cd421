#include "hdf5/table_layout.hpp"

#include <numbers>

namespace lobe {
namespace {

using std::numbers::pi;

/// One of the two directions.
struct Side {
  std::string suffix;
  std::string towards;
};

std::vector<double> ring_angles(const HemisphereGrid& grid) {
  std::vector<double> angles;
  for (const Ring& ring : grid.rings()) angles.push_back(ring.theta);
  return angles;
}

std::vector<double> azimuths(std::size_t n_phi, std::size_t count) {
  std::vector<double> angles;
  for (std::size_t k = 0; k < count; ++k) {
    angles.push_back(2 * pi * static_cast<double>(k) / static_cast<double>(n_phi));
  }
  return angles;
}

class LayoutMaker {
 public:
  explicit LayoutMaker(const HemisphereGrid& grid) : grid_(grid) {}

  std::size_t add_axis(const std::string& name, const std::string& long_name, std::vector<double> radians) {
    layout_.axes.push_back({name, long_name, radians.size(), std::move(radians)});
    return layout_.axes.size() - 1;
  }

  std::size_t add_theta(const Side& side) {
    return add_axis("theta" + side.suffix, "polar angle towards the " + side.towards, ring_angles(grid_));
  }

  std::size_t add_phi(const Side& side) {
    return add_axis("phi" + side.suffix, "azimuth towards the " + side.towards, azimuths(grid_.n_phi(), grid_.n_phi()));
  }

  /// Weights of a product grid, equal for all azimuths.
  void add_ring_weight(const Side& side, std::size_t theta) {
    std::vector<double> weights;
    for (const Ring& ring : grid_.rings()) weights.push_back(ring.weight);
    layout_.variables.push_back({"weight" + side.suffix, "projected solid angle of each direction of the ring", "sr",
                                 theta, std::move(weights)});
  }

  /// Nodes that are no product of polar angles and azimuths: numbered, with their directions and weights.
  std::size_t add_nodes(const Side& side) {
    layout_.axes.push_back(
        {"node" + side.suffix, "number of the direction towards the " + side.towards, grid_.nodes(), {}});
    const std::size_t axis = layout_.axes.size() - 1;
    std::vector<double> theta;
    std::vector<double> phi;
    for (const Direction& direction : grid_.directions()) {
      theta.push_back(direction.theta);
      phi.push_back(direction.phi);
    }
    const std::vector<double> weights(grid_.weights().begin(), grid_.weights().end());
    layout_.variables.push_back(
        {"theta" + side.suffix, "polar angle towards the " + side.towards, "radian", axis, theta});
    layout_.variables.push_back({"phi" + side.suffix, "azimuth towards the " + side.towards, "radian", axis, phi});
    layout_.variables.push_back(
        {"weight" + side.suffix, "projected solid angle of the direction", "sr", axis, weights});
    layout_.coordinates += (layout_.coordinates.empty() ? "theta" : " theta") + side.suffix + " phi" + side.suffix;
    return axis;
  }

  TableLayout& layout() { return layout_; }

 private:
  const HemisphereGrid& grid_;
  TableLayout layout_;
};

}  // namespace

std::vector<std::size_t> TableLayout::lengths(const std::vector<std::size_t>& indices) const {
  std::vector<std::size_t> result;
  for (const std::size_t index : indices) result.push_back(axes[index].length);
  return result;
}

TableLayout table_layout(const HemisphereGrid& grid, TableForm form) {
  const Side light{"_in", "light"};
  const Side viewer{"_out", "viewer"};
  LayoutMaker maker(grid);
  TableLayout& layout = maker.layout();
  if (!grid.is_product()) {
    layout.in = {maker.add_nodes(light)};
    layout.out = {maker.add_nodes(viewer)};
    layout.viewer = layout.out;
    layout.ring_in = maker.add_axis("ring_in", "polar angle of the ring towards the light", ring_angles(grid));
    layout.ring_out = maker.add_axis("ring_out", "polar angle of the ring towards the viewer", ring_angles(grid));
    return layout;
  }
  layout.ring_in = maker.add_theta(light);
  layout.in = {layout.ring_in};
  if (form == TableForm::general) layout.in.push_back(maker.add_phi(light));
  layout.ring_out = maker.add_theta(viewer);
  layout.out = {layout.ring_out};
  if (form == TableForm::general) layout.out.push_back(maker.add_phi(viewer));
  layout.viewer = layout.out;
  maker.add_ring_weight(light, layout.ring_in);
  maker.add_ring_weight(viewer, layout.ring_out);
  if (form == TableForm::isotropic) {
    const std::size_t delta_phi =
        maker.add_axis("delta_phi", "azimuth phi_out - phi_in: 0 on the retro side, pi on the mirror side",
                       azimuths(grid.n_phi(), grid.half_azimuths()));
    layout.out.push_back(delta_phi);
    std::vector<double> multiplicity(grid.half_azimuths(), 2.0);
    multiplicity.front() = multiplicity.back() = 1.0;
    layout.variables.push_back({"multiplicity", "number of azimuths of the full circle that a value of brdf stands for",
                                "1", delta_phi, std::move(multiplicity)});
  }
  return layout;
}

}  // namespace lobe
