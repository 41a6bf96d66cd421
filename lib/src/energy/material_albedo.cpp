#include "energy/material_albedo.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

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
  const auto one_at_level = [&](std::span<const std::size_t>, int level) -> Eigen::MatrixXd { return at_level(level); };
  return refine_each(one_at_level, 1, what, material, floor, tolerance, levels).front();
}

std::vector<Refined> refine_each(const SomeAtLevel& at_level, std::size_t count, const std::string& what,
                                 const Material& material, double floor, double tolerance, int levels) {
  constexpr double kEarlier = 0.1;
  constexpr double kSafety = 2;
  const double goal = std::max(tolerance, 2 * floor);
  std::vector<Refined> results(count);
  std::vector<std::size_t> rest(count);
  std::iota(rest.begin(), rest.end(), std::size_t{0});
  if (count == 0) return results;
  Eigen::MatrixXd coarse = at_level(rest, 0);
  Eigen::MatrixXd earlier = Eigen::MatrixXd::Zero(coarse.rows(), coarse.cols());
  for (int level = 1; !rest.empty(); ++level) {
    const Eigen::MatrixXd found = at_level(rest, level);
    std::vector<std::size_t> coarser;
    std::vector<Eigen::Index> columns;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const Eigen::ArrayXd fine = found.col(column);
      if (!fine.isFinite().all()) throw NumericError(what + " of '" + material.name + "' is no finite number");
      const Eigen::ArrayXd difference = (fine - coarse.col(column).array()).abs();
      const Eigen::ArrayXd error =
          kSafety * difference.max(kEarlier * earlier.col(column).array()) + floor * fine.abs();
      const double worst = (fine != 0).select(error / fine.abs(), 0.0).maxCoeff();
      if (worst <= goal || level + 1 == levels) {
        Refined& result = results[rest[k]];
        result = {{}, worst, worst <= goal};
        for (Eigen::Index c = 0; c < fine.size(); ++c) result.values.push_back({fine(c), error(c)});
        continue;
      }
      earlier.col(column) = difference;
      coarser.push_back(rest[k]);
      columns.push_back(column);
    }
    earlier = Eigen::MatrixXd(earlier(Eigen::all, columns));
    coarse = found(Eigen::all, columns);
    rest = std::move(coarser);
  }
  return results;
}

}  // namespace lobe
