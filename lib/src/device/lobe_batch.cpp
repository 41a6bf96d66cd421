#include "device/lobe_batch.hpp"

#include "device/program.hpp"

namespace lobe {

std::size_t LobeBatch::numbers_per_lobe() const {
  return kCoefficients + kernel.curves * (kCurveNumbers + (kernel.curve_parts > 0 ? kPartCounts : 0) +
                                          kernel.curve_parts * kPartNumbers);
}

std::vector<double> LobeBatch::numbers(std::size_t lobe) const {
  std::vector<double> list(coefficients[lobe].begin(), coefficients[lobe].end());
  if (kernel.curves > 0) list.insert(list.end(), curves[lobe].begin(), curves[lobe].end());
  return list;
}

cl::Program build_lobe_program(const Device& device, const LobeKernel& kernel, std::string_view launcher,
                               Precision precision, std::string_view header) {
  std::vector<KernelText> parts;
  std::string options = kernel.is_anisotropic ? " -D ANISOTROPIC=1" : "";
  for (std::size_t k = 0; k < kernel.factors.size(); ++k) {
    parts.push_back({"factors/" + kernel.factors[k] + ".clh", {}});
    options += " -D FACTOR_" + std::to_string(k) + "=factor_" + kernel.factors[k];
  }
  if (kernel.source.empty()) {
    parts.push_back({"models/" + kernel.model + ".clh", {}});
  } else {
    parts.push_back({"lobes/formula.clh", {}});
    parts.push_back({{}, kernel.source});
  }
  if (kernel.curves > 0) {
    parts.push_back({"lobes/pumping.clh", {}});
    options += " -D CURVES=" + std::to_string(kernel.curves) + " -D PUMPING=pumping_" + kernel.pumping;
    if (kernel.curve_parts > 0) options += " -D CURVE_PARTS=" + std::to_string(kernel.curve_parts);
  }
  if (kernel.factors.empty() && kernel.curves == 0) {
    options += " -D MODEL=" + kernel.model;
  } else {
    parts.push_back({"lobes/combined.clh", {}});
    options += " -D BASE=" + kernel.model + " -D MODEL=combined";
  }
  if (!header.empty()) parts.push_back({std::string(header), {}});
  parts.push_back({std::string(launcher), {}});
  return build_program(device, parts, precision, options.substr(1));
}

}  // namespace lobe
