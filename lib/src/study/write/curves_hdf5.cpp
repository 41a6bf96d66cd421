#include "study/write/curves_hdf5.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lobe {
namespace {

struct Values {
  std::vector<double> value;
  std::vector<double> error;

  void append(std::span<const Estimate> estimates) {
    for (const Estimate& estimate : estimates) {
      value.push_back(estimate.value);
      error.push_back(estimate.error);
    }
  }
};

/// \param append appends those of one material and channel
Values values_of(const StudyResult& result,
                 const std::function<void(Values&, const MaterialCurves&, std::size_t)>& append) {
  Values values;
  for (const MaterialCurves& curves : result.curves) {
    for (std::size_t c = 0; c < result.study.channels.size(); ++c) {
      // A single channel serves all channels.
      append(values, curves, std::min(c, curves.albedo.size() - 1));
    }
  }
  return values;
}

void write_values(hid_t group, const std::string& name, const Values& values,
                  std::span<const hdf5::Dataset* const> along, const std::string& meaning, const std::string& unit) {
  const auto dataset = hdf5::create_dataset(group, name, values.value, along);
  hdf5::write_attributes(dataset.id(),
                         {{"long_name", meaning}, {"units", unit}, {"ancillary_variables", name + "_error"}});
  const auto error = hdf5::create_dataset(group, name + "_error", values.error, along);
  hdf5::write_attributes(error.id(), {{"long_name", "error estimates of the " + meaning}, {"units", unit}});
}

hdf5::Dataset write_angles(hid_t group, const std::string& name, std::span<const double> angles,
                           const std::string& meaning) {
  auto axis = hdf5::create_number_axis(group, name, angles);
  hdf5::write_attributes(axis.id(), {{"long_name", meaning}, {"units", "rad"}});
  return axis;
}

}  // namespace

void write_curves(hid_t root, const StudyResult& result, const hdf5::Dataset& material, const hdf5::Dataset& channel) {
  if (result.curves.empty()) return;
  const auto group = hdf5::create_group(root, "curves");
  hdf5::write_attribute(group.id(), "comment", "the materials themselves, for light of azimuth 0");
  const CurveAngles& angles = result.curve_angles;
  const auto theta = write_angles(group.id(), "theta", angles.theta, "angle of incidence of the albedos");
  const auto theta_in = write_angles(group.id(), "theta_in", angles.theta_in, "angle of incidence of the reflectances");
  const auto theta_out = write_angles(group.id(), "theta_out", angles.theta_out,
                                      "angle of the viewer in the plane of incidence, below 0 on the retro side");

  const auto albedos = values_of(result, [](Values& values, const MaterialCurves& curves, std::size_t channel_number) {
    values.append(curves.albedo[channel_number]);
  });
  const hdf5::Dataset* const along_theta[] = {&material, &channel, &theta};
  write_values(group.id(), "albedo", albedos, along_theta, "albedos", "1");

  const auto slices = values_of(result, [](Values& values, const MaterialCurves& curves, std::size_t channel_number) {
    for (const auto& slice : curves.reflectance[channel_number]) values.append(slice);
  });
  const hdf5::Dataset* const along_pairs[] = {&material, &channel, &theta_in, &theta_out};
  write_values(group.id(), "reflectance", slices, along_pairs, "reflectances without delta parts", "sr-1");

  std::vector<std::int32_t> deltas;
  for (const MaterialCurves& curves : result.curves) deltas.push_back(curves.has_delta ? 1 : 0);
  const hdf5::Dataset* const by_material[] = {&material};
  const auto dataset = hdf5::create_integer_dataset(group.id(), "has_delta", deltas, by_material);
  hdf5::write_attribute(dataset.id(), "long_name", "1 for materials with delta parts, which albedos include, else 0");
}

}  // namespace lobe
