#include "lut/lut_hdf5.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdint>
#include <span>

#include "core/text.hpp"
#include "hdf5/file_digest.hpp"
#include "hdf5/hdf5.hpp"
#include "hdf5/hdf5_input.hpp"
#include "hdf5/hdf5_output.hpp"
#include "lobe/core/version.hpp"

namespace lobe {
namespace {

std::vector<double> values_along(const LutAxis& axis) {
  std::vector<double> values;
  for (std::size_t i = 0; i < axis.count; ++i) values.push_back(axis.value(axis.coordinate(i)));
  return values;
}

hdf5::Dataset create_axis(hid_t root, const LutAxis& axis) {
  hdf5::Dataset dataset = hdf5::create_number_axis(root, axis.name, values_along(axis));
  hdf5::write_attributes(dataset.id(), {{"long_name", lut_axis_text(axis)},
                                        {"units", axis.name == "theta" ? "degree" : "1"},
                                        {"map", to_string(axis.map)},
                                        {"entries", to_string(axis.entries)}});
  hdf5::write_attribute(dataset.id(), "from", axis.from);
  hdf5::write_attribute(dataset.id(), "to", axis.to);
  return dataset;
}

void write_column(hid_t root, const Lut& lut, std::size_t column, std::span<const hdf5::Dataset* const> along) {
  const auto of_column = [&](const std::vector<double>& all) {
    std::vector<double> numbers;
    for (std::size_t i = column; i < all.size(); i += lut.columns.size()) numbers.push_back(all[i]);
    return numbers;
  };
  const std::string& name = lut.columns[column];
  const std::string error = name + "_error";
  const auto values = hdf5::create_dataset(root, name, of_column(lut.values), along);
  hdf5::write_attributes(values.id(), {{"long_name", name + " of: " + lut_quantity_text(lut.request)}, {"units", "1"}});
  if (lut.errors.empty()) return;
  hdf5::write_attribute(values.id(), "ancillary_variables", error);
  const auto errors = hdf5::create_dataset(root, error, of_column(lut.errors), along);
  hdf5::write_attributes(errors.id(), {{"long_name", "bound on the error of " + name}, {"units", "1"}});
}

}  // namespace

std::string lut_hdf5(const Lut& lut, const std::optional<LutErrors>& errors, const std::vector<std::string>& lines) {
  const std::string image = hdf5::file_image([&](hid_t root) {
    hdf5::write_attributes(root, {{"Conventions", "CF-1.10, ACDD-1.3"},
                                  {"title", lut_quantity_text(lut.request)},
                                  {"comment", fmt::format("{}", fmt::join(lines, "\n"))},
                                  {"source", fmt::format("lobe {} ({})", version(), commit())},
                                  {"lobe_schema", "lobe-lut/1"},
                                  {"material", lut.request.reflectance.name()},
                                  {"quantity", to_string(lut.request.quantity)},
                                  {"split", lut.request.split}});
    if (errors) {
      hdf5::write_attribute(root, "error_of_entries", errors->entries.largest);
      hdf5::write_attribute(root, "error_of_interpolation", errors->between.largest);
      hdf5::write_attribute(root, "error_up_to_the_ends", errors->all.largest);
    }
    std::vector<hdf5::Dataset> axes;
    for (const LutAxis& axis : lut.request.axes) axes.push_back(create_axis(root, axis));
    std::vector<const hdf5::Dataset*> along;
    for (const auto& axis : axes) along.push_back(&axis);
    for (std::size_t c = 0; c < lut.columns.size(); ++c) write_column(root, lut, c, along);
  });
  return image + digest_of(image);
}

std::vector<double> read_lut_hdf5(const std::filesystem::path& path, const LutRequest& request,
                                  const std::vector<std::string>& columns) {
  constexpr double kSame = 1e-6;  // of the range: an axis that was written in single precision
  const hdf5::InputFile file(path);
  std::vector<hsize_t> shape;
  for (const LutAxis& axis : request.axes) shape.push_back(axis.count);
  for (const LutAxis& axis : request.axes) {
    const std::string name = "/" + axis.name;
    if (!file.has(name)) continue;
    const std::vector<hsize_t> length{axis.count};
    const std::vector<double> wanted = values_along(axis);
    const std::vector<double> found = file.read(name, length);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (std::abs(found[i] - wanted[i]) <= kSame * std::abs(axis.to - axis.from)) continue;
      file.refuse(fmt::format("entry {} of axis {} is {}; the axis asked for has {}", i + 1, axis.name,
                              shortest(found[i]), shortest(wanted[i])));
    }
  }
  std::vector<std::vector<double>> parts;
  for (const auto& column : columns) {
    const std::string name = "/" + column;
    if (!file.has(name) && !parts.empty()) break;
    parts.push_back(file.read(name, shape));
  }
  std::vector<double> numbers;
  for (std::size_t i = 0; i < parts.front().size(); ++i) {
    for (const auto& part : parts) numbers.push_back(part[i]);
  }
  return numbers;
}

}  // namespace lobe
