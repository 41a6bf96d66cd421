#include "lobe/table/reflectance.hpp"

#include <algorithm>

#include "model/traits.hpp"

namespace lobe {
namespace {

using Content = std::variant<Material, BrdfFunction, BrdfTable>;

template <typename... Functions>
struct Cases : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Cases(Functions...) -> Cases<Functions...>;

}  // namespace

Reflectance::Reflectance(Material formula) : content_(std::make_shared<const Content>(std::move(formula))) {}

Reflectance::Reflectance(BrdfFunction function) : content_(std::make_shared<const Content>(std::move(function))) {}

Reflectance::Reflectance(BrdfTable table) : content_(std::make_shared<const Content>(std::move(table))) {}

const std::string& Reflectance::name() const {
  if (const BrdfTable* own = table()) return own->expression;
  if (const Material* own = formula()) return own->name;
  return function()->name;
}

std::size_t Reflectance::channels() const {
  return visit(Cases{[](const Material& material) { return material.channels(); },
                     [](const BrdfFunction& brdf) { return brdf.channels.size(); },
                     [](const BrdfTable& own) { return own.channels; }});
}

bool Reflectance::is_isotropic() const {
  return visit(Cases{[](const Material& material) { return lobe::is_isotropic(material); },
                     [](const BrdfFunction& brdf) { return brdf.is_isotropic; },
                     [](const BrdfTable& own) { return own.form == TableForm::isotropic; }});
}

bool Reflectance::has_delta() const {
  return visit(Cases{[](const Material& material) {
                       return std::ranges::any_of(material.terms,
                                                  [](const Term& term) { return traits_of(term).has_delta; });
                     },
                     [](const BrdfFunction& brdf) { return brdf.cells && brdf.cells->has_delta(); },
                     [](const BrdfTable& own) { return own.has_delta(); }});
}

}  // namespace lobe
