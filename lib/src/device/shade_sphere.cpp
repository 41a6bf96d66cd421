#include "device/shade_sphere.hpp"

#include <algorithm>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"

namespace lobe {

SphereShader::SphereShader(const Device& device, const std::vector<LobeBatch>& batches, const Eigen::MatrixXd& mix,
                           Precision precision)
    : device_(device), rows_(static_cast<std::size_t>(mix.rows())) {
  checked("cannot prepare the shading of spheres", [&] {
    Eigen::Index lobe = 0;
    for (const LobeBatch& batch : batches) {
      std::vector<double> numbers;
      for (std::size_t k = 0; k < batch.coefficients.size(); ++k, ++lobe) {
        const auto of_lobe = batch.numbers(k);
        numbers.insert(numbers.end(), of_lobe.begin(), of_lobe.end());
        for (const double share : mix.col(lobe)) numbers.push_back(share);
      }
      const auto program =
          build_lobe_program(device_, batch.kernel, "lobes/shade_sphere.cl", precision, "lobes/pair_geometry.clh");
      models_.push_back(
          {make_kernel(program, "shade_sphere", 11), constant_buffer(device_, numbers), batch.coefficients.size()});
      require_sound_model(device_, batch.kernel, "shade_sphere.cl", precision);
    }
  });
}

Eigen::MatrixXd SphereShader::shade(std::span<const SpherePart> parts, std::span<const double> nodes,
                                    std::span<const double> weights, std::span<const std::array<double, 4>> lights) {
  const std::size_t width = device_.implementation().pack_width;
  const std::size_t packs = (parts.size() + width - 1) / width;
  const std::size_t stride = packs * width;
  Eigen::MatrixXd radiance =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_), static_cast<Eigen::Index>(parts.size()));
  if (parts.empty() || lights.empty() || models_.empty()) return radiance;
  checked("cannot shade a sphere", [&] {
    std::vector<double> limits(4 * stride);  // parts that fill up the last pack are empty
    for (std::size_t k = 0; k < parts.size(); ++k) {
      limits[k] = parts[k].x_low;
      limits[stride + k] = parts[k].x_high;
      limits[2 * stride + k] = parts[k].y_low;
      limits[3 * stride + k] = parts[k].y_high;
    }
    std::vector<double> rule(nodes.begin(), nodes.end());
    rule.insert(rule.end(), weights.begin(), weights.end());
    std::vector<double> light_numbers;
    for (const auto& light : lights) light_numbers.insert(light_numbers.end(), light.begin(), light.end());
    const cl::Buffer part_buffer = constant_buffer(device_, limits);
    const cl::Buffer rule_buffer = constant_buffer(device_, rule);
    const cl::Buffer light_buffer = constant_buffer(device_, light_numbers);
    const cl::Buffer target = make_workspace(device_, rows_ * stride * sizeof(double));
    auto& queue = device_.implementation().queue;
    bool is_first = true;
    for (auto& [kernel, coefficients, lobes] : models_) {
      set_arguments(kernel, part_buffer, static_cast<cl_uint>(stride), rule_buffer, static_cast<cl_uint>(nodes.size()),
                    light_buffer, static_cast<cl_uint>(lights.size()), coefficients, static_cast<cl_uint>(lobes),
                    static_cast<cl_uint>(rows_), static_cast<cl_uint>(is_first ? 0 : 1), target);
      queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(packs), device_.implementation().work_group(1));
      is_first = false;
    }
    std::vector<double> found(rows_ * stride);
    queue.enqueueReadBuffer(target, CL_TRUE, 0, found.size() * sizeof(double), found.data());
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t k = 0; k < parts.size(); ++k) {
        radiance(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k)) = found[row * stride + k];
      }
    }
  });
  return radiance;
}

}  // namespace lobe
