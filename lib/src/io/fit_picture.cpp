#include <fmt/format.h>

#include <utility>

#include "io/reflectance_pair.hpp"
#include "lobe/fit_pictures.hpp"
#include "model/traits.hpp"

namespace lobe {
namespace {

std::string title_of(const std::string& target, const FitResult& fit) {
  if (fit.errors) {
    return fmt::format("{}, perceptual fit: relative errors up to {:.3g} (radiance) and {:.3g} (albedo)", target,
                       fit.errors->radiance.value.value, fit.errors->albedo.value.value);
  }
  const auto& [value, error] = fit.relative_residual;
  return fmt::format("{}, {} fit: relative residual {:.4g} ± {:.1g}", target, to_string(fit.objective), value, error);
}

PictureFiles write(const Device& device, DrawnReflectance target, const std::string& name, std::size_t channels,
                   bool is_target_isotropic, const FitResult& fit, const std::filesystem::path& directory,
                   const std::string& stem, const TablePictureOptions& options) {
  const ReflectancePair pair{.target = std::move(target),
                             .approximation = drawn(device, fit.material),
                             .kind = "Fit",
                             .name = "fit",
                             .title = title_of(name, fit),
                             .has_channels = channels > 1,
                             .is_isotropic = is_target_isotropic && is_isotropic(fit.material)};
  return write_pair_pictures(pair, directory, stem, options);
}

}  // namespace

PictureFiles write_fit_pictures(const Device& device, const Material& target, const FitResult& fit,
                                const std::filesystem::path& directory, const std::string& stem,
                                const TablePictureOptions& options) {
  return write(device, drawn(device, target), target.name, target.channels(), is_isotropic(target), fit, directory,
               stem, options);
}

PictureFiles write_fit_pictures(const Device& device, const BrdfFunction& target, const FitResult& fit,
                                const std::filesystem::path& directory, const std::string& stem,
                                const TablePictureOptions& options) {
  return write(device, drawn(target), target.name, target.channels.size(), target.is_isotropic, fit, directory, stem,
               options);
}

PictureFiles write_fit_pictures(const Device& device, const BrdfTable& target, const FitResult& fit,
                                const std::filesystem::path& directory, const std::string& stem,
                                const TablePictureOptions& options) {
  return write(device, drawn(target), target.expression, target.channels, target.form == TableForm::isotropic, fit,
               directory, stem, options);
}

}  // namespace lobe
