#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/text.hpp"
#include "energy/albedo_integrator.hpp"
#include "hemisphere/refinement.hpp"
#include "lobe/energy.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

/// Relative error of a sum of samples beside that of the quadrature: that of the samples, and that of the edges of
/// patches, angles near pi/2 that are known to an ulp.
double rounding(Precision precision, const LobeSet& lobes) {
  constexpr double kEdge = 4e-16;
  double sum = precision == Precision::double_precision ? 1e-14 : 4e-6;
  for (const auto* radii : {&lobes.patch_radii, &lobes.retro_patch_radii}) {
    if (!radii->empty()) sum += kEdge / radii->front();
  }
  return sum;
}

std::string degrees(double radians) {
  return shortest(radians * 180 / std::numbers::pi) + " degrees";
}

/// Albedos of the material at incident directions, channels x directions.
class MaterialAlbedo {
 public:
  MaterialAlbedo(const Device& device, const Material& material, Precision precision)
      : lobes_(make_lobe_set({&material, 1}, {.with_anisotropic = true})),
        integrator_(device, lobes_, precision),
        rounding_(lobe::rounding(precision, lobes_)) {}

  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] const AlbedoRule& rule() const { return integrator_.rule(); }

  Eigen::MatrixXd at(std::span<const IncidentNode> incident, int level) {
    const Eigen::MatrixXd albedos = integrator_.integrate(incident, level, work_);
    Eigen::MatrixXd mixed(static_cast<Eigen::Index>(lobes_.channels()), albedos.cols());
    for (std::size_t c = 0; c < lobes_.channels(); ++c) {
      mixed.row(static_cast<Eigen::Index>(c)) = lobes_.mix[c] * albedos;
    }
    return mixed;
  }

 private:
  LobeSet lobes_;
  AlbedoIntegrator integrator_;
  double rounding_;
  Work work_;
};

/// Refines values of all channels until the worst relative error is below the tolerance. An error is twice the
/// difference of the last two levels, or of a tenth of the one before, because two levels may agree by accident; and
/// rounding.
/// \param at_level values per channel by level of refinement
/// \param floor relative error beside that of the quadrature
template <typename AtLevel>
std::vector<Estimate> refine(const AtLevel& at_level, const std::string& what, const Material& material, double floor,
                             const AlbedoOptions& options) {
  constexpr double kEarlier = 0.1;
  constexpr double kSafety = 2;
  const double goal = std::max(options.tolerance, 2 * floor);
  Eigen::ArrayXd coarse = at_level(0);
  Eigen::ArrayXd earlier = Eigen::ArrayXd::Zero(coarse.size());
  double worst = 0;
  for (int level = 1; level < kLevels; ++level) {
    const Eigen::ArrayXd fine = at_level(level);
    if (!fine.isFinite().all()) throw NumericError(what + " of '" + material.name + "' is no finite number");
    const Eigen::ArrayXd difference = (fine - coarse).abs();
    const Eigen::ArrayXd error = kSafety * difference.max(kEarlier * earlier) + floor * fine.abs();
    worst = (fine != 0).select(error / fine.abs(), 0.0).maxCoeff();
    if (worst <= goal) {
      std::vector<Estimate> result;
      for (Eigen::Index c = 0; c < fine.size(); ++c) result.push_back({fine(c), error(c)});
      return result;
    }
    earlier = difference;
    coarse = fine;
  }
  throw NumericError(what + " of '" + material.name + "' reaches a relative error of " + shortest(worst) +
                     " only; expected " + shortest(options.tolerance) + ", give a larger tolerance");
}

}  // namespace

std::vector<std::vector<Estimate>> albedo(const Device& device, const Material& material,
                                          std::span<const double> theta_in, const AlbedoOptions& options) {
  std::vector<Direction> incident;
  for (const double theta : theta_in) incident.push_back({theta, 0});
  return albedo(device, material, incident, options);
}

std::vector<std::vector<Estimate>> albedo(const Device& device, const Material& material,
                                          std::span<const Direction> directions, const AlbedoOptions& options) {
  for (const auto& [theta, phi] : directions) {
    if (!(theta >= 0 && theta < std::numbers::pi / 2)) {
      throw ArgumentError("angle of incidence of " + degrees(theta) + "; expected a value in [0, 90) degrees");
    }
    if (!std::isfinite(phi)) throw ArgumentError("azimuth of incidence is no finite number");
  }
  std::vector<std::vector<Estimate>> result(material.channels(), std::vector<Estimate>(directions.size()));
  if (directions.empty()) return result;

  MaterialAlbedo integral(device, material, options.precision);
  // One direction at a time: easy ones stop early.
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const IncidentNode incident{std::numbers::pi / 2 - directions[k].theta, 1, directions[k].phi};
    const auto estimates = refine(
        [&](int level) -> Eigen::ArrayXd {
          return integral.at({&incident, 1}, level).col(0).array();
        },
        "albedo at " + degrees(directions[k].theta), material, integral.rounding(), options);
    for (std::size_t c = 0; c < result.size(); ++c) result[c][k] = estimates[c];
  }
  return result;
}

std::vector<Estimate> mean_albedo(const Device& device, const Material& material, const AlbedoOptions& options) {
  MaterialAlbedo integral(device, material, options.precision);
  const auto at_level = [&](int level) {
    Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(material.channels()));
    for (std::size_t slab = 0; slab < integral.rule().slabs(); ++slab) {
      const auto incident = integral.rule().incident_nodes(slab, level);
      const Eigen::MatrixXd albedos = integral.at(incident, level);
      for (std::size_t k = 0; k < incident.size(); ++k) {
        mean += incident[k].weight / std::numbers::pi * albedos.col(static_cast<Eigen::Index>(k)).array();
      }
    }
    return mean;
  };
  return refine(at_level, "mean albedo", material, integral.rounding(), options);
}

}  // namespace lobe
