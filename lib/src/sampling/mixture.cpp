#include "sampling/mixture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "model/lobes.hpp"
#include "model/sampling_strategy.hpp"

namespace lobe {
namespace {

constexpr std::size_t kPilot = 4096;        // samples that the albedo of a term is estimated by
constexpr std::uint64_t kPilotSeed = 2001;  // the same for all, or densities would depend on the seed

using Parts = std::vector<ProposalPart>;

/// Parts in mixtures, shares of which sum to 1 each, with a common share.
void append(Parts& all, Parts parts, double share) {
  for (auto& part : parts) {
    part.share *= share;
    all.push_back(std::move(part));
  }
}

std::vector<MixedLobe> mixed_lobes(const LobeSet& lobes) {
  std::vector<MixedLobe> mixed;
  Eigen::Index column = 0;
  for (std::size_t batch = 0; batch < lobes.batches.size(); ++batch) {
    for (std::size_t lobe = 0; lobe < lobes.batches[batch].coefficients.size(); ++lobe, ++column) {
      MixedLobe one{batch, lobe, {}};
      for (const auto& mix : lobes.mix) one.mix.push_back(mix.coeff(0, column));
      mixed.push_back(std::move(one));
    }
  }
  return mixed;
}

/// The mean size of a term's weights under its own proposal: its albedo, but for its scale and for signs.
double pilot_albedo(const Device& device, Term term, const UnitVector& light, const Parts& parts, Precision precision) {
  term.weight = {1.0};
  auto sampler = make_sampler(device, {"", "", {std::move(term)}}, light, parts, precision, kPilot);
  sampler.draw(kPilotSeed, 0, kPilot);
  return mean_size(sampler.weights(0).first(kPilot));
}

/// The density for a term alone.
Parts parts_of(const Term& term, const UnitVector& light, const SamplingOptions& options) {
  if (options.proposal == SamplingStrategy::cosine) return {ProposalPart{}};
  return propose(term, light, options.patches);
}

}  // namespace

double mean_size(std::span<const double> channels) {
  double sum = 0;
  for (const double value : channels) sum += std::abs(value);
  return sum / static_cast<double>(channels.size());
}

std::vector<DeltaDirection> delta_directions(const UnitVector& light, std::vector<double> mirror,
                                             std::vector<double> retro) {
  std::vector<DeltaDirection> found;
  if (mean_size(mirror) > 0) {
    found.push_back({SampleKind::mirror, {0 - light[0], 0 - light[1], light[2]}, std::move(mirror)});
  }
  if (mean_size(retro) > 0) found.push_back({SampleKind::retro, light, std::move(retro)});
  return found;
}

Mixture with_deltas(Parts smooth, double smooth_albedo, std::vector<DeltaDirection> deltas, std::size_t channels) {
  double total = smooth_albedo;
  for (const auto& delta : deltas) total += mean_size(delta.factors);
  Mixture mixture{{}, std::move(deltas), channels};
  append(mixture.parts, std::move(smooth), mixture.deltas.empty() ? 1 : smooth_albedo / total);
  for (const auto& delta : mixture.deltas) {
    ProposalPart part{.strategy = Strategy::delta, .share = mean_size(delta.factors) / total};
    std::ranges::copy(delta.direction, part.numbers.begin());
    mixture.parts.push_back(std::move(part));
  }
  return mixture;
}

DirectionSampler make_sampler(const Device& device, const Material& smooth, const UnitVector& light,
                              std::span<const ProposalPart> parts, Precision precision, std::size_t capacity) {
  if (smooth.terms.empty()) return {device, light, parts, {}, {}, 1, precision, capacity};
  const LobeSet lobes = make_lobe_set({&smooth, 1}, {.with_anisotropic = true});
  return {device, light, parts, lobes.batches, mixed_lobes(lobes), lobes.channels(), precision, capacity};
}

std::vector<double> term_albedos(const Device& device, const Material& smooth, bool is_alone, const UnitVector& light,
                                 const SamplingOptions& options) {
  std::vector<double> albedos;
  // Cosines alone are mixed with nothing.
  const bool is_cosine = options.proposal == SamplingStrategy::cosine && is_alone;
  if (is_cosine || (is_alone && smooth.terms.size() == 1)) return std::vector<double>(smooth.terms.size(), 1.0);
  for (const Term& term : smooth.terms) {
    albedos.push_back(mean_size(term.weight) *
                      pilot_albedo(device, term, light, parts_of(term, light, options), options.precision));
  }
  return albedos;
}

Mixture mixture_of(const Material& smooth, std::span<const double> albedos, std::vector<DeltaDirection> deltas,
                   std::size_t channels, const UnitVector& light, const SamplingOptions& options) {
  if (options.proposal == SamplingStrategy::cosine && deltas.empty()) return {{ProposalPart{}}, {}, channels};
  double most = 0;
  for (const auto& delta : deltas) most = std::max(most, mean_size(delta.factors));
  for (const double albedo : albedos) most = std::max(most, albedo);
  std::vector<double> shares;
  double sum = 0;
  for (const double albedo : albedos) {
    shares.push_back(most > 0 ? std::max(albedo, kLeastShare * most) : 1);
    sum += shares.back();
  }
  Parts parts;
  for (std::size_t t = 0; t < smooth.terms.size(); ++t) {
    append(parts, parts_of(smooth.terms[t], light, options), shares[t] / sum);
  }
  if (parts.empty() && deltas.empty()) parts.emplace_back();  // mirrors that reflect nothing
  return with_deltas(std::move(parts), sum, std::move(deltas), channels);
}

}  // namespace lobe
