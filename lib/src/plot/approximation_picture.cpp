#include <fmt/format.h>

#include <algorithm>

#include "lobe/plot/approximation_pictures.hpp"
#include "plot/reflectance_pair.hpp"

namespace lobe {

PictureFiles write_approximation_pictures(const Device& device, const Reflectance& target,
                                          const Approximation& approximation, const std::filesystem::path& directory,
                                          const std::string& stem, const TablePictureOptions& options) {
  const Reflectance& combination = approximation.combination;
  const auto& [value, error] = approximation.relative_residual;
  const ReflectancePair pair{.device = device,
                             .target = target,
                             .approximation = combination,
                             .kind = "Approximation",
                             .name = "approximation",
                             .result = fmt::format("lighting {}: relative residual {:.4g} ± {:.1g}",
                                                   approximation.lighting.name(), value, error),
                             .has_channels = std::max(target.channels(), combination.channels()) > 1,
                             .is_isotropic = target.is_isotropic() && combination.is_isotropic()};
  return write_pair_pictures(pair, directory, stem, options);
}

}  // namespace lobe
