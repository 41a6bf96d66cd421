#include "device/self_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include "device/accumulate_differences.hpp"
#include "device/accumulate_gram.hpp"
#include "device/buffers.hpp"
#include "device/draw_directions.hpp"
#include "device/draw_each.hpp"
#include "device/error.hpp"
#include "device/implementation.hpp"
#include "device/isotropic_product.hpp"
#include "device/known_values.hpp"
#include "device/map_segments.hpp"
#include "device/multiply_matrices.hpp"
#include "device/shade_sphere.hpp"
#include "device/sum_segments.hpp"
#include "device/tabulate_pairs.hpp"
#include "device/tabulate_patch_light.hpp"
#include "lobe/core/error.hpp"
#include "lobe/device/self_test.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

// A few operations, none of them ill-conditioned at what is computed here; single precision of models has conditions of
// up to 100 (kernels/models).
constexpr double kDouble = 1e-11;
constexpr double kSingle = 2e-5;
constexpr double kTwoThirds = 1e-6;  // of accumulate_pairs.cl, 2e-7 for each term

constexpr double kFloor = 1e-6;  // values of a lobe are compared as shares of this much of the largest, at least

double allowed(Precision precision) {
  return precision == Precision::double_precision ? kDouble : kSingle;
}

/// The largest deviation of some numbers as a share of what they have to be.
class Comparison {
 public:
  /// \param floor of what deviations are shares of: smaller numbers need not have as many digits
  explicit Comparison(double allowed, double floor = 1e-300) : floor_(floor), result_{0, allowed} {}
  void add(double found, double expected) {
    const double size = std::max(std::abs(expected), floor_);
    const double deviation = std::abs(found - expected) / size;
    if (!(deviation <= result_.deviation)) result_.deviation = deviation;
    if (std::isnan(deviation)) result_.deviation = std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] Accuracy result() const { return result_; }

 private:
  double floor_;
  Accuracy result_;
};

/// Numbers from 0.25 to 1, the same on every machine.
class Numbers {
 public:
  double operator()() { return 0.25 + 0.75 * static_cast<double>(engine_()) / static_cast<double>(engine_.max()); }
  std::vector<double> list(std::size_t count) {
    std::vector<double> numbers(count);
    std::ranges::generate(numbers, std::ref(*this));
    return numbers;
  }

 private:
  std::minstd_rand engine_;
};

UnitVector unit_vector(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

std::pair<UnitVector, UnitVector> vectors_of(const Directions& pair) {
  return {unit_vector(pair.theta_in, pair.phi_in), unit_vector(pair.theta_out, pair.phi_in + pair.delta_phi)};
}

/// A node for vectors that are far enough from the mirror direction and from the horizon for the plain formulas.
void push(NodeBlock& block, const UnitVector& in, const UnitVector& out) {
  const UnitVector sum{in[0] + out[0], in[1] + out[1], in[2] + out[2]};
  const double length = std::hypot(sum[0], sum[1], sum[2]);
  const double mirrored = in[2] * out[2] - in[0] * out[0] - in[1] * out[1];
  const double slope_x = sum[0] / sum[2];
  const double slope_y = sum[1] / sum[2];
  const double cos_h = sum[2] / length;
  const NodeBlock::Node node{in[2],
                             out[2],
                             cos_h,
                             length / 2,
                             slope_x * slope_x + slope_y * slope_y,
                             std::log(cos_h),
                             mirrored > 0 ? std::log(mirrored) : -1e30,
                             1.0};
  if (block.has_tangents()) {
    block.push(node, {slope_x, slope_y, in[0], in[1]});
  } else {
    block.push(node);
  }
}

/// A curve of albedos that is constant on each of its panels, kernels/lobes/pumping.clh, and on the first halves of
/// them.
constexpr double kFirstAlbedo = 0.55;
constexpr double kAlbedoStep = 0.01;
constexpr double kInFirstHalf = 0.005;
std::vector<double> stepped_curve(std::size_t parts) {
  std::vector<double> curve(kCurveNumbers, 0.0);
  for (std::size_t panel = 0; panel < kCurvePanels; ++panel) {
    curve[panel * kCurveTerms] = kFirstAlbedo + kAlbedoStep * static_cast<double>(panel);
  }
  for (std::size_t panel = 0; parts > 0 && panel <= kCurvePanels; ++panel) {
    curve.push_back(static_cast<double>(std::min(panel, parts)));
  }
  for (std::size_t part = 0; part < parts; ++part) {  // of one panel each
    const double from = 2 * static_cast<double>(part);
    curve.insert(curve.end(), {from, from + 0.5, part < kCurvePanels ? curve[part * kCurveTerms] + kInFirstHalf : 0.0});
    curve.insert(curve.end(), kCurveTerms - 1, 0.0);
  }
  return curve;
}

double stepped_albedo(double cosine, std::size_t parts) {
  std::size_t panel = 0;
  double place = 0;  // from 0 to 1 on the panel
  if (cosine > 0.5) {
    const double sine = std::sqrt((1 - cosine) / 2);
    while (panel + 1 < kCurveNormalPanels && sine < std::ldexp(1.0, -static_cast<int>(panel) - 2)) ++panel;
    const double end = std::ldexp(1.0, -static_cast<int>(panel) - 1);
    place = panel + 1 < kCurveNormalPanels ? 2 * sine / end - 1 : sine / end;
  } else {
    panel = kCurveNormalPanels;
    while (panel + 1 < kCurvePanels && cosine < std::ldexp(1.0, -static_cast<int>(panel - kCurveNormalPanels) - 2)) {
      ++panel;
    }
    place = 2 * cosine / std::ldexp(1.0, -static_cast<int>(panel - kCurveNormalPanels) - 1) - 1;
  }
  const bool is_in_part = panel < parts && place <= 0.5;
  return kFirstAlbedo + kAlbedoStep * static_cast<double>(panel) + (is_in_part ? kInFirstHalf : 0);
}

double pumping_divisor(const LobeKernel& kernel, double cos_i, double cos_o) {
  const double in = stepped_albedo(cos_i, kernel.curve_parts);
  const double out = stepped_albedo(cos_o, kernel.curve_parts);
  const double albedo = std::max(in, out);
  const double cosine = std::max(cos_i, cos_o);
  double divisor = 1;
  for (std::size_t k = 0; k < kernel.curves; ++k) {
    if (kernel.pumping == "g1") divisor *= albedo;
    if (kernel.pumping == "g2") divisor *= std::max(albedo, cosine);
    if (kernel.pumping == "controlled") divisor = std::max(divisor * albedo, cosine);
    if (kernel.pumping == "complement") divisor /= (1 - in) * (1 - out);
    if (kernel.pumping == "viewer") divisor *= out;
  }
  return divisor;
}

/// A lobe of a kernel and what it has to give at kKnownPairs.
struct KnownLobe {
  LobeBatch batch;
  std::array<double, kKnownPairs.size()> values;

  /// Single precision has no numbers for the flanks of some lobes.
  [[nodiscard]] double floor() const {
    return kFloor * std::abs(*std::ranges::max_element(values, {}, [](double x) { return std::abs(x); }));
  }
};

std::optional<KnownLobe> known_lobe(const LobeKernel& kernel) {
  const auto model = std::ranges::find(known_models(), kernel.model, &KnownModel::kernel);
  if (!kernel.source.empty() || model == known_models().end()) return std::nullopt;
  KnownLobe known{{.kernel = kernel, .coefficients = {}}, model->values};
  std::array<double, kCoefficients> coefficients{};
  std::ranges::copy(model->coefficients, coefficients.begin());
  for (std::size_t k = 0; k < kernel.factors.size(); ++k) {
    const auto factor = std::ranges::find(known_factors(), kernel.factors[k], &KnownFactor::factor);
    if (factor == known_factors().end()) return std::nullopt;
    std::ranges::copy(factor->coefficients, coefficients.begin() + static_cast<std::ptrdiff_t>(10 + 2 * k));
    for (std::size_t i = 0; i < known.values.size(); ++i) known.values[i] *= factor->values[i];
  }
  if (kernel.curves > 0) {
    std::vector<double> curves;
    for (std::size_t k = 0; k < kernel.curves; ++k) {
      const auto curve = stepped_curve(kernel.curve_parts);
      curves.insert(curves.end(), curve.begin(), curve.end());
    }
    known.batch.curves.push_back(std::move(curves));
    for (std::size_t i = 0; i < known.values.size(); ++i) {
      known.values[i] /= pumping_divisor(kernel, std::cos(kKnownPairs[i].theta_in), std::cos(kKnownPairs[i].theta_out));
    }
  }
  known.batch.coefficients.push_back(coefficients);
  return known;
}

Eigen::MatrixXd values_at(const Device& device, const LobeBatch& batch, Precision precision,
                          std::span<const std::pair<UnitVector, UnitVector>> pairs) {
  LobeEvaluator evaluator(device, {batch}, precision, pairs.size());
  NodeBlock block(pairs.size(), evaluator.needs_tangents());
  for (const auto& [in, out] : pairs) push(block, in, out);
  return values_at(evaluator, block);
}

Accuracy test_values(const Device& device, const KnownLobe& known, Precision precision) {
  std::vector<std::pair<UnitVector, UnitVector>> pairs;
  for (const auto& pair : kKnownPairs) pairs.push_back(vectors_of(pair));
  const auto values = values_at(device, known.batch, precision, pairs);
  Comparison comparison(allowed(precision), known.floor());
  for (std::size_t i = 0; i < known.values.size(); ++i) {
    comparison.add(values(0, static_cast<Eigen::Index>(i)), known.values[i]);
  }
  return comparison.result();
}

Accuracy test_table(const Device& device, const KnownLobe& known, Precision precision) {
  constexpr std::size_t kCount = kKnownPairs.size();
  DirectionSet in{.count = kCount, .directions = {}};
  DirectionSet out{.count = kCount, .directions = {}};
  for (const auto& pair : kKnownPairs) {
    in.directions.push_back({pair.theta_in, pair.phi_in});
    out.directions.push_back({pair.theta_out, pair.phi_in + pair.delta_phi});
  }
  const std::vector<WeightedLobe> lobes{{.weight = 0.5}};
  std::vector<double> values(kCount * kCount);
  tabulate_pairs(device, {known.batch}, lobes, precision, in, out, {}, values);
  Comparison comparison(allowed(precision), known.floor());
  for (std::size_t i = 0; i < kCount; ++i) comparison.add(values[i * kCount + i], 0.5 * known.values[i]);
  return comparison.result();
}

const std::vector<ProposalPart>& cosine_part() {
  static const std::vector<ProposalPart> parts(1);
  return parts;
}

Accuracy test_weights(const Device& device, const KnownLobe& known, Precision precision) {
  constexpr std::size_t kCount = 8;
  const UnitVector light = vectors_of(kKnownPairs[0]).first;
  const std::vector<MixedLobe> lobes{{.mix = {0.5}}};
  DirectionSampler sampler(device, light, cosine_part(), {known.batch}, lobes, 1, precision, kCount);
  sampler.draw(1, 0, kCount);
  std::vector<std::pair<UnitVector, UnitVector>> pairs;
  for (std::size_t i = 0; i < kCount; ++i) {
    pairs.emplace_back(light, UnitVector{sampler.row(DirectionSampler::x)[i], sampler.row(DirectionSampler::y)[i],
                                         sampler.row(DirectionSampler::z)[i]});
  }
  const auto values = values_at(device, known.batch, precision, pairs);
  Comparison comparison(allowed(precision), kFloor * 0.5 * pi * values.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < kCount; ++i) {
    comparison.add(sampler.weights(0)[i], 0.5 * pi * values(0, static_cast<Eigen::Index>(i)));  // density N.V / pi
  }
  return comparison.result();
}

Accuracy test_shading(const Device& device, const KnownLobe& known, Precision precision) {
  SphereShader shader(device, {known.batch}, Eigen::MatrixXd::Constant(1, 1, 0.5), precision);
  constexpr double kHalfSide = 1e-3;
  constexpr std::array<std::array<double, 2>, 3> kPoints{{{0.1, 0.2}, {-0.5, 0.3}, {0.4, -0.6}}};
  const UnitVector light = unit_vector(0.7, 0.4);
  const std::vector<std::array<double, 4>> lights{{light[0], light[1], light[2], 2.0}};
  std::vector<SpherePart> parts;
  std::vector<std::pair<UnitVector, UnitVector>> pairs;
  for (const auto& [x, y] : kPoints) {
    parts.push_back({x - kHalfSide, x + kHalfSide, y - kHalfSide, y + kHalfSide});
    const double r = std::sqrt(1 - y * y);
    const double n = std::sqrt(r * r - x * x);
    const double along = light[0] * x + light[2] * n;
    pairs.emplace_back(
        UnitVector{(light[0] * n - light[2] * x) / r, (r * r * light[1] - y * along) / r, along + light[1] * y},
        UnitVector{-x / r, -y * n / r, n});
  }
  const auto radiance = shader.shade(parts, std::vector<double>{0.5}, std::vector<double>{1.0}, lights);
  const auto values = values_at(device, known.batch, precision, pairs);
  constexpr double kArea = 4 * kHalfSide * kHalfSide;
  Comparison comparison(allowed(precision), kFloor * kArea * values.cwiseAbs().maxCoeff());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    comparison.add(radiance(0, at), 0.5 * values(0, at) * pairs[k].first[2] * 2.0 * kArea);
  }
  return comparison.result();
}

/// Rows of numbers on the device, and the same on the host: rows x nodes.
struct TestRows {
  static constexpr std::size_t kNodes = 5;

  explicit TestRows(const Device& device)
      : packed{.values = {}, .stride = kNodes + 1, .packs = 3, .width = device.implementation().pack_width} {
    Numbers numbers;
    std::vector<double> data(packed.rows() * packed.stride, 0.0);
    values.resize(static_cast<Eigen::Index>(packed.rows()), kNodes);
    for (std::size_t row = 0; row < packed.rows(); ++row) {
      for (std::size_t node = 0; node < kNodes; ++node) {
        const double value = numbers();
        values(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(node)) = value;
        data[(row / packed.width * packed.stride + node) * packed.width + row % packed.width] = value;
      }
    }
    packed.values = constant_buffer(device, data);
  }

  PackedRows packed;
  Eigen::MatrixXd values;
};

/// A evaluator of some Lambert lobes of these values, and nodes at which they have them.
struct TestLobes {
  TestLobes(const Device& device, std::vector<double> lobe_values, std::size_t nodes)
      : values(std::move(lobe_values)), evaluator(device, {batch()}, Precision::double_precision, nodes), block(nodes) {
    for (std::size_t k = 0; k < nodes; ++k) push(block, unit_vector(0.3, 0), unit_vector(0.5, 1));
    evaluator.evaluate(block);
  }

  [[nodiscard]] LobeBatch batch() const {
    LobeBatch lobes{.kernel = {.model = "lambert"}, .coefficients = {}};
    for (const double value : values) lobes.coefficients.push_back({value});
    return lobes;
  }

  std::vector<double> values;
  LobeEvaluator evaluator;
  NodeBlock block;
};

double mapped(NodeMap map, double x) {
  switch (map) {
    case NodeMap::linear:
      return x;
    case NodeMap::log:
      return std::log1p(x);
    case NodeMap::cube_root:
      return std::cbrt(x);
    case NodeMap::cube_root_log:
      break;
  }
  return std::log1p(std::cbrt(x));
}

double term_of(PairTerm term, double d) {
  switch (term) {
    case PairTerm::square:
      return d * d;
    case PairTerm::absolute:
      return std::abs(d);
    case PairTerm::two_thirds:
      break;
  }
  return std::cbrt(d * d);
}

std::string name_of(const LobeKernel& kernel, std::string_view launcher, Precision precision) {
  std::string name = fmt::format("{} of {}", launcher, kernel.model);
  for (const auto& factor : kernel.factors) name += " * " + factor;
  if (kernel.curves > 0) name += fmt::format(", {} {} times", kernel.pumping, kernel.curves);
  if (kernel.curve_parts > 0) name += fmt::format(" with {} parts", kernel.curve_parts);
  return with_precision(name, precision);
}

Accuracy test_lobe(const Device& device, const KnownLobe& known, std::string_view launcher, Precision precision) {
  if (launcher == "evaluate_lobes.cl") return test_values(device, known, precision);
  if (launcher == "tabulate_pairs.cl") return test_table(device, known, precision);
  if (launcher == "weigh_directions.cl") return test_weights(device, known, precision);
  return test_shading(device, known, precision);
}

}  // namespace

std::string with_precision(std::string_view kernel, Precision precision) {
  return std::string(kernel) + (precision == Precision::double_precision ? "" : ", single precision");
}

void require_sound(const Device& device, const std::string& kernel, const std::function<Accuracy()>& test) {
  auto& implementation = device.implementation();
  if (implementation.is_testing || implementation.sound_kernels.contains(kernel)) return;
  implementation.is_testing = true;
  Accuracy accuracy;
  try {
    accuracy = checked("cannot test the kernel " + kernel, test);
  } catch (...) {
    implementation.is_testing = false;
    throw;
  }
  implementation.is_testing = false;
  if (!accuracy.is_sound()) {
    const char* cache = std::getenv("POCL_CACHE_DIR");
    throw DeviceError(fmt::format("OpenCL device {} ({}) computes wrongly: {} is off by {:.1e} of a known result; "
                                  "expected at most {:.0e}. Empty "
                                  "the kernel cache (POCL_CACHE_DIR, here '{}') or choose another device",
                                  implementation.info.name, implementation.info.driver, kernel, accuracy.deviation,
                                  accuracy.allowed, cache != nullptr ? cache : "~/.cache/pocl"),
                      {}, {.fault = Fault::wrong_results});
  }
  implementation.sound_kernels.insert(kernel);
}

void require_sound_model(const Device& device, const LobeKernel& kernel, std::string_view launcher,
                         Precision precision) {
  if (device.implementation().is_testing || !kernel.source.empty()) return;
  require_sound(device, name_of(kernel, launcher, precision), [&] {
    const auto known = known_lobe(kernel);
    if (!known) throw DeviceError("no values are known of the kernel " + kernel.model);
    return test_lobe(device, *known, launcher, precision);
  });
}

Accuracy test_gram(const Device& device) {
  const TestRows rows(device);
  GramAccumulator accumulator(device, rows.packed, 0, rows.packed.rows());
  accumulator.add(TestRows::kNodes);
  const auto gram = accumulator.take();
  const Eigen::MatrixXd expected = rows.values * rows.values.transpose();
  Comparison comparison(kDouble);
  for (Eigen::Index i = 0; i < gram.rows(); ++i) {
    for (Eigen::Index j = i; j < gram.cols(); ++j) comparison.add(gram(i, j), expected(i, j));
  }
  return comparison.result();
}

Accuracy test_differences(const Device& device) {
  const TestRows rows(device);
  DifferenceAccumulator accumulator(device, rows.packed,
                                    {{.terms = {{0, 1.0}, {2, -0.5}}}, {.terms = {{1, 0.75}, {0, -2.0}, {2, 1.0}}}});
  accumulator.add(TestRows::kNodes);
  const auto sums = accumulator.take();
  Comparison comparison(kDouble);
  comparison.add(sums[0], (rows.values.row(0) - 0.5 * rows.values.row(2)).squaredNorm());
  comparison.add(sums[1], (0.75 * rows.values.row(1) - 2 * rows.values.row(0) + rows.values.row(2)).squaredNorm());
  return comparison.result();
}

Accuracy test_segments(const Device& device) {
  const std::vector<double> values{0.3, 0.7, 1.1};
  const TestLobes lobes(device, values, 5);
  SegmentAccumulator accumulator(lobes.evaluator, 2);
  accumulator.add({0, 2, 5}, 0);
  const auto sums = accumulator.take();
  Comparison comparison(kDouble);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(lobes.evaluator.rows()[k]);
    comparison.add(sums(row, 0), 2 * values[k]);
    comparison.add(sums(row, 1), 3 * values[k]);
  }
  return comparison.result();
}

Accuracy test_segment_map(const Device& device) {
  constexpr std::size_t kColumns = 9;  // of the target: more than a tile
  const TestRows rows(device);
  SegmentTable table;
  const std::size_t segment = table.add(1, 2, 2, 0, kColumns);  // columns 1 and 3
  Numbers numbers;
  const std::size_t padded = SegmentTable::padded(kColumns);
  double* const entries = table.table(segment);
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t y = 0; y < padded; ++y) entries[k * padded + y] = y < kColumns ? numbers() : 0.0;
  }
  const std::vector<double> weights(entries, entries + 2 * padded);
  SegmentMap map(device);
  const FinishOnFailure finish_table(device);
  Comparison comparison(kDouble);
  for (const std::size_t packs : {3U, 2U}) {  // three at a time, and one by one
    PackedRows target{make_workspace(device, rows.packed.rows() * kColumns * sizeof(double)), kColumns, 3,
                      rows.packed.width};
    clear(device, target.values, target.rows() * kColumns);
    map.apply(rows.packed, target, packs, map.place(table));
    std::vector<double> found(target.rows() * kColumns);
    device.implementation().queue.enqueueReadBuffer(target.values, CL_TRUE, 0, found.size() * sizeof(double),
                                                    found.data());
    for (std::size_t row = 0; row < packs * target.width; ++row) {
      for (std::size_t y = 0; y < kColumns; ++y) {
        const auto at = static_cast<Eigen::Index>(row);
        const double expected = rows.values(at, 1) * weights[y] + rows.values(at, 3) * weights[padded + y];
        comparison.add(found[(row / target.width * kColumns + y) * target.width + row % target.width], expected);
      }
    }
  }
  return comparison.result();
}

Accuracy test_pairs(const Device& device, NodeMap map, PairTerm term) {
  const std::vector<double> values{0.3, 0.7, 1.9};
  const std::vector<double> scale{0.5, 1.0, 3.0};
  const std::vector<double> weight{0.2, 0.5, 0.3};
  const TestLobes lobes(device, values, scale.size());
  Eigen::SparseMatrix<double, Eigen::RowMajor> mix(3, 3);
  mix.setIdentity();
  constexpr std::size_t kSplit = 1;
  PairAccumulator accumulator(lobes.evaluator, {mix}, map, term);
  accumulator.add(scale, weight);
  const Eigen::MatrixXd sums = accumulator.take().front();
  PairAccumulator split_accumulator(lobes.evaluator, {mix}, map, term, kSplit);
  split_accumulator.add(scale, weight);
  const Eigen::MatrixXd behind_split = split_accumulator.take().front();
  Comparison comparison(term == PairTerm::two_thirds ? kTwoThirds : kDouble);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = i + 1; j < values.size(); ++j) {
      double expected = 0;
      for (std::size_t k = 0; k < scale.size(); ++k) {
        const double difference = mapped(map, scale[k] * values[i]) - mapped(map, scale[k] * values[j]);
        expected += weight[k] * term_of(term, difference);
      }
      comparison.add(sums(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), expected);
      if (i >= kSplit) continue;
      comparison.add(behind_split(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j - kSplit)), expected);
    }
  }
  return comparison.result();
}

Accuracy test_matrix_product(const Device& device, Precision precision) {
  constexpr std::size_t kRows = 17;
  constexpr std::size_t kDepth = 11;
  constexpr std::size_t kColumns = 37;  // whole tiles, and a part of one
  Numbers numbers;
  const auto a = numbers.list(kRows * kDepth);
  const auto b = numbers.list(kDepth * kColumns);
  const auto scale = numbers.list(kDepth);
  std::vector<double> c(kRows * kColumns);
  multiply(device, {a.data(), kRows, kDepth, kDepth}, {b.data(), kDepth, kColumns, kColumns}, scale,
           {c.data(), kRows, kColumns, kColumns}, precision);
  Comparison comparison(allowed(precision));
  for (std::size_t i = 0; i < kRows; ++i) {
    for (std::size_t j = 0; j < kColumns; ++j) {
      double expected = 0;
      for (std::size_t x = 0; x < kDepth; ++x)
        expected += a[i * kDepth + x] * scale[x] * scale[x] * b[x * kColumns + j];
      comparison.add(c[i * kColumns + j], expected);
    }
  }
  return comparison.result();
}

Accuracy test_isotropic_product(const Device& device, Precision precision) {
  constexpr std::size_t kRings = 2;
  constexpr std::size_t kColumns = 20;  // rings of the right table: whole panels, and a part of one
  constexpr std::size_t kAzimuths = 8;
  constexpr std::size_t kPoints = kAzimuths / 2 + 1;
  Numbers numbers;
  const auto a = numbers.list(kRings * kRings * kPoints);
  const auto b = numbers.list(kRings * kColumns * kPoints);
  const auto scale = numbers.list(kRings);
  std::vector<double> c(kRings * kColumns * kPoints);
  multiply_isotropic(device, kRings, kRings, kColumns, kAzimuths, a, b, scale, c, precision);
  const auto at = [](const std::vector<double>& table, std::size_t columns, std::size_t i, std::size_t j,
                     std::size_t k) {
    const std::size_t azimuth = k % kAzimuths;
    return table[(i * columns + j) * kPoints + std::min(azimuth, kAzimuths - azimuth)];
  };
  Comparison comparison(allowed(precision));
  for (std::size_t i = 0; i < kRings; ++i) {
    for (std::size_t j = 0; j < kColumns; ++j) {
      for (std::size_t k = 0; k < kPoints; ++k) {
        double sum = 0;
        for (std::size_t x = 0; x < kRings; ++x) {
          for (std::size_t l = 0; l < kAzimuths; ++l) {
            sum += scale[x] * scale[x] * at(a, kRings, i, x, k + kAzimuths - l) * at(b, kColumns, x, j, l);
          }
        }
        comparison.add(at(c, kColumns, i, j, k), 2 * pi / kAzimuths * sum);
      }
    }
  }
  return comparison.result();
}

Accuracy test_patch_light(const Device& device) {
  constexpr double kRadius = 0.5;
  constexpr double kFactor = 0.75;
  // Areas common to two discs with radius R at a distance d, and to one of them and the unit disc.
  const auto common = [](double r, double s, double d) {
    const double at_r = std::acos((d * d + r * r - s * s) / (2 * d * r));
    const double at_s = std::acos((d * d + s * s - r * r) / (2 * d * s));
    return r * r * (at_r - std::sin(2 * at_r) / 2) + s * s * (at_s - std::sin(2 * at_s) / 2);
  };
  DiscPoints p;
  DiscPoints q;
  p.push(0.3, 0);
  p.push(0.9, 0.5);
  p.push(0.2, 2.0);
  q.push(0.3, pi);
  q.push(0.9, 0.5);
  q.push(0.2, 2.0);
  PatchLight light(device, {{kRadius, kFactor}});
  light.place(p, q);
  std::vector<double> values(q.size() * light.stride());
  light.tabulate(0, q.size(), values);
  // Coincident points are known to 1e-8.
  Comparison comparison(1e-7);
  comparison.add(values[0], kFactor * common(kRadius, kRadius, 0.6));
  comparison.add(values[light.stride() + 1], kFactor * common(kRadius, 1, 0.9));
  comparison.add(values[2 * light.stride() + 2], kFactor * pi * kRadius * kRadius);
  return comparison.result();
}

Accuracy test_drawing(const Device& device) {
  constexpr std::size_t kCount = 8;
  DirectionSampler sampler(device, unit_vector(0.4, 0.2), cosine_part(), {}, {}, 1, Precision::double_precision,
                           kCount);
  sampler.draw(1, 0, kCount);
  Comparison comparison(kDouble);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double x = sampler.row(DirectionSampler::x)[i];
    const double y = sampler.row(DirectionSampler::y)[i];
    const double z = sampler.row(DirectionSampler::z)[i];
    comparison.add(x * x + y * y + z * z, 1);
    comparison.add(sampler.row(DirectionSampler::density)[i], z / pi);
    if (i > 0 && x == sampler.row(DirectionSampler::x)[i - 1]) comparison.add(2, 1);  // the same again
  }
  return comparison.result();
}

Accuracy test_drawing_each(const Device& device) {
  // Evenly on the disc, and a single direction, in turn.
  const UnitVector only = unit_vector(0.7, -1);
  const std::vector<ProposalPart> delta{
      {.strategy = Strategy::delta, .share = 1, .numbers = {only[0], only[1], only[2]}}};
  DrawOrders orders;
  const std::array densities{orders.add_density(cosine_part()), orders.add_density(delta)};
  constexpr std::size_t kCount = 6;
  for (std::size_t i = 0; i < kCount; ++i) {
    orders.add(unit_vector(0.2 * static_cast<double>(i), 1), densities[i % 2], 10 + i / 2);
  }
  const auto drawn = EachDrawer(device).draw(orders, 1);
  Comparison comparison(kDouble);
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto& [x, y, z] = drawn[i].direction;
    comparison.add(x * x + y * y + z * z, 1);
    comparison.add(drawn[i].density, i % 2 == 0 ? z / pi : -1);
    if (i % 2 == 1) comparison.add(x, only[0]);
    if (i > 1 && i % 2 == 0 && x == drawn[i - 2].direction[0]) comparison.add(2, 1);  // the same again
  }
  return comparison.result();
}

Accuracy test_density(const Device& device) {
  DirectionSampler sampler(device, unit_vector(0.4, 0.2), cosine_part(), {}, {}, 1, Precision::double_precision, 3);
  const std::vector<UnitVector> directions{unit_vector(0.1, 0), unit_vector(0.8, 2), unit_vector(1.4, -1)};
  std::vector<double> densities(directions.size());
  sampler.find_densities(directions, densities);
  Comparison comparison(kDouble);
  for (std::size_t i = 0; i < densities.size(); ++i) comparison.add(densities[i], directions[i][2] / pi);
  return comparison.result();
}

std::vector<SelfTestResult> self_test(const Device& device, std::string_view part) {
  std::vector<SelfTestResult> results;
  const auto add = [&](std::string kernel, const std::function<Accuracy()>& test) {
    if (kernel.find(part) == std::string::npos) return;
    auto& implementation = device.implementation();
    const bool was_testing = std::exchange(implementation.is_testing, true);
    SelfTestResult result{.kernel = std::move(kernel), .error = {}};
    try {
      const Accuracy accuracy = checked("cannot test the kernel", test);
      result.deviation = accuracy.deviation;
      result.allowed = accuracy.allowed;
      result.is_sound = accuracy.is_sound();
    } catch (const DeviceError& error) {
      result.error = error.what();
    }
    implementation.is_testing = was_testing;
    if (result.is_sound) implementation.sound_kernels.insert(result.kernel);
    results.push_back(std::move(result));
  };
  const auto add_lobe = [&](const LobeKernel& kernel, std::string_view launcher, Precision precision) {
    add(name_of(kernel, launcher, precision),
        [&] { return test_lobe(device, known_lobe(kernel).value(), launcher, precision); });
  };
  constexpr std::array kPrecisions{Precision::double_precision, Precision::single_precision};
  for (const KnownModel& model : known_models()) {
    for (const auto precision : kPrecisions) {
      add_lobe({.model = std::string(model.kernel), .is_anisotropic = model.is_anisotropic}, "evaluate_lobes.cl",
               precision);
    }
  }
  for (const KnownFactor& factor : known_factors()) {
    add_lobe({.model = "lambert", .factors = {std::string(factor.factor)}}, "evaluate_lobes.cl",
             Precision::double_precision);
  }
  for (const char* const pumping : {"g1", "g2", "controlled", "complement", "viewer"}) {
    for (const std::size_t parts : {std::size_t{0}, std::size_t{16}}) {
      add_lobe({.model = "lambert", .pumping = pumping, .curves = 2, .curve_parts = parts}, "evaluate_lobes.cl",
               Precision::double_precision);
    }
  }
  for (const std::string_view launcher : {"tabulate_pairs.cl", "weigh_directions.cl", "shade_sphere.cl"}) {
    add_lobe({.model = "ggx"}, launcher, Precision::double_precision);
    add_lobe({.model = "ward_anisotropic", .is_anisotropic = true}, launcher, Precision::double_precision);
  }
  add("accumulate_gram.cl", [&] { return test_gram(device); });
  add("accumulate_differences.cl", [&] { return test_differences(device); });
  add("sum_segments.cl", [&] { return test_segments(device); });
  add("map_segments.cl", [&] { return test_segment_map(device); });
  for (const auto map : {NodeMap::linear, NodeMap::log, NodeMap::cube_root, NodeMap::cube_root_log}) {
    add(pair_kernel_name(map, PairTerm::square), [&] { return test_pairs(device, map, PairTerm::square); });
  }
  for (const auto term : {PairTerm::absolute, PairTerm::two_thirds}) {
    add(pair_kernel_name(NodeMap::linear, term), [&] { return test_pairs(device, NodeMap::linear, term); });
  }
  for (const auto precision : kPrecisions) {
    add(with_precision("product of matrices", precision), [&] { return test_matrix_product(device, precision); });
    add(with_precision("product of isotropic tables", precision),
        [&] { return test_isotropic_product(device, precision); });
  }
  add("tabulate_patch_light.cl", [&] { return test_patch_light(device); });
  add("draw_directions.cl", [&] { return test_drawing(device); });
  add("draw_each.cl", [&] { return test_drawing_each(device); });
  add("find_density.cl", [&] { return test_density(device); });
  return results;
}

}  // namespace lobe
