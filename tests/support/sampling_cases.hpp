#pragma once

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "lobe/model/material.hpp"
#include "lobe/model/model.hpp"
#include "lobe/plot/sampling_page.hpp"
#include "model/catalogue.hpp"
#include "model/sampling_strategy.hpp"

namespace lobe::test {

/// A material to draw directions of, and what its density looks like.
struct SamplingCase {
  std::string name;
  Material material;
  double width = 1;          ///< of the lobe, radians
  bool is_retro = false;     ///< its peak is about the light's own direction
  bool is_in_plane = false;  ///< the density is one of the distance in the base plane
  double edge = 2;           ///< where it jumps, in the base plane
};

inline SamplingCase sampling_case(const std::string& name, Material material) {
  SamplingCase one{name, std::move(material)};
  const CatalogueEntry& entry = find_entry(one.material.terms.front().model);
  const auto& values = one.material.terms.front().values;
  const LobeShape shape = entry.shape(values);
  one.width = shape.width;
  if (shape.retro_width < 0.5) {
    one.is_retro = true;
    one.width = std::min(one.width, 2 * shape.retro_width);
  }
  for (const double radius : {shape.patch_radius, shape.retro_patch_radius}) {
    if (radius > 0) one.edge = radius;
  }
  if (entry.model.parameters.size() > 1 && entry.model.parameters[1].name == "ratio") {
    // Drawn from the disc that reaches as far: R / ratio, and for powers above 2 the corners of the norm's ball.
    one.edge = values[0] / values[1] * std::pow(2, std::max(0.0, 0.5 - 1 / values[2]));
  }
  return one;
}

/// GoogleTest shows a case by its name.
inline std::ostream& operator<<(std::ostream& stream, const SamplingCase& one) {
  return stream << one.name;
}

/// Every model that has values, by its typical_material(), narrow lobes, and what else strategies have to draw.
inline std::vector<SamplingCase> sampling_cases() {
  std::vector<SamplingCase> list;
  for (const auto& model : catalogue()) {
    if (model.traits.has_delta) continue;
    list.push_back(sampling_case(std::string(model.name), typical_material(model.name)));
    const auto parts = propose(list.back().material.terms.front(), {0, 0, 1}, PatchDraw::exact);
    list.back().is_in_plane = std::ranges::any_of(parts, [](const ProposalPart& part) {
      return part.strategy == Strategy::patch || part.strategy == Strategy::patch_mixture;
    });
  }
  for (const std::string text :
       {"lambert:scale=0.3+ward:m=0.1,scale=0.5", "phong:n=40*cos_max*fresnel:ior=0.2,k=3.9", "ward:m=0.01",
        "phong:n=20000", "ggx:alpha=0.02", "ggx_anisotropic:alpha_x=0.05,alpha_y=0.3,rotation=0.5",
        "exponential_patch_anisotropic:s=8,ratio=0.4,p=1", "exponential_patch_anisotropic:s=8,ratio=0.4,p=20"}) {
    list.push_back(sampling_case(text, parse_material(text)));
  }
  return list;
}

}  // namespace lobe::test
