#include "formats/channel_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/spectral_range.hpp"
#include "core/text.hpp"
#include "lobe/core/colour.hpp"
#include "lobe/core/error.hpp"
#include "table/mixed_channels.hpp"

namespace lobe {
namespace {

constexpr std::array<std::string_view, 3> kRgb{"red", "green", "blue"};

[[noreturn]] void refuse(const BrdfFunction& brdf, std::string_view complaint) {
  throw ArgumentError(
      fmt::format("'{}' {}; it has the channels {}", brdf.name, complaint, fmt::join(brdf.channels, ", ")));
}

Eigen::Index channel_of(const BrdfFunction& brdf, const std::string& wanted) {
  const auto named = std::ranges::find(brdf.channels, lowercase(wanted), lowercase);
  if (named != brdf.channels.end()) return named - brdf.channels.begin();
  double number = 0;
  const bool is_number = parse_number(wanted, number) && number == std::floor(number);
  if (!is_number || number < 1 || number > static_cast<double>(brdf.channels.size())) {
    refuse(brdf, "has no channel '" + wanted + "'");
  }
  return static_cast<Eigen::Index>(number) - 1;
}

Eigen::MatrixXd no_weights(const BrdfFunction& brdf, std::size_t chosen) {
  return Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(brdf.channels.size()), static_cast<Eigen::Index>(chosen));
}

ChannelChoice by_name(const BrdfFunction& brdf, const std::vector<std::string>& wanted) {
  ChannelChoice choice{{}, {}, no_weights(brdf, wanted.size())};
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const Eigen::Index channel = channel_of(brdf, wanted[k]);
    const auto index = static_cast<std::size_t>(channel);
    choice.names.push_back(brdf.channels[index]);
    if (!brdf.wavelengths.empty()) choice.wavelengths.push_back(brdf.wavelengths[index]);
    choice.weights(channel, static_cast<Eigen::Index>(k)) = 1;
  }
  return choice;
}

/// Channels in the order of their wavelengths.
std::vector<std::size_t> spectral_order(const std::vector<double>& wavelengths) {
  std::vector<std::size_t> order(wavelengths.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return wavelengths[i]; });
  return order;
}

ChannelChoice by_wavelength(const BrdfFunction& brdf, const std::vector<double>& wanted) {
  const auto order = spectral_order(brdf.wavelengths);
  ChannelChoice choice{{}, wanted, no_weights(brdf, wanted.size())};
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const auto nanometres = [&](std::size_t i) { return brdf.wavelengths[order[i]]; };
    if (!(wanted[k] >= nanometres(0) && wanted[k] <= nanometres(order.size() - 1))) {
      refuse(brdf, fmt::format("has no wavelength of {} nm", shortest(wanted[k])));
    }
    std::size_t above = 0;
    while (nanometres(above) < wanted[k]) ++above;
    const std::size_t below = nanometres(above) == wanted[k] ? above : above - 1;
    const double share = below == above ? 0 : (wanted[k] - nanometres(below)) / (nanometres(above) - nanometres(below));
    const auto column = static_cast<Eigen::Index>(k);
    choice.weights(static_cast<Eigen::Index>(order[below]), column) += 1 - share;
    choice.weights(static_cast<Eigen::Index>(order[above]), column) += share;
    choice.names.push_back(shortest(wanted[k]) + " nm");
  }
  return choice;
}

/// Trapezoids over the sampled wavelengths by the CIE 1931 y, with sum 1.
Eigen::VectorXd photopic_weights(const BrdfFunction& brdf) {
  const auto order = spectral_order(brdf.wavelengths);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(order.size()));
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double from = brdf.wavelengths[order[i == 0 ? 0 : i - 1]];
    const double to = brdf.wavelengths[order[std::min(i + 1, order.size() - 1)]];
    weights[static_cast<Eigen::Index>(order[i])] = (to - from) / 2 * colour_matching(brdf.wavelengths[order[i]])[1];
  }
  return weights / weights.sum();
}

ChannelChoice luminance(const BrdfFunction& brdf, const std::string& name) {
  ChannelChoice choice{{"luminance"}, {}, no_weights(brdf, 1)};
  if (name == "rec709") {
    for (std::size_t k = 0; k < kRgb.size(); ++k) {
      if (std::ranges::find(brdf.channels, kRgb[k], lowercase) == brdf.channels.end()) {
        refuse(brdf, "has no red, green and blue for luminance by rec709");
      }
      choice.weights(channel_of(brdf, std::string(kRgb[k])), 0) = kRec709[k];
    }
    return choice;
  }
  if (name != "photopic") {
    throw ArgumentError("unknown weights of luminance '" + name + "'; expected rec709 or photopic");
  }
  // Wavelengths that leave out much of the visible range say little of the luminance.
  if (const auto gap = visible_gap(brdf.wavelengths)) {
    refuse(brdf, fmt::format("has no wavelength between {} and {} nm for luminance by photopic", shortest(gap->first),
                             shortest(gap->second)));
  }
  if (!spans_visible(brdf.wavelengths)) {
    refuse(brdf, fmt::format("has no spectrum from {} to {} nm for luminance by photopic", kVisibleFrom, kVisibleTo));
  }
  choice.weights.col(0) = photopic_weights(brdf);
  return choice;
}

/// Channels of each copy of them, side by side, mixed by the same weights.
Eigen::MatrixXd mixed(const Eigen::MatrixXd& values, const Eigen::MatrixXd& weights) {
  const Eigen::Index copies = values.cols() / weights.rows();
  Eigen::MatrixXd result(values.rows(), copies * weights.cols());
  for (Eigen::Index k = 0; k < copies; ++k) {
    result.middleCols(k * weights.cols(), weights.cols()) =
        values.middleCols(k * weights.rows(), weights.rows()) * weights;
  }
  return result;
}

BrdfTable chosen(const BrdfTable& table, const ChannelChoice& choice) {
  BrdfTable result = mixed_channels(table, choice.weights.transpose());
  result.channel_names = choice.names;
  return result;
}

}  // namespace

ChannelChoice choose_channels(const BrdfFunction& brdf, const ReadOptions& options) {
  const int choices = static_cast<int>(!options.channels.empty()) + static_cast<int>(!options.wavelengths.empty()) +
                      static_cast<int>(!options.luminance.empty());
  if (choices > 1) throw ArgumentError("channels, wavelengths and luminance are given; expected one of them");
  if (!options.channels.empty()) return by_name(brdf, options.channels);
  if (!options.luminance.empty()) return luminance(brdf, options.luminance);
  if (!options.wavelengths.empty() && brdf.wavelengths.empty()) {
    refuse(brdf, "does not depend on the wavelength; expected no wavelengths");
  }
  if (!options.wavelengths.empty()) return by_wavelength(brdf, options.wavelengths);
  const auto all = static_cast<Eigen::Index>(brdf.channels.size());
  return {brdf.channels, brdf.wavelengths, Eigen::MatrixXd::Identity(all, all)};
}

BrdfTable with_channels(const BrdfTable& table, const ReadOptions& options) {
  const ReadOptions only_channels{options.channels, options.wavelengths, options.luminance};
  if (!has_choices(options)) return table;
  if (!has_choices(only_channels) || options.theta_max != only_channels.theta_max || !options.component.empty() ||
      options.decode_srgb || !options.entry.empty() || !options.uniforms.empty()) {
    throw ArgumentError("'" + table.expression + "' is a table; expected no choice but that of channels");
  }
  BrdfFunction names;
  names.name = table.expression;
  names.channels = table.channel_names;
  for (std::size_t c = names.channels.size(); c < table.channels; ++c) names.channels.push_back(std::to_string(c + 1));
  for (const auto& name : names.channels) names.wavelengths.push_back(wavelength_of(name));
  if (std::ranges::any_of(names.wavelengths, [](double nm) { return std::isnan(nm); })) names.wavelengths.clear();
  return chosen(table, choose_channels(names, only_channels));
}

BrdfFunction with_channels(BrdfFunction brdf, const ChannelChoice& choice) {
  // The first channels alone are no identity, which Eigen would say of them, too.
  if (choice.weights.rows() == choice.weights.cols() && choice.weights.isIdentity(0)) return brdf;
  brdf.channels = choice.names;
  brdf.wavelengths = choice.wavelengths;
  brdf.at = [at = std::move(brdf.at), weights = choice.weights](std::span<const Directions> pairs) {
    BrdfValues values = at(pairs);
    values.value = mixed(values.value, weights);
    if (values.error.size() > 0) values.error = mixed(values.error, weights.cwiseAbs());
    return values;
  };
  if (brdf.cells) brdf.cells = std::make_shared<const BrdfTable>(chosen(*brdf.cells, choice));
  if (brdf.ring_cells) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const RingCells& all = *brdf.ring_cells;
    const auto size = static_cast<Eigen::Index>(all.values.size()) / choice.weights.rows();
    std::vector<double> values(static_cast<std::size_t>(choice.weights.cols() * size));
    Eigen::Map<Rows>(values.data(), choice.weights.cols(), size) =
        choice.weights.transpose() * Eigen::Map<const Rows>(all.values.data(), choice.weights.rows(), size);
    brdf.ring_cells = std::make_shared<const RingCells>(RingCells{all.rings, all.side, std::move(values)});
  }
  if (brdf.samples) {
    const MeasuredSamples& all = *brdf.samples;
    MeasuredSamples own{all.pairs, all.values * choice.weights, {}};
    // Deviations of channels count as independent of each other, as in copies of the samples.
    if (all.deviations.size() > 0) {
      own.deviations = (all.deviations.cwiseAbs2() * choice.weights.cwiseAbs2()).cwiseSqrt();
    }
    brdf.samples = std::make_shared<const MeasuredSamples>(std::move(own));
  }
  return brdf;
}

}  // namespace lobe
