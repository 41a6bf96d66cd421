// What a user of the library writes: the distance of two materials under point light.
#include <cstdio>
#include <lobe/lobe.hpp>
#include <vector>

#if defined(__OPENCL_CL_H) || defined(CL_HPP_) || defined(H5public_H) || defined(_H5public_H)
#error "the public headers include those of OpenCL or HDF5"
#endif

int main() {
  try {
    const auto device = lobe::Device::choose();
    const auto matt = lobe::make_material("lambert");
    const auto gloss = lobe::make_material("phong", {{"n", 3}});
    auto metric = lobe::measure(device, std::vector{matt, gloss}, lobe::Lighting::point()).combined;
    std::printf("lobe %s: distance %.9f, error below %.1e\n", LOBE_VERSION, metric.distance(0, 1),
                metric.distance_error(0, 1));
    metric.gram.resize(8, 8);  // frees what the library has allocated
    return 0;
  } catch (const lobe::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
