// Distances between the members of two families of models, under light from everywhere and from single directions, and
// a map of them.
#include <cstdio>
#include <lobe/lobe.hpp>
#include <string>
#include <vector>

int main() {
  try {
    std::vector<lobe::Material> materials;
    for (const double n : {5.0, 10.0, 20.0, 40.0}) materials.push_back(lobe::make_material("phong", {{"n", n}}));
    for (const double m : {0.1, 0.2, 0.3, 0.4}) materials.push_back(lobe::make_material("ward", {{"m", m}}));

    const auto device = lobe::Device::choose();
    for (const auto& lighting : {lobe::Lighting::point(), lobe::Lighting::daylight()}) {
      const lobe::Metric metric = lobe::measure(device, materials, lighting, {.tolerance = 1e-6}).combined;

      std::printf("distances under %s\n", lighting.name().c_str());
      for (Eigen::Index i = 0; i < metric.distance.rows(); ++i) {
        std::printf("%-12s", materials[static_cast<std::size_t>(i)].name.c_str());
        for (Eigen::Index j = 0; j < metric.distance.cols(); ++j) std::printf(" %8.5f", metric.distance(i, j));
        std::printf("\n");
      }
      std::printf("no distance is off by more than %.0e\n\n", metric.distance_error.maxCoeff());

      const lobe::Embedding map = lobe::classical_scaling(metric.distance);
      std::printf("map, by classical scaling\n");
      for (Eigen::Index i = 0; i < map.coordinates.rows(); ++i) {
        std::printf("%-12s %8.4f %8.4f\n", materials[static_cast<std::size_t>(i)].name.c_str(), map.coordinates(i, 0),
                    map.coordinates(i, 1));
      }
      std::printf("\n");
    }
    return 0;
  } catch (const lobe::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
