#include "hdf5/hdf5.hpp"

#include <hdf5_hl.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

#include "lobe/core/error.hpp"

namespace lobe::hdf5 {
namespace {

constexpr hsize_t kChunkDoubles = (hsize_t{1} << 20) / sizeof(double);
constexpr unsigned kDeflateLevel = 4;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

herr_t keep_first(unsigned index, const H5E_error2_t* entry, void* text) {
  if (index == 0 && entry->desc != nullptr) *static_cast<std::string*>(text) = entry->desc;
  return 0;
}

Type text_type() {
  Type type(H5Tcopy(H5T_C_S1), "create the text type");
  check(H5Tset_size(type.id(), H5T_VARIABLE), "create the text type");
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8), "create the text type");
  return type;
}

Space scalar_space() {
  return {H5Screate(H5S_SCALAR), "create a scalar space"};
}

Space array_space(std::span<const hsize_t> shape, const std::string& name) {
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), "create the space of " + name};
}

/// Creation properties all datasets share: no time stamps, so that the same data give the same bytes.
Properties dataset_properties(const std::string& name) {
  Properties properties(H5Pcreate(H5P_DATASET_CREATE), "create properties of " + name);
  check(H5Pset_obj_track_times(properties.id(), false), "set properties of " + name);
  check(H5Pset_attr_creation_order(properties.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED),
        "set properties of " + name);
  return properties;
}

hsize_t length(const Dataset& axis) {
  const Space space(H5Dget_space(axis.id()), "read the length of an axis");
  return static_cast<hsize_t>(check(H5Sget_simple_extent_npoints(space.id()), "read the length of an axis"));
}

std::vector<hsize_t> shape_along(std::span<const Dataset* const> axes) {
  std::vector<hsize_t> shape;
  for (const Dataset* axis : axes) shape.push_back(length(*axis));
  return shape;
}

/// Lengths of the axes of so many values.
std::vector<hsize_t> shape_of(const std::string& name, std::size_t values, std::span<const Dataset* const> axes) {
  std::vector<hsize_t> shape = shape_along(axes);
  if (std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>()) != values) {
    throw ArgumentError("dataset " + name + ": number of values and axes differ");
  }
  return shape;
}

void attach_axes(const Dataset& dataset, std::span<const Dataset* const> axes, const std::string& name) {
  unsigned index = 0;
  for (const Dataset* axis : axes) check(H5DSattach_scale(dataset.id(), axis->id(), index++), "attach axes to " + name);
}

Dataset write_texts(hid_t parent, const std::string& name, std::span<const std::string> values) {
  const hsize_t shape = values.size();
  const Type type = text_type();
  const Space space = array_space({&shape, 1}, name);
  const Properties properties = dataset_properties(name);
  Dataset dataset(H5Dcreate2(parent, name.c_str(), type.id(), space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
                  "create dataset " + name);
  std::vector<const char*> pointers;
  for (const auto& value : values) pointers.push_back(value.c_str());
  if (!pointers.empty()) {
    check(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), "write dataset " + name);
  }
  return dataset;
}

void make_axis(const Dataset& dataset, const std::string& name) {
  check(H5DSset_scale(dataset.id(), name.c_str()), "make an axis of " + name);
}

/// How numbers are kept: in chunks, compressed or not, with checksums.
Properties number_properties(const std::string& name, std::span<const hsize_t> chunk, bool compress) {
  const std::string operation = "set properties of " + name;
  Properties properties = dataset_properties(name);
  check(H5Pset_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data()), operation);
  if (compress) {
    check(H5Pset_shuffle(properties.id()), operation);
    check(H5Pset_deflate(properties.id(), kDeflateLevel), operation);
  }
  check(H5Pset_fletcher32(properties.id()), operation);
  return properties;
}

/// A dataset of doubles, missing where nothing is written.
Dataset create_numbers(hid_t parent, const std::string& name, std::span<const hsize_t> shape,
                       std::span<const hsize_t> chunk, bool compress) {
  const Properties properties = number_properties(name, chunk, compress);
  check(H5Pset_fill_value(properties.id(), H5T_NATIVE_DOUBLE, &kMissing), "set properties of " + name);
  const Space space = array_space(shape, name);
  return {H5Dcreate2(parent, name.c_str(), H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
          "create dataset " + name};
}

void write_all(const Dataset& dataset, const std::string& name, std::span<const double> values) {
  check(H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        "write dataset " + name);
}

template <typename Value>
void write_numbers(hid_t object, const char* name, hid_t stored, hid_t given, const Space& space, const Value* values) {
  const Attribute attribute(H5Acreate2(object, name, stored, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                            std::string("create attribute ") + name);
  check(H5Awrite(attribute.id(), given, values), std::string("write attribute ") + name);
}

}  // namespace

std::string failure_cause() {
  std::string cause = "unknown cause";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &cause);
  return cause;
}

void throw_failure(std::string_view operation) {
  throw IoError("cannot " + std::string(operation) + ": " + failure_cause());
}

QuietErrors::QuietErrors() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietErrors::~QuietErrors() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

Group create_group(hid_t parent, const std::string& name) {
  const Properties creation(H5Pcreate(H5P_GROUP_CREATE), "create properties of " + name);
  constexpr unsigned kOrder = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
  check(H5Pset_link_creation_order(creation.id(), kOrder), "set properties of " + name);
  check(H5Pset_attr_creation_order(creation.id(), kOrder), "set properties of " + name);
  check(H5Pset_obj_track_times(creation.id(), false), "set properties of " + name);
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), "create group " + name};
}

void write_attribute(hid_t object, const char* name, std::string_view value) {
  const Type type = text_type();
  const std::string text(value);
  const char* pointer = text.c_str();
  write_numbers(object, name, type.id(), type.id(), scalar_space(), &pointer);
}

void write_attribute(hid_t object, const char* name, double value) {
  write_numbers(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, scalar_space(), &value);
}

void write_attribute(hid_t object, const char* name, std::int64_t value) {
  write_numbers(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, scalar_space(), &value);
}

void write_attribute(hid_t object, const char* name, std::span<const double> values) {
  const hsize_t shape = values.size();
  write_numbers(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, array_space({&shape, 1}, name), values.data());
}

void write_attributes(hid_t object, std::initializer_list<TextAttribute> attributes) {
  for (const auto& [name, value] : attributes) write_attribute(object, name, value);
}

Dataset create_text_axis(hid_t parent, const std::string& name, std::span<const std::string> labels) {
  Dataset dataset = write_texts(parent, name, labels);
  make_axis(dataset, name);
  return dataset;
}

Dataset create_index_axis(hid_t parent, const std::string& name, std::size_t count, std::int32_t first) {
  std::vector<std::int32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  const hsize_t shape = count;
  const Space space = array_space({&shape, 1}, name);
  const Properties properties = dataset_properties(name);
  Dataset dataset(
      H5Dcreate2(parent, name.c_str(), H5T_STD_I32LE, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
      "create dataset " + name);
  check(H5Dwrite(dataset.id(), H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
        "write dataset " + name);
  make_axis(dataset, name);
  return dataset;
}

Dataset create_number_axis(hid_t parent, const std::string& name, std::span<const double> values) {
  const hsize_t shape = values.size();
  Dataset dataset = create_numbers(parent, name, {&shape, 1}, {&shape, 1}, true);
  write_all(dataset, name, values);
  make_axis(dataset, name);
  return dataset;
}

std::vector<hsize_t> chunk_shape(std::span<const hsize_t> shape) {
  std::vector<hsize_t> chunk(shape.size(), 1);
  hsize_t room = kChunkDoubles;
  for (std::size_t i = shape.size(); i-- > 0;) {
    chunk[i] = std::clamp<hsize_t>(room, 1, std::max<hsize_t>(shape[i], 1));
    room /= chunk[i];
    if (chunk[i] < shape[i]) break;
  }
  return chunk;
}

Dataset create_dataset(hid_t parent, const std::string& name, std::span<const double> values,
                       std::span<const Dataset* const> axes) {
  const std::vector<hsize_t> shape = shape_of(name, values.size(), axes);
  Dataset dataset = define_dataset(parent, name, axes, chunk_shape(shape), true);
  write_all(dataset, name, values);
  return dataset;
}

Dataset create_integer_dataset(hid_t parent, const std::string& name, std::span<const std::int32_t> values,
                               std::span<const Dataset* const> axes) {
  const std::vector<hsize_t> shape = shape_of(name, values.size(), axes);
  const Properties properties = number_properties(name, chunk_shape(shape), true);
  const Space space = array_space(shape, name);
  Dataset dataset(
      H5Dcreate2(parent, name.c_str(), H5T_STD_I32LE, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
      "create dataset " + name);
  check(H5Dwrite(dataset.id(), H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        "write dataset " + name);
  attach_axes(dataset, axes, name);
  return dataset;
}

Dataset define_dataset(hid_t parent, const std::string& name, std::span<const Dataset* const> axes,
                       std::span<const hsize_t> chunk, bool compress) {
  Dataset dataset = create_numbers(parent, name, shape_along(axes), chunk, compress);
  attach_axes(dataset, axes, name);
  write_attribute(dataset.id(), "_FillValue", std::span(&kMissing, 1));  // netCDF knows it by this name
  return dataset;
}

Dataset create_text_dataset(hid_t parent, const std::string& name, std::span<const std::string> values,
                            const Dataset& axis) {
  Dataset dataset = write_texts(parent, name, values);
  const Dataset* const axes[] = {&axis};
  attach_axes(dataset, axes, name);
  return dataset;
}

}  // namespace lobe::hdf5
