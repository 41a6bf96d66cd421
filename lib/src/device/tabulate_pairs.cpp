#include "device/tabulate_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "device/buffers.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "device/self_test.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{256} << 20;  // of values per launch
constexpr std::size_t kChunkPacks = 64;                      // columns per work-item of a CPU device, in packs

/// A rounded pi would leave opposite directions off each other's plane.
double without_rounding(double x) {
  return std::abs(x) < 1e-15 ? 0 : x;
}

/// 3 x points x stride coordinates; what fills a row up repeats its last direction.
std::vector<double> coordinates(const DirectionSet& set, std::size_t stride) {
  std::vector<double> xyz(3 * set.points * stride);
  const std::size_t plane = set.points * stride;
  for (std::size_t s = 0; s < set.points; ++s) {
    for (std::size_t i = 0; i < stride; ++i) {
      const Direction& d = set.directions[std::min(i, set.count - 1) * set.points + s];
      const double sine = std::sin(d.theta);
      const std::size_t at = s * stride + i;
      xyz[at] = sine * without_rounding(std::cos(d.phi));
      xyz[plane + at] = sine * without_rounding(std::sin(d.phi));
      xyz[2 * plane + at] = std::cos(d.theta);
    }
  }
  return xyz;
}

/// The lobes of one batch as the kernel takes them: their numbers and the weight.
std::vector<double> lobe_rows(const LobeBatch& batch, std::size_t index, std::span<const WeightedLobe> lobes) {
  std::vector<double> rows;
  for (const auto& lobe : lobes) {
    if (lobe.batch != index || lobe.weight == 0) continue;
    const auto numbers = batch.numbers(lobe.lobe);
    rows.insert(rows.end(), numbers.begin(), numbers.end());
    rows.push_back(lobe.weight);
  }
  return rows;
}

struct ModelLaunch {
  cl::Kernel kernel;
  cl::Buffer coefficients;
  std::size_t lobes = 0;
};

std::vector<ModelLaunch> prepare_models(const Device& device, const std::vector<LobeBatch>& batches,
                                        std::span<const WeightedLobe> lobes, Precision precision) {
  std::vector<ModelLaunch> launches;
  for (std::size_t b = 0; b < batches.size(); ++b) {
    auto rows = lobe_rows(batches[b], b, lobes);
    if (rows.empty()) continue;
    const auto program =
        build_lobe_program(device, batches[b].kernel, "lobes/tabulate_pairs.cl", precision, "lobes/pair_geometry.clh");
    launches.push_back({make_kernel(program, "tabulate_pairs", 14), constant_buffer(device, rows),
                        rows.size() / (batches[b].numbers_per_lobe() + 1)});
    require_sound_model(device, batches[b].kernel, "tabulate_pairs.cl", precision);
  }
  return launches;
}

}  // namespace

void tabulate_pairs(const Device& device, const std::vector<LobeBatch>& batches, std::span<const WeightedLobe> lobes,
                    Precision precision, const DirectionSet& rows, const DirectionSet& columns,
                    std::span<const unsigned> first_column, std::span<double> values) {
  if (values.size() != rows.count * columns.count || (!first_column.empty() && first_column.size() != rows.count)) {
    throw ArgumentError("tabulate_pairs: sizes do not fit");
  }
  if (values.empty()) return;
  checked("cannot tabulate a model", [&] {
    auto& implementation = device.implementation();
    const std::size_t width = implementation.pack_width;
    const std::size_t stride = round_up(columns.count, width);
    auto launches = prepare_models(device, batches, lobes, precision);
    if (launches.empty()) {
      std::ranges::fill(values, 0.0);
      return;
    }
    auto row_data = coordinates(rows, rows.count);
    auto column_data = coordinates(columns, stride);
    std::vector<cl_uint> first(rows.count, 0);
    std::ranges::copy(first_column, first.begin());
    const cl::Buffer row_buffer = constant_buffer(device, row_data);
    const cl::Buffer column_buffer = constant_buffer(device, column_data);
    const cl::Buffer first_buffer = constant_buffer(device, first);
    const std::size_t chunk = width == 1 ? 1 : kChunkPacks;
    const std::size_t chunks = round_up(stride / width, chunk) / chunk;
    const std::size_t block = std::max<std::size_t>(1, kBlockBytes / (columns.count * sizeof(double)));
    for (std::size_t row = 0; row < rows.count; row += block) {
      const std::size_t count = std::min(block, rows.count - row);
      const std::size_t bytes = count * columns.count * sizeof(double);
      const cl::Buffer target(implementation.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes,
                              values.data() + row * columns.count);
      const FinishOnFailure finish(device);
      bool is_first = true;
      for (auto& launch : launches) {
        auto& kernel = launch.kernel;
        kernel.setArg(0, row_buffer);
        kernel.setArg(1, static_cast<cl_uint>(rows.count));
        kernel.setArg(2, static_cast<cl_uint>(rows.points));
        kernel.setArg(3, static_cast<cl_uint>(row));
        kernel.setArg(4, column_buffer);
        kernel.setArg(5, static_cast<cl_uint>(columns.count));
        kernel.setArg(6, static_cast<cl_uint>(stride));
        kernel.setArg(7, static_cast<cl_uint>(columns.points));
        kernel.setArg(8, first_buffer);
        kernel.setArg(9, launch.coefficients);
        kernel.setArg(10, static_cast<cl_uint>(launch.lobes));
        kernel.setArg(11, static_cast<cl_uint>(chunk));
        kernel.setArg(12, static_cast<cl_uint>(is_first ? 0 : 1));
        kernel.setArg(13, target);
        implementation.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(chunks, count),
                                                  implementation.work_group(2));
        is_first = false;
      }
      // Mapping is what makes the host see what the device wrote.
      void* mapped = implementation.queue.enqueueMapBuffer(target, CL_TRUE, CL_MAP_READ, 0, bytes);
      implementation.queue.enqueueUnmapMemObject(target, mapped);
      implementation.queue.finish();
    }
  });
}

}  // namespace lobe
