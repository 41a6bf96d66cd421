#include <fmt/format.h>

#include "lobe/plot/fit_pictures.hpp"
#include "model/traits.hpp"
#include "plot/reflectance_pair.hpp"

namespace lobe {
namespace {

std::string result_of(const FitResult& fit) {
  if (fit.errors) {
    return fmt::format("perceptual fit: relative errors up to {:.3g} (radiance) and {:.3g} (albedo)",
                       fit.errors->radiance.value.value, fit.errors->albedo.value.value);
  }
  const auto& [value, error] = fit.relative_residual;
  return fmt::format("{} fit: relative residual {:.4g} ± {:.1g}", to_string(fit.objective), value, error);
}

}  // namespace

PictureFiles write_fit_pictures(const Device& device, const Reflectance& target, const FitResult& fit,
                                const std::filesystem::path& directory, const std::string& stem,
                                const TablePictureOptions& options) {
  const ReflectancePair pair{.device = device,
                             .target = target,
                             .approximation = fit.material,
                             .kind = "Fit",
                             .name = "fit",
                             .result = result_of(fit),
                             .has_channels = target.channels() > 1,
                             .is_isotropic = target.is_isotropic() && is_isotropic(fit.material)};
  return write_pair_pictures(pair, directory, stem, options);
}

}  // namespace lobe
