#include "model/catalogue/entries.hpp"

namespace lobe {
namespace {

/// A model without values in sr^-1: what split_delta() takes out of a material. It has no kernel.
CatalogueEntry delta_part(std::string_view name, std::string_view family, std::string_view formula,
                          std::string_view source) {
  return {
      {name, family, formula, source, {{"rho", "1", 0, 1, 1.0, "reflected share of the light"}}, {.has_delta = true}},
      {},
      [](Values) { return Coefficients{}; },
      [](Values) { return 1.0; }};
}
}  // namespace

void add_delta_parts(Entries& entries) {
  entries.push_back(delta_part("mirror", "ideal mirror", "rho Delta(V = R) / N.V",
                               "Neumann 2001, eq. 1.29 with F = rho: all light into the mirror direction R"));

  entries.push_back(delta_part("rrim", "retro-reflecting ideal mirror", "rho Delta(V = L) / N.L",
                               "Neumann 2001, eq. 1.26: RRIM, all light back to where it comes from"));
}

}  // namespace lobe
