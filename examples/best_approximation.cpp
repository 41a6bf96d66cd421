// A costly reflectance as the nearest combination, without negative coefficients, of cheap ones: from the Gram matrix
// of the cheap ones (Neumann 2001, section 5.3.1).
#include <cstdio>
#include <lobe/lobe.hpp>
#include <vector>

int main() {
  try {
    const lobe::Material target = lobe::make_material("cook_torrance", {{"m", 0.3}});
    const std::vector basis{lobe::make_material("lambert"), lobe::make_material("metal_phong", {{"n", 5}}),
                            lobe::make_material("metal_phong", {{"n", 20}})};

    const auto device = lobe::Device::choose();
    lobe::ApproximationOptions options;
    options.form.non_negative = true;
    const lobe::Approximation found = lobe::approximate(device, target, basis, lobe::Lighting::point(), options);

    const lobe::LinearFit& fit = found.fits.front();
    for (std::size_t i = 0; i < basis.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      std::printf("%10.6f +- %.0e  %s\n", fit.coefficients(k), fit.coefficients_error(k), basis[i].name.c_str());
    }
    std::printf("|f - sum| / |f| = %.6f +- %.0e, condition of the Gram matrix %.1f\n", found.relative_residual.value,
                found.relative_residual.error, fit.condition);

    // The combination is a material like any other.
    const auto albedos = lobe::albedo(device, found.material, std::vector{0.0, 1.0});
    std::printf("albedo %.6f for light along the normal, %.6f at 1 rad\n", albedos[0][0].value, albedos[0][1].value);
    return 0;
  } catch (const lobe::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
