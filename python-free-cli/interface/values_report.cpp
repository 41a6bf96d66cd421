#include "interface/values_report.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "core/text.hpp"
#include "interface/deviations.hpp"
#include "lobe/core/directions.hpp"

namespace lobe::cli {
namespace {

using Cells = std::vector<std::vector<std::string>>;  // [channel][pair]

/// The light's azimuth is told where one is not 0.
bool has_azimuths(std::span<const Directions> degrees) {
  return std::ranges::any_of(degrees, [](const Directions& at) { return at.phi_in != 0; });
}

std::string cells_text(std::span<const Directions> degrees, const Cells& cells, const std::vector<std::string>& names,
                       bool color) {
  std::vector<std::vector<std::string>> rows{{"theta_in/deg", "theta_out/deg", "delta_phi/deg"}};
  if (has_azimuths(degrees)) rows.front().emplace_back("phi_in/deg");
  for (std::size_t channel = 0; channel < cells.size(); ++channel) {
    const std::string name = names.empty() ? fmt::format("brdf_{}", channel + 1) : names.at(channel);
    rows.front().push_back((cells.size() == 1 ? "brdf" : name) + "/sr^-1");
  }
  for (std::size_t pair = 0; pair < degrees.size(); ++pair) {
    const auto& at = degrees[pair];
    rows.push_back({shortest(at.theta_in), shortest(at.theta_out), shortest(at.delta_phi)});
    if (has_azimuths(degrees)) rows.back().push_back(shortest(at.phi_in));
    for (const auto& channel : cells) rows.back().push_back(channel[pair]);
  }
  return format_table(rows, 0, color);
}

Json angles_json(const Directions& degrees) {
  return {{"theta_in_deg", degrees.theta_in},
          {"theta_out_deg", degrees.theta_out},
          {"delta_phi_deg", degrees.delta_phi},
          {"phi_in_deg", degrees.phi_in}};
}

}  // namespace

std::vector<Directions> to_radians(std::span<const Directions> degrees) {
  std::vector<Directions> radians;
  for (const auto& at : degrees) {
    radians.push_back({at.theta_in * kDegree, at.theta_out * kDegree, at.delta_phi * kDegree, at.phi_in * kDegree});
  }
  return radians;
}

std::string values_text(std::span<const Directions> degrees, const Eigen::MatrixXd& values,
                        const std::vector<std::string>& names, bool color) {
  Cells cells(static_cast<std::size_t>(values.cols()));
  for (std::size_t channel = 0; channel < cells.size(); ++channel) {
    for (const double value : values.col(static_cast<Eigen::Index>(channel))) cells[channel].push_back(shortest(value));
  }
  return cells_text(degrees, cells, names, color);
}

std::string values_text(std::span<const Directions> degrees, const std::vector<std::vector<Estimate>>& values,
                        const std::vector<std::string>& names, bool color,
                        const std::vector<std::vector<double>>& deviations) {
  Cells cells;
  for (std::size_t c = 0; c < values.size(); ++c) {
    cells.emplace_back();
    const auto known = deviations.empty() ? std::span<const double>() : std::span<const double>(deviations[c]);
    for (const auto& figure : figures(values[c], known)) cells.back().push_back(format_figure(figure));
  }
  return cells_text(degrees, cells, names, color);
}

Json values_json(std::span<const Directions> degrees, const Eigen::MatrixXd& values) {
  Json entries = Json::array();
  for (std::size_t pair = 0; pair < degrees.size(); ++pair) {
    Json entry = angles_json(degrees[pair]);
    for (const double value : values.row(static_cast<Eigen::Index>(pair))) entry["brdf"].push_back(to_json(value));
    entries.push_back(std::move(entry));
  }
  return entries;
}

Json values_json(std::span<const Directions> degrees, const std::vector<std::vector<Estimate>>& values,
                 const std::vector<std::vector<double>>& deviations) {
  Json entries = Json::array();
  for (std::size_t pair = 0; pair < degrees.size(); ++pair) {
    Json entry = angles_json(degrees[pair]);
    for (const auto& channel : values) {
      entry["brdf"].push_back(to_json(channel[pair].value));
      entry["brdf_error"].push_back(to_json(channel[pair].error));
    }
    for (const auto& channel : deviations) entry["brdf_measurement"].push_back(to_json(channel[pair]));
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace lobe::cli
