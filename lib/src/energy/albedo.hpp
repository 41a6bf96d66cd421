#pragma once

#include <span>
#include <vector>

#include "lobe/energy/albedo.hpp"

namespace lobe {

// Albedos, overloaded for each kind of reflectance (table/evaluate.hpp has those of tables). They throw as the public
// functions with these names.

/// \param material prepared
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const Device& device, const Material& material,
                                                        std::span<const double> theta_in,
                                                        const AlbedoOptions& options = {});
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const Device& device, const Material& material,
                                                        std::span<const Direction> incident,
                                                        const AlbedoOptions& options = {});
/// Albedos from values alone: cells have none.
/// \throws ArgumentError, besides, for delta parts
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const BrdfFunction& function, std::span<const double> theta_in,
                                                        double lobe_width = AlbedoOptions{}.lobe_width);
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const BrdfFunction& function,
                                                        std::span<const Direction> incident,
                                                        double lobe_width = AlbedoOptions{}.lobe_width);

[[nodiscard]] std::vector<Estimate> mean_albedo(const Device& device, const Material& material,
                                                const AlbedoOptions& options = {});
[[nodiscard]] std::vector<Estimate> mean_albedo(const BrdfFunction& function,
                                                double lobe_width = AlbedoOptions{}.lobe_width);

[[nodiscard]] std::vector<AlbedoPeak> largest_albedo(const Device& device, const Material& material,
                                                     double theta_max = kAlbedoPeakThetaMax,
                                                     const AlbedoOptions& options = {});

}  // namespace lobe
