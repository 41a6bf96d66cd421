#include "lobe/sampling/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "device/rounding.hpp"
#include "energy/known_as.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/delta_shares.hpp"
#include "model/lobes.hpp"
#include "model/sampling_strategy.hpp"
#include "sampling/cell_proposal.hpp"
#include "sampling/mixture.hpp"
#include "table/evaluate.hpp"
#include "table/interpolator.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kBlock = 16384;  // samples: what is drawn of them stays within a cache

using Parts = std::vector<ProposalPart>;
/// Value of a reflectance on the host, sr^-1.
using HostValue = std::function<double(std::size_t channel, Direction out)>;

UnitVector vector_of(Direction in) {
  if (!(in.theta >= 0 && in.theta < pi / 2)) {
    throw ArgumentError("angle of incidence of " + shortest(to_degrees(in.theta)) +
                        " degrees; expected a value in [0, 90) degrees");
  }
  if (!std::isfinite(in.phi)) throw ArgumentError("azimuth of incidence is no finite number");
  const double sine = std::sin(in.theta);
  return {sine * std::cos(in.phi), sine * std::sin(in.phi), std::cos(in.theta)};
}

/// The density for directions of a material's formulas.
Mixture mixture_at(const Device& device, const Material& material, const DeltaSplit& split, const UnitVector& light,
                   const SamplingOptions& options) {
  if (material.terms.empty()) throw ArgumentError("material '" + material.name + "' has no terms");
  const double elevation = std::atan2(light[2], std::hypot(light[0], light[1]));
  const DeltaParts shares = delta_parts(device, split.deltas, material.channels(), {&elevation, 1});
  const auto by_channel = [](const Eigen::VectorXd& part) { return std::vector<double>(part.begin(), part.end()); };
  auto deltas = delta_directions(light, by_channel(shares.mirror.col(0)), by_channel(shares.retro.col(0)));
  const auto albedos = term_albedos(device, split.smooth, deltas.empty(), light, options);
  return mixture_of(split.smooth, albedos, std::move(deltas), material.channels(), light, options);
}

/// Draws samples a block at a time.
class Drawing {
 public:
  Drawing(const Device& device, const Material& material, Direction in, const SamplingOptions& options,
          std::size_t capacity)
      : Drawing(device, material, split_delta(material), vector_of(in), options, capacity) {}

  Drawing(const Device& device, const BrdfTable& table, Direction in, const SamplingOptions& options,
          std::size_t capacity)
      : Drawing(device, table, Interpolator(consistent(table)), in, options, capacity) {}

  void draw(std::uint64_t seed, std::uint64_t first, std::size_t count) {
    sampler_.draw(seed, first, count);
    if (host_value_) weigh_on_host(count);
  }

  [[nodiscard]] SampleKind kind(std::size_t i) const {
    if (const auto* delta = delta_at(i)) return delta->kind;
    return row(DirectionSampler::density)[i] > 0 ? SampleKind::smooth : SampleKind::lost;
  }
  [[nodiscard]] double weight(std::size_t i, std::size_t channel) const {
    if (const auto* delta = delta_at(i)) return delta->factors[channel] / -row(DirectionSampler::density)[i];
    if (host_value_) return host_weights_[channel * sampler_.capacity() + i];
    return sampler_.weights(sampler_.channels() == 1 ? 0 : channel)[i];
  }
  [[nodiscard]] std::span<const double> row(DirectionSampler::Row name) const { return sampler_.row(name); }

  [[nodiscard]] std::size_t channels() const { return mixture_.channels; }
  [[nodiscard]] std::size_t capacity() const { return sampler_.capacity(); }
  [[nodiscard]] DirectionSampler& sampler() { return sampler_; }

 private:
  Drawing(const Device& device, const Material& material, const DeltaSplit& split, const UnitVector& light,
          const SamplingOptions& options, std::size_t capacity)
      : mixture_(mixture_at(device, material, split, light, options)),
        sampler_(make_sampler(device, split.smooth, light, mixture_.parts, options.precision, capacity)) {}

  Drawing(const Device& device, const BrdfTable& table, Interpolator interpolator, Direction in,
          const SamplingOptions& options, std::size_t capacity)
      : mixture_(mixture_of_table(table, interpolator, in, options)),
        sampler_(device, vector_of(in), mixture_.parts, {}, {}, 1, options.precision, capacity),
        host_value_(
            [interpolator, in](std::size_t channel, Direction out) { return interpolator.at(channel, in, out).value; }),
        host_weights_(table.channels * sampler_.capacity()) {}

  static const BrdfTable& consistent(const BrdfTable& table) {
    check(table);
    return table;
  }

  static Mixture mixture_of_table(const BrdfTable& table, const Interpolator& interpolator, Direction in,
                                  const SamplingOptions& options) {
    const UnitVector light = vector_of(in);
    std::vector<double> mirror(table.channels);
    std::vector<double> retro(table.channels);
    std::vector<double> albedos(table.channels);
    const auto means = albedo(table, {&in, 1});
    for (std::size_t c = 0; c < table.channels; ++c) {
      mirror[c] = interpolator.row_part(table.mirror, c, in).value;
      retro[c] = interpolator.row_part(table.retro, c, in).value;
      albedos[c] = means[c].front().value - mirror[c] - retro[c];
    }
    Parts parts = options.proposal == SamplingStrategy::cosine ? Parts{ProposalPart{}} : propose(table, in);
    const double deltas = mean_size(mirror) + mean_size(retro);
    return with_deltas(std::move(parts), std::max(mean_size(albedos), kLeastShare * deltas),
                       delta_directions(light, std::move(mirror), std::move(retro)), table.channels);
  }

  [[nodiscard]] const DeltaDirection* delta_at(std::size_t i) const {
    return mixture_.delta_of(static_cast<std::size_t>(row(DirectionSampler::part)[i]));
  }

  void weigh_on_host(std::size_t count) {
    constexpr std::size_t kPiece = 256;
    parallel_for_pieces(count, kPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const double density = row(DirectionSampler::density)[i];
        const double x = row(DirectionSampler::x)[i];
        const double y = row(DirectionSampler::y)[i];
        const double z = row(DirectionSampler::z)[i];
        const Direction out{std::atan2(std::hypot(x, y), z), std::atan2(y, x)};
        for (std::size_t c = 0; c < channels(); ++c) {
          host_weights_[c * capacity() + i] = density > 0 ? host_value_(c, out) * z / density : 0;
        }
      }
    });
  }

  Mixture mixture_;
  DirectionSampler sampler_;
  HostValue host_value_;  ///< values of tables; materials are weighted on the device
  std::vector<double> host_weights_;
};

void report_progress(const SamplingOptions& options, std::size_t done, std::size_t count) {
  if (options.progress && !options.progress("sampling", static_cast<double>(done) / static_cast<double>(count))) {
    throw Cancelled("cancelled");
  }
}

template <typename Known>
DirectionSamples sample_of(const Device& device, const Known& reflectance, Direction in, std::size_t count,
                           const SamplingOptions& options) {
  if (count == 0) throw ArgumentError("no samples; expected at least one");
  Drawing drawing(device, reflectance, in, options, std::min(count, kBlock));
  const auto rows = static_cast<Eigen::Index>(count);
  const auto channels = static_cast<Eigen::Index>(drawing.channels());
  DirectionSamples samples{.directions = {}, .density = Eigen::VectorXd(rows), .weights = {}, .kinds = {}};
  samples.directions.setZero(rows, 3);
  samples.weights.setZero(rows, channels);
  for (std::size_t first = 0; first < count; first += drawing.capacity()) {
    report_progress(options, first, count);
    const std::size_t size = std::min(drawing.capacity(), count - first);
    drawing.draw(options.seed, options.first + first, size);
    for (std::size_t i = 0; i < size; ++i) {
      const auto at = static_cast<Eigen::Index>(first + i);
      samples.kinds.push_back(drawing.kind(i));
      samples.density(at) = std::abs(drawing.row(DirectionSampler::density)[i]);
      if (samples.kinds.back() == SampleKind::lost) continue;
      samples.directions.row(at) << drawing.row(DirectionSampler::x)[i], drawing.row(DirectionSampler::y)[i],
          drawing.row(DirectionSampler::z)[i];
      for (Eigen::Index c = 0; c < channels; ++c) {
        samples.weights(at, c) = drawing.weight(i, static_cast<std::size_t>(c));
        if (std::isfinite(samples.weights(at, c))) continue;
        throw NumericError("the weight of a sample is no finite number; check the parameters of the material");
      }
    }
  }
  return samples;
}

/// Mean and sum of squared differences from it, of parts that are joined (Chan, Golub and LeVeque 1983).
struct Moments {
  double count = 0;
  double mean = 0;
  double squares = 0;

  void join(const Moments& other) {
    const double total = count + other.count;
    const double difference = other.mean - mean;
    squares += other.squares + difference * difference * count * other.count / total;
    mean += difference * other.count / total;
    count = total;
  }
};

Moments moments_of(const Drawing& drawing, std::size_t count, std::size_t channel) {
  Moments moments{static_cast<double>(count)};
  for (std::size_t i = 0; i < count; ++i) moments.mean += drawing.weight(i, channel);
  moments.mean /= moments.count;
  // Differences from the mean add up to its rounding.
  double rest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double difference = drawing.weight(i, channel) - moments.mean;
    moments.squares += difference * difference;
    rest += difference;
  }
  moments.mean += rest / moments.count;
  return moments;
}

/// Relative rounding of a mean of weights, which all of them may share, in epsilons.
constexpr double kWeightRounding = 1.5;

template <typename Known>
SampledAlbedo albedo_of(const Device& device, const Known& reflectance, Direction in, std::size_t count,
                        const SamplingOptions& options) {
  if (count < 2) throw ArgumentError("an albedo of fewer than 2 samples; a standard error takes at least 2");
  Drawing drawing(device, reflectance, in, options, std::min(count, kBlock));
  std::vector<Moments> moments(drawing.channels());
  std::size_t lost = 0;
  for (std::size_t first = 0; first < count; first += drawing.capacity()) {
    report_progress(options, first, count);
    const std::size_t size = std::min(drawing.capacity(), count - first);
    drawing.draw(options.seed, options.first + first, size);
    for (std::size_t c = 0; c < moments.size(); ++c) moments[c].join(moments_of(drawing, size, c));
    for (std::size_t i = 0; i < size; ++i) {
      if (drawing.kind(i) == SampleKind::lost) ++lost;
    }
  }
  SampledAlbedo result;
  for (const Moments& channel : moments) {
    const double variance = channel.squares / (channel.count - 1);
    const double rounding = kWeightRounding * epsilon_of(options.precision) * std::abs(channel.mean);
    result.albedo.push_back({channel.mean, std::hypot(std::sqrt(variance / channel.count), rounding)});
    result.variance.push_back(variance);
  }
  result.lost = static_cast<double>(lost) / static_cast<double>(count);
  return result;
}

template <typename Known>
Eigen::VectorXd density_of(const Device& device, const Known& reflectance, Direction in,
                           std::span<const UnitVector> directions, const SamplingOptions& options) {
  Eigen::VectorXd densities(static_cast<Eigen::Index>(directions.size()));
  const std::span<double> values{densities.data(), directions.size()};
  Drawing drawing(device, reflectance, in, options, std::clamp<std::size_t>(directions.size(), 1, kBlock));
  for (std::size_t first = 0; first < directions.size(); first += drawing.capacity()) {
    const std::size_t size = std::min(drawing.capacity(), directions.size() - first);
    drawing.sampler().find_densities(directions.subspan(first, size), values.subspan(first, size));
  }
  return densities;
}

/// Calls work(known) with the formulas or the table that samples are drawn from;
/// \return what that returns
template <typename Work>
auto drawn_from(const Device& device, const Reflectance& reflectance, const SamplingOptions& options,
                const Work& work) {
  return known_as(device, reflectance,
                  Cases{[&](const Material& formula) { return work(formula); },
                        [&](const BrdfFunction& function) { return work(natural_table(function, options.progress)); },
                        [&](const BrdfTable& table) { return work(table); }});
}

std::optional<HemisphereGrid> grid_of(const Material& /*material*/) {
  return {};
}

std::optional<HemisphereGrid> grid_of(const BrdfTable& table) {
  return table.grid;
}

}  // namespace

DirectionSamples sample(const Device& device, const Reflectance& reflectance, Direction in, std::size_t count,
                        const SamplingOptions& options) {
  return drawn_from(device, reflectance, options, [&](const auto& known) {
    DirectionSamples samples = sample_of(device, known, in, count, options);
    samples.grid = grid_of(known);
    return samples;
  });
}

Eigen::VectorXd sampling_density(const Device& device, const Reflectance& reflectance, Direction in,
                                 std::span<const std::array<double, 3>> directions, const SamplingOptions& options) {
  return drawn_from(device, reflectance, options,
                    [&](const auto& known) { return density_of(device, known, in, directions, options); });
}

SampledAlbedo sampled_albedo(const Device& device, const Reflectance& reflectance, Direction in, std::size_t count,
                             const SamplingOptions& options) {
  return drawn_from(device, reflectance, options,
                    [&](const auto& known) { return albedo_of(device, known, in, count, options); });
}

}  // namespace lobe
