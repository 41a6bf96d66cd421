#include <cmath>

#include "core/text.hpp"
#include "lobe/fit/approximation.hpp"

namespace lobe {

std::string csv_text(const FamilyResiduals& residuals) {
  std::string text = "material";
  for (const auto& family : residuals.families) text += ',' + csv_field(family);
  text += ",best\n";
  for (std::size_t t = 0; t < residuals.targets.size(); ++t) {
    text += csv_field(residuals.targets[t]);
    const auto row = residuals.relative_residual.row(static_cast<Eigen::Index>(t));
    Eigen::Index best = -1;
    for (Eigen::Index f = 0; f < row.size(); ++f) {
      text += ',';
      if (std::isnan(row(f))) continue;
      text += shortest(row(f));
      if (best < 0 || row(f) < row(best)) best = f;
    }
    text += ',';
    if (best >= 0) text += csv_field(residuals.families[static_cast<std::size_t>(best)]);
    text += '\n';
  }
  return text;
}

}  // namespace lobe
