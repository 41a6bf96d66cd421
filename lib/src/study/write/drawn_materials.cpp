#include "study/write/drawn_materials.hpp"

namespace lobe {

std::vector<DrawnMaterial> drawn_materials(const Study& study) {
  std::vector<DrawnMaterial> drawn;
  for (const StudyMaterial& material : study.materials) {
    const Material* formula = material.formula();
    drawn.push_back({material.label(), formula != nullptr ? formula->terms : std::vector<Term>()});
  }
  return drawn;
}

}  // namespace lobe
