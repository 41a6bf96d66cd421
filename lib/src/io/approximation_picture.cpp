#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/reflectance_pair.hpp"
#include "lobe/approximation_pictures.hpp"
#include "model/traits.hpp"

namespace lobe {

namespace {

/// What is drawn, and what is to be said of it.
struct DrawnTarget {
  DrawnReflectance reflectance;
  std::string name;
  std::size_t channels;
  bool is_isotropic;
};

PictureFiles write(const Device& device, DrawnTarget target, const Approximation& approximation,
                   const std::filesystem::path& directory, const std::string& stem,
                   const TablePictureOptions& options) {
  const Material& material = approximation.material;
  const auto& [value, error] = approximation.relative_residual;
  const ReflectancePair pair{.target = std::move(target.reflectance),
                             .approximation = drawn(device, material),
                             .kind = "Approximation",
                             .name = "approximation",
                             .title = fmt::format("{}, lighting {}: relative residual {:.4g} ± {:.1g}", target.name,
                                                  approximation.lighting.name(), value, error),
                             .has_channels = std::max(target.channels, material.channels()) > 1,
                             .is_isotropic = target.is_isotropic && is_isotropic(material)};
  return write_pair_pictures(pair, directory, stem, options);
}

}  // namespace

PictureFiles write_approximation_pictures(const Device& device, const Material& target,
                                          const Approximation& approximation, const std::filesystem::path& directory,
                                          const std::string& stem, const TablePictureOptions& options) {
  return write(device, {drawn(device, target), target.name, target.channels(), is_isotropic(target)}, approximation,
               directory, stem, options);
}

PictureFiles write_approximation_pictures(const Device& device, const BrdfFunction& target,
                                          const Approximation& approximation, const std::filesystem::path& directory,
                                          const std::string& stem, const TablePictureOptions& options) {
  return write(device, {drawn(target), target.name, target.channels.size(), target.is_isotropic}, approximation,
               directory, stem, options);
}

PictureFiles write_approximation_pictures(const Device& device, const BrdfTable& target,
                                          const Approximation& approximation, const std::filesystem::path& directory,
                                          const std::string& stem, const TablePictureOptions& options) {
  return write(device, {drawn(target), target.expression, target.channels, target.form == TableForm::isotropic},
               approximation, directory, stem, options);
}

}  // namespace lobe
