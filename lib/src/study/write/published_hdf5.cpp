#include "study/write/published_hdf5.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "study/write/origin_text.hpp"

namespace lobe {
namespace {

using Texts = std::vector<std::string>;
using Numbers = std::vector<double>;
using Flags = std::vector<std::int32_t>;

}  // namespace

void write_published(hid_t root, const StudyResult& result) {
  const auto& figures = result.study.published;
  const auto& checks = result.published;
  if (figures.empty()) return;
  const auto group = hdf5::create_group(root, "published");
  Texts labels;
  for (const auto& figure : figures) labels.push_back(figure.label);
  const auto axis = hdf5::create_text_axis(group.id(), "figure", labels);
  hdf5::write_attribute(axis.id(), "long_name", "which figure of its table");

  const auto texts = [&](const std::string& name, const char* meaning, const auto& of) {
    Texts values;
    for (const auto& figure : figures) values.push_back(std::invoke(of, figure));
    hdf5::write_attribute(hdf5::create_text_dataset(group.id(), name, values, axis).id(), "long_name", meaning);
  };
  if (!result.study.origins.published.empty()) {
    const auto origins = origin_texts(result.study.origins.published, figures.size());
    const auto origin = hdf5::create_text_dataset(group.id(), "origin", origins, axis);
    hdf5::write_attribute(origin.id(), "long_name", kOriginMeaning);
  }
  texts("table", "title of the table that the figure is printed in", &PublishedFigure::table);
  texts("quantity", "what the figure says of the material",
        [](const PublishedFigure& figure) { return std::string(to_string(figure.quantity)); });
  texts("material_json", "terms of the material with models, parameters and weights, as JSON",
        [](const PublishedFigure& figure) { return to_json(figure.material); });
  texts("printed", "the figure as printed", &PublishedFigure::printed);
  texts("corrected", "what should be printed; empty where the printed figure is right", &PublishedFigure::corrected);

  const hdf5::Dataset* const along[] = {&axis};
  const auto numbers = [&](const std::string& name, const char* meaning, const auto& of) {
    Numbers values;
    for (const auto& check : checks) values.push_back(of(check));
    return hdf5::write_attribute(hdf5::create_dataset(group.id(), name, values, along).id(), "long_name", meaning);
  };
  numbers("value", "value computed, in the unit of the figure", [](const auto& check) { return check.value.value; });
  numbers("value_error", "error estimates of the values", [](const auto& check) { return check.value.error; });
  numbers("deviation", "value less printed figure, in units of the figure's last digit",
          [](const auto& check) { return check.deviation; });

  const auto flags = [&](const std::string& name, const char* meaning, bool PublishedCheck::*of) {
    Flags values;
    for (const auto& check : checks) values.push_back(check.*of ? 1 : 0);
    hdf5::write_attribute(hdf5::create_integer_dataset(group.id(), name, values, along).id(), "long_name", meaning);
  };
  flags("agrees", "1 where the value rounds to the printed figure, else 0", &PublishedCheck::agrees);
  flags("as_expected", "1 where the value rounds to what should be printed and only to that, else 0",
        &PublishedCheck::is_as_expected);
}

}  // namespace lobe
