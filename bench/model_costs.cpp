#include "model_costs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>

#include "device/error.hpp"
#include "device/evaluate_lobes.hpp"
#include "device/implementation.hpp"
#include "device/program.hpp"
#include "hemisphere/geometry.hpp"
#include "measure.hpp"

namespace bench {
namespace {

// Independent copies of an operation in the two programs whose difference is its cost; the fewer ones already take
// longer than loads and stores, which would hide the first.
constexpr std::size_t kFewCopies = 8;
constexpr std::size_t kManyCopies = 24;

/// Pairs of directions, the same for all.
lobe::NodeBlock random_nodes(bool with_tangents) {
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> theta(0, 0.49 * std::numbers::pi);
  std::uniform_real_distribution<double> phi(-std::numbers::pi, std::numbers::pi);
  lobe::NodeBlock block(kNodes, with_tangents);
  for (std::size_t node = 0; node < kNodes; ++node) {
    const lobe::Directions pair{theta(engine), theta(engine), phi(engine), phi(engine)};
    if (with_tangents) {
      block.push(lobe::node_of_directions(pair), lobe::tangents_of_directions(pair));
    } else {
      block.push(lobe::node_of_directions(pair));
    }
  }
  return block;
}

std::string read(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || text.str().empty()) throw std::runtime_error("cannot read " + path);
  return text.str();
}

/// A model that is the sum of so many copies of one operation, on arguments in (0, 1).
std::string operation_source(const std::string& operation, std::size_t copies) {
  std::string sum;
  for (std::size_t copy = 0; copy < copies; ++copy) {
    const std::string argument =
        fmt::format("c.c{} * g.{}", copy % lobe::kCoefficients, copy < lobe::kCoefficients ? "cos_i" : "cos_h");
    const std::string term = operation.empty()       ? argument
                             : operation == "divide" ? fmt::format("g.cos_o / ({})", argument)
                             : operation == "atan2"  ? fmt::format("atan2(g.cos_o, {})", argument)
                                                     : fmt::format("{}({})", operation, argument);
    sum += (copy == 0 ? "" : " + ") + term;
  }
  return "#include \"prelude.clh\"\nreal operation(const geometry g, const coefficients c) { return " + sum + "; }\n";
}

/// Runs kernels/lobes/evaluate_lobes.cl with an operation for a model, as LobeEvaluator does with models.
class OperationRunner {
 public:
  OperationRunner(const lobe::Device& device, const std::string& operation, std::size_t copies,
                  lobe::Precision precision)
      : device_(device) {
    lobe::checked("cannot build the operation " + operation, [&] {
      auto& implementation = device_.implementation();
      cl::Program program(implementation.context,
                          {operation_source(operation, copies), read(LOBE_KERNELS "/lobes/evaluate_lobes.cl")});
      program.build(implementation.device,
                    fmt::format("-cl-std=CL1.2 -I {} -D REAL_BITS={} -D REAL_WIDTH=8 -D MODEL=operation", LOBE_KERNELS,
                                precision == lobe::Precision::double_precision ? 64 : 32)
                        .c_str());
      kernel_ = lobe::make_kernel(program, "evaluate_lobes", 8);
      std::vector<double> coefficients(kLobes * lobe::kCoefficients);
      for (std::size_t i = 0; i < coefficients.size(); ++i) {
        coefficients[i] = 0.1 + 0.8 * static_cast<double>(i) / static_cast<double>(coefficients.size());
      }
      coefficients_ = cl::Buffer(implementation.context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                                 coefficients.size() * sizeof(double), coefficients.data());
      geometry_ = cl::Buffer(implementation.context, CL_MEM_READ_ONLY, nodes_.data().size_bytes());
      values_ = cl::Buffer(implementation.context, CL_MEM_READ_WRITE, kLobes * kNodes * sizeof(double));
    });
  }

  void evaluate() {
    lobe::checked("cannot run an operation", [&] {
      auto& queue = device_.implementation().queue;
      queue.enqueueWriteBuffer(geometry_, CL_TRUE, 0, nodes_.data().size_bytes(), nodes_.data().data());
      constexpr std::size_t kNodesPerItem = 32;
      kernel_.setArg(0, geometry_);
      kernel_.setArg(1, static_cast<cl_uint>(kNodes));
      kernel_.setArg(2, static_cast<cl_uint>(kNodes));
      kernel_.setArg(3, static_cast<cl_uint>(kNodesPerItem));
      kernel_.setArg(4, coefficients_);
      kernel_.setArg(5, static_cast<cl_uint>(kLobes / 8));
      kernel_.setArg(6, cl_uint{0});
      kernel_.setArg(7, values_);
      queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(kNodes / kNodesPerItem), cl::NDRange(1));
    });
    lobe::finish(device_);
  }

 private:
  lobe::Device device_;
  lobe::NodeBlock nodes_ = random_nodes(false);
  cl::Kernel kernel_;
  cl::Buffer coefficients_;
  cl::Buffer geometry_;
  cl::Buffer values_;
};

Contender model_contender(const lobe::Device& device, const CountedLobes& model, lobe::Precision precision) {
  const auto evaluator =
      std::make_shared<lobe::LobeEvaluator>(device, std::vector<lobe::LobeBatch>{model.batch}, precision, kNodes);
  const auto nodes = std::make_shared<lobe::NodeBlock>(random_nodes(model.batch.kernel.is_anisotropic));
  return {model.name, [evaluator, nodes, device] {
            evaluator->evaluate(*nodes);
            lobe::finish(device);
          }};
}

Contender operation_contender(const lobe::Device& device, const std::string& operation, std::size_t copies,
                              lobe::Precision precision) {
  const auto evaluator = std::make_shared<OperationRunner>(device, operation, copies, precision);
  return {operation, [evaluator] { evaluator->evaluate(); }};
}

}  // namespace

Ratio ratio_of(const std::vector<double>& rounds, const std::vector<double>& others) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < rounds.size(); ++i) ratios.push_back(rounds[i] / others[i]);
  const double middle = median(ratios);
  for (double& ratio : ratios) ratio = std::abs(ratio - middle);
  return {middle, median(ratios)};
}

CostTable measure_costs(const lobe::Device& device, const std::vector<CountedLobes>& models, lobe::Precision precision,
                        int rounds) {
  std::vector<OperationCounts> counts;
  std::map<std::string, std::size_t> operations;  // and their places among the contenders
  for (const auto& model : models) {
    counts.push_back(count_operations(
        {model.batch.kernel.model, model.batch.kernel.is_anisotropic, static_cast<double>(kLobes) / 8, model.terms},
        precision));
    for (const auto& [name, count] : counts.back()) operations[name] = 0;
  }
  std::vector<Contender> contenders;
  for (const auto& model : models) contenders.push_back(model_contender(device, model, precision));
  const std::size_t base = contenders.size();
  contenders.push_back(operation_contender(device, "", 1, precision));
  for (auto& [name, place] : operations) {
    place = contenders.size();
    for (const std::size_t copies : {kFewCopies, kManyCopies}) {
      contenders.push_back(operation_contender(device, name, copies, precision));
    }
  }

  const auto timings = measure_together(contenders, rounds, Clock::processors);

  // Processor seconds over the number of processors: what passes when all of them are at work.
  const double evaluations = static_cast<double>(kLobes * kNodes) * device.info().compute_units;
  CostTable table;
  table.base = timings[base].seconds / evaluations;
  for (const auto& [name, place] : operations) {
    const double added = timings[place + 1].seconds - timings[place].seconds;
    table.operations[name] = std::max(0.0, added) / evaluations / static_cast<double>(kManyCopies - kFewCopies);
  }
  const auto phong = std::ranges::find_if(models, [](const CountedLobes& model) { return model.name == "phong"; });
  const auto& reference = timings[static_cast<std::size_t>(phong - models.begin())].rounds;
  for (std::size_t i = 0; i < models.size(); ++i) {
    double operations_alone = 0;
    for (const auto& [name, count] : counts[i]) operations_alone += count * table.operations[name];
    const double bound = std::max(table.base, operations_alone);
    const double seconds = timings[i].seconds / evaluations;
    table.models.push_back(
        {seconds, timings[i].rounds, ratio_of(timings[i].rounds, reference), bound / seconds, counts[i]});
  }
  return table;
}

std::string vector_extension() {
  if (__builtin_cpu_supports("avx512f")) return "registers have 512 bits";
  if (__builtin_cpu_supports("avx2")) return "registers have 256 bits";
  return "registers are narrower than 256 bits";
}

}  // namespace bench
