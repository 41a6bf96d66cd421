#include "formats/spectral_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measurement.hpp"

namespace lobe {
namespace {

auto place_of(const SpectralRow& row) {
  return std::tuple(row.pair.theta_in, row.pair.phi_in, row.pair.theta_out, row.pair.delta_phi);
}

/// Wavelengths that occur, rising.
std::vector<double> wavelengths_of(const std::vector<SpectralRow>& rows) {
  std::vector<double> all;
  all.reserve(rows.size());
  for (const SpectralRow& row : rows) all.push_back(row.wavelength);
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

ScatteredSamples gathered(const FileBytes& file, std::vector<SpectralRow> rows, bool is_isotropic, bool has_deviations,
                          BrdfFunction& brdf) {
  constexpr std::size_t kMostWavelengths = 4096;
  if (rows.empty()) file.refuse_end("no values");
  const std::vector<double> wavelengths = wavelengths_of(rows);
  const std::size_t count = wavelengths.size();
  if (count > 1 && wavelengths.front() == 0) {
    file.refuse_end("only some rows have a wavelength; expected one for all of them or none");
  }
  if (count > kMostWavelengths) {
    file.refuse_end(fmt::format("{} wavelengths; expected at most {}", count, kMostWavelengths));
  }
  require_room(file, rows.size() / count, count);
  if (wavelengths.front() == 0) {
    brdf.channels = {"value"};
  } else {
    brdf.wavelengths = wavelengths;
    for (const double wavelength : wavelengths) brdf.channels.push_back(shortest(wavelength) + " nm");
  }

  std::ranges::stable_sort(rows, [](const SpectralRow& a, const SpectralRow& b) {
    return std::tuple_cat(place_of(a), std::tuple(a.wavelength)) <
           std::tuple_cat(place_of(b), std::tuple(b.wavelength));
  });
  SampleCollector values(count);
  SampleCollector deviations(has_deviations ? count : 0);
  std::size_t incomplete = 0;
  std::vector<double> of_sample(count);
  for (auto first = rows.begin(); first != rows.end();) {
    const auto end =
        std::find_if(first, rows.end(), [&](const auto& row) { return place_of(row) != place_of(*first); });
    // A pair of directions may be there several times.
    std::vector<std::vector<SpectralRow>> by_channel(count);
    for (auto row = first; row != end; ++row) {
      const auto channel = std::ranges::lower_bound(wavelengths, row->wavelength) - wavelengths.begin();
      by_channel[static_cast<std::size_t>(channel)].push_back(*row);
    }
    const std::size_t times = std::ranges::min(by_channel, {}, &std::vector<SpectralRow>::size).size();
    if (times == 0) ++incomplete;
    for (std::size_t k = 0; k < times; ++k) {
      std::ranges::transform(by_channel, of_sample.begin(), [&](const auto& list) { return list[k].value; });
      values.add(first->pair, of_sample);
      if (!has_deviations) continue;
      std::ranges::transform(by_channel, of_sample.begin(), [&](const auto& list) { return list[k].deviation; });
      deviations.add(first->pair, of_sample);
    }
    first = end;
  }
  if (incomplete > 0) {
    brdf.remarks.push_back(
        fmt::format("{} pairs of directions lack some of the {} wavelengths, and are left out", incomplete, count));
  }
  ScatteredSamples samples = values.take(is_isotropic);
  if (has_deviations) samples.deviations = deviations.take(is_isotropic).values;
  return samples;
}

std::vector<std::size_t> by_wavelength(const BrdfFunction& brdf) {
  std::vector<std::size_t> order(own_channels(brdf));
  std::iota(order.begin(), order.end(), 0);
  if (!brdf.wavelengths.empty()) {
    std::ranges::stable_sort(order, {}, [&](std::size_t channel) { return brdf.wavelengths[channel]; });
  }
  return order;
}

WrittenValues spectral_values(const BrdfFunction& brdf, std::span<const Directions> pairs, std::string_view format) {
  const std::size_t own = own_channels(brdf);
  if (own != 1 && brdf.wavelengths.empty()) {
    throw ArgumentError(fmt::format("'{}' has {} channels that are no wavelengths; {} files hold one, or wavelengths",
                                    brdf.name, own, format));
  }
  const Eigen::MatrixXd all = brdf.at(pairs).value;
  if (!all.allFinite()) throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
  WrittenValues written{all.leftCols(static_cast<Eigen::Index>(own)), {}};
  Eigen::Index row = 0;
  Eigen::Index column = 0;
  if (const double least = written.value.minCoeff(&row, &column); least < 0) {
    const Directions& pair = pairs[static_cast<std::size_t>(row)];
    throw ArgumentError(
        fmt::format("'{}' is {:.3g} at theta_in {:.3g}, theta_out {:.3g} degrees; {} files hold no values below 0",
                    brdf.name, least, to_degrees(pair.theta_in), to_degrees(pair.theta_out), format));
  }
  if (brdf.replicates < 2) return written;
  written.deviation.resizeLike(written.value);
  const auto deviations = measurement_deviations(brdf, all);
  for (std::size_t c = 0; c < own; ++c) {
    written.deviation.col(static_cast<Eigen::Index>(c)) =
        Eigen::Map<const Eigen::VectorXd>(deviations[c].data(), written.value.rows());
  }
  return written;
}

}  // namespace lobe
