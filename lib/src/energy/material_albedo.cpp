#include "energy/material_albedo.hpp"

#include <algorithm>
#include <cmath>

#include "lobe/core/error.hpp"

namespace lobe {

double albedo_rounding(Precision precision, const LobeSet& lobes) {
  constexpr double kEdge = 4e-16;
  // Constants of models are sums that cancel: that of patch_band with R = 2 and inner = 0.999 is off by 4.7e-13.
  double sum = precision == Precision::double_precision ? 1e-12 : 4e-6;
  for (const auto* radii : {&lobes.patch_radii, &lobes.retro_patch_radii}) {
    if (!radii->empty()) sum += kEdge / radii->front();
  }
  return sum;
}

MaterialAlbedo::MaterialAlbedo(const Device& device, const Material& material, Precision precision, Given given)
    : lobes_(make_lobe_set({&material, 1}, {.with_deltas = true, .with_anisotropic = true})),
      integrator_(device, lobes_, precision, given),
      rounding_(albedo_rounding(precision, lobes_)) {}

Eigen::MatrixXd MaterialAlbedo::at(std::span<const IncidentNode> incident, int level) {
  const Eigen::MatrixXd albedos = integrator_.integrate(incident, level, work_);
  Eigen::MatrixXd mixed(static_cast<Eigen::Index>(lobes_.channels()), albedos.cols());
  for (std::size_t c = 0; c < lobes_.channels(); ++c) {
    mixed.row(static_cast<Eigen::Index>(c)) = lobes_.mix[c] * albedos;
  }
  return mixed;
}

Refined refine(const std::function<Eigen::ArrayXd(int)>& at_level, const std::string& what, const Material& material,
               double floor, double tolerance, int levels) {
  constexpr double kEarlier = 0.1;
  constexpr double kSafety = 2;
  const double goal = std::max(tolerance, 2 * floor);
  Eigen::ArrayXd coarse = at_level(0);
  Eigen::ArrayXd earlier = Eigen::ArrayXd::Zero(coarse.size());
  for (int level = 1;; ++level) {
    const Eigen::ArrayXd fine = at_level(level);
    if (!fine.isFinite().all()) throw NumericError(what + " of '" + material.name + "' is no finite number");
    const Eigen::ArrayXd difference = (fine - coarse).abs();
    const Eigen::ArrayXd error = kSafety * difference.max(kEarlier * earlier) + floor * fine.abs();
    const double worst = (fine != 0).select(error / fine.abs(), 0.0).maxCoeff();
    if (worst <= goal || level + 1 == levels) {
      Refined result{{}, worst, worst <= goal};
      for (Eigen::Index c = 0; c < fine.size(); ++c) result.values.push_back({fine(c), error(c)});
      return result;
    }
    earlier = difference;
    coarse = fine;
  }
}

}  // namespace lobe
