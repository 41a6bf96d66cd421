// A reflectance of one's own: compiled for the device, tested for reciprocity, tabulated, composed with itself and held
// against a model of the catalogue.
#include <cstdio>
#include <lobe/lobe.hpp>
#include <string>
#include <vector>

int main() {
  try {
    lobe::Term term{.model = std::string(lobe::kCustomModel), .values = {0.8, 40}, .weight = {1}};
    term.formula = lobe::Formula{.text = "rho * (n + 2) / (2 * pi) * exp(n * log_rv) / fmax(cos_i, cos_o)",
                                 .parameters = {"rho", "n"},
                                 .width = 0.1};
    const auto device = lobe::Device::choose();
    const lobe::Reflectance metal = lobe::Material{"my metal", "mine", {term}};

    const lobe::Material twin = lobe::make_material("metal_phong", {{"n", 40}});
    const lobe::Estimate angle =
        lobe::angle(lobe::measure(device, {metal, twin}, lobe::Lighting::point()).combined, 0, 1);
    std::printf("angle to %s: %.1e +- %.0e rad\n", twin.name.c_str(), angle.value, angle.error);

    const lobe::BrdfTable table = lobe::tabulate(device, metal, lobe::HemisphereGrid::gauss(64, 128));
    const lobe::BrdfTable twice = lobe::self_compose(device, table);
    for (const auto* one : {&table, &twice}) {
      const lobe::Estimate albedo = lobe::albedo(device, *one, std::vector{0.5})[0][0];
      std::printf("albedo at 0.5 rad %.5f +- %.0e\n", albedo.value, albedo.error);
    }
    lobe::save(twice, "my-metal-twice.h5", {.overwrite = true});
    return 0;
  } catch (const lobe::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
