// Builds every program that most tests use, once, so that tests in parallel find them in the runtime's cache.
// usage: lobe_warm_kernel_cache [double]: only those in double precision
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/lobe.hpp"
#include "support/materials.hpp"
#include "support/options.hpp"

namespace {

/// Tabulates the models that tests have tables of and composes in both forms.
void warm_algebra(const lobe::Device& device, lobe::Precision precision) {
  lobe::TabulateOptions options;
  options.precision = precision;
  options.allow_unresolved = true;
  lobe::ComposeOptions product;
  product.precision = precision;
  lobe::BrdfTable table;
  for (const auto& material : lobe::test::parse_all(lobe::test::sample_specifications())) {
    table = lobe::tabulate(device, material, lobe::HemisphereGrid::gauss(4, 8), options);
  }
  (void)lobe::compose(device, table, table, product);
  (void)lobe::compose(device, lobe::to_general(table), table, product);
}

}  // namespace

int main(int count, char** arguments) {
  try {
    std::vector<lobe::Precision> precisions{lobe::Precision::double_precision};
    if (count < 2 || std::string_view(arguments[1]) != "double")
      precisions.push_back(lobe::Precision::single_precision);

    const auto device = lobe::Device::choose();
    const lobe::Directions directions{0.5, 0.6, 3.0};
    const auto samples = lobe::test::parse_all(lobe::test::sample_specifications());
    std::vector<lobe::Material> materials;
    for (const auto& model : lobe::catalogue()) {
      if (model.traits.has_delta) continue;
      lobe::Term term{std::string(model.name), {}, {1.0}};
      for (const auto& parameter : model.parameters) {
        term.values.push_back(parameter.default_value ? *parameter.default_value
                                                      : std::clamp(1.5, parameter.minimum, parameter.maximum));
      }
      materials.push_back({std::string(model.name), "", {term}});
    }
    for (const auto precision : precisions) {
      for (const auto& material : materials)
        (void)lobe::evaluate(device, material, {&directions, 1}, {.precision = precision});
      warm_algebra(device, precision);
      for (const auto& lighting : {lobe::Lighting::point(), lobe::Lighting::daylight()}) {
        (void)lobe::measure(device, samples, lighting, lobe::test::with_tolerance(0.1, precision));
      }
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cannot warm the kernel cache: %s\n", error.what());
    return 1;
  }
}
