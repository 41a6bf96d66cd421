#include "study/write/chart_hdf5.hpp"

#include <string>
#include <vector>

#include "study/write/origin_text.hpp"

namespace lobe {
namespace {

void write_chart(hid_t charts, const Study& study, std::size_t index, const ChartValues& values) {
  const Chart& chart = study.charts[index];
  const auto group = hdf5::create_group(charts, chart.name);
  hdf5::write_attributes(group.id(), {{"title", chart.title}, {"quantity", std::string(to_string(chart.quantity))}});

  if (const auto origin = origin_text(study.origins.charts, index); !origin.empty()) {
    hdf5::write_attribute(group.id(), "origin", origin);
  }

  std::vector<std::string> labels;
  std::vector<std::string> materials;
  std::vector<double> theta_in;
  for (const auto& curve : chart.curves) {
    labels.push_back(curve.label);
    materials.push_back(to_json(curve.materials.front()));
    theta_in.push_back(curve.theta_in);
  }
  const auto curve_axis = hdf5::create_text_axis(group.id(), "curve", labels);
  if (index < study.origins.curves.size()) {
    const auto origins = origin_texts(study.origins.curves[index], chart.curves.size());
    const auto origin = hdf5::create_text_dataset(group.id(), "origin", origins, curve_axis);
    hdf5::write_attribute(origin.id(), "long_name", kOriginMeaning);
  }
  const auto x_axis = hdf5::create_number_axis(group.id(), "x", chart.x);
  const bool is_angle = is_over_angle(chart.quantity);
  hdf5::write_attributes(
      x_axis.id(), {{"long_name", is_angle ? "polar angle" : chart.parameter}, {"units", is_angle ? "rad" : "1"}});
  const auto json = hdf5::create_text_dataset(group.id(), "material_json", materials, curve_axis);
  hdf5::write_attribute(json.id(), "long_name",
                        is_angle ? "the material, as JSON" : "the material with the first value of x, as JSON");
  if (is_over_viewer(chart.quantity)) {
    const hdf5::Dataset* const along[] = {&curve_axis};
    const auto angles = hdf5::create_dataset(group.id(), "theta_in", theta_in, along);
    hdf5::write_attributes(angles.id(), {{"long_name", "angle of incidence"}, {"units", "rad"}});
  }

  std::vector<double> all;
  std::vector<double> errors;
  for (const auto& curve : values) {
    for (const Estimate& value : curve) {
      all.push_back(value.value);
      errors.push_back(value.error);
    }
  }
  const hdf5::Dataset* const along[] = {&curve_axis, &x_axis};
  const bool is_ratio = chart.unit || chart.quantity == ChartQuantity::albedo || !is_angle;
  const auto numbers = hdf5::create_dataset(group.id(), "value", all, along);
  hdf5::write_attributes(numbers.id(),
                         {{"long_name", chart.unit ? "the quantity over f(N, N) of unit_json" : "the quantity"},
                          {"units", is_ratio ? "1" : "sr-1"},
                          {"ancillary_variables", "value_error"}});
  if (chart.unit) hdf5::write_attribute(numbers.id(), "unit_json", to_json(*chart.unit));
  const auto error = hdf5::create_dataset(group.id(), "value_error", errors, along);
  hdf5::write_attribute(error.id(), "long_name", "error estimates of the values");
}

}  // namespace

void write_charts(hid_t root, const StudyResult& result) {
  if (result.charts.empty()) return;
  const auto group = hdf5::create_group(root, "charts");
  for (std::size_t i = 0; i < result.charts.size(); ++i) {
    write_chart(group.id(), result.study, i, result.charts[i]);
  }
}

}  // namespace lobe
