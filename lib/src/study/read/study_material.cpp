#include <algorithm>
#include <utility>

#include "lobe/study/study.hpp"

namespace lobe {

StudyMaterial::StudyMaterial(Material formula) : label_{formula.name, formula.family}, content_(std::move(formula)) {}

StudyMaterial::StudyMaterial(MaterialLabel label, MaterialFile file)
    : label_(std::move(label)), content_(std::move(file)) {}

StudyMaterial::StudyMaterial(MaterialLabel label) : label_(std::move(label)) {}

const Material* StudyMaterial::formula() const {
  return std::get_if<Material>(&content_);
}

const MaterialFile* StudyMaterial::file() const {
  return std::get_if<MaterialFile>(&content_);
}

std::vector<MaterialLabel> labels(const Study& study) {
  std::vector<MaterialLabel> all;
  for (const StudyMaterial& material : study.materials) all.push_back(material.label());
  return all;
}

std::vector<Material> formulas(const Study& study) {
  std::vector<Material> all;
  for (const StudyMaterial& material : study.materials) {
    if (const Material* formula = material.formula()) all.push_back(*formula);
  }
  return all;
}

std::size_t count_files(const Study& study) {
  return static_cast<std::size_t>(
      std::ranges::count_if(study.materials, [](const StudyMaterial& material) { return material.file() != nullptr; }));
}

}  // namespace lobe
