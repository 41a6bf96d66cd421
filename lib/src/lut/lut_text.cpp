#include <fmt/format.h>

#include <algorithm>

#include "core/text.hpp"
#include "lobe/lut/lut.hpp"

namespace lobe {
namespace {

std::string_view unit_of(const LutAxis& axis) {
  return axis.name == "theta" ? " degrees" : "";
}

std::string_view name_of(LutQuantity quantity) {
  switch (quantity) {
    case LutQuantity::albedo:
      return "directional albedo";
    case LutQuantity::complement:
      return "1 - directional albedo";
    case LutQuantity::mean_albedo:
      return "mean albedo";
    case LutQuantity::mean_complement:
      return "1 - mean albedo";
  }
  return "";
}

}  // namespace

std::string lut_quantity_text(const LutRequest& request) {
  std::string text = fmt::format("{} of {}", name_of(request.quantity), request.reflectance.name());
  if (request.split == "f82") {
    text += " = bias + f0 * scale - (1 - tint) * (f0 + (1 - f0) * 7776/16807) * edge";
  } else if (!request.split.empty()) {
    text += fmt::format(" = bias + {} * scale", request.split);
  }
  return text;
}

std::string lut_axis_text(const LutAxis& axis) {
  std::string text =
      fmt::format("{} from {} to {}{}, {} {}", axis.name, shortest(axis.from), shortest(axis.to), unit_of(axis),
                  axis.count, axis.entries == AxisEntries::centres ? "cell centres" : "nodes");
  if (std::min(axis.from, axis.to) < axis.least) text += fmt::format(", at least {}", shortest(axis.least));
  if (axis.map != AxisMap::linear) text += fmt::format(", equally spaced in {}({})", to_string(axis.map), axis.name);
  return text;
}

std::string lut_place_text(const Lut& lut, const LutDeviation& deviation) {
  std::string text;
  for (std::size_t a = 0; a < deviation.at.size(); ++a) {
    const LutAxis& axis = lut.request.axes[a];
    text += fmt::format("{}{} {:.4g}{}", a == 0 ? "" : ", ", axis.name, deviation.at[a], unit_of(axis));
  }
  if (lut.columns.size() > 1) text += fmt::format(" ({})", lut.columns[deviation.column]);
  return text;
}

}  // namespace lobe
