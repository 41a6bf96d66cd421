#include "hdf5/hdf5_input.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <numeric>
#include <system_error>

#include "core/text.hpp"
#include "hdf5/file_digest.hpp"
#include "lobe/core/error.hpp"

namespace lobe::hdf5 {
namespace {

constexpr const char* kReading = "read an HDF5 file";

std::string shape_text(std::span<const hsize_t> shape) {
  std::string text;
  for (const auto length : shape) text += (text.empty() ? "" : " x ") + std::to_string(length);
  return text;
}

File open_file(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& why, Fault fault) {
    throw IoError("cannot read " + path.string() + ": " + why, {.fault = fault, .path = path.string()});
  };
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (code && code != std::errc::no_such_file_or_directory) {
    refuse(code.message(), fault_of(code));
  }
  if (!std::filesystem::exists(status)) refuse("No such file or directory", Fault::missing_file);
  if (std::filesystem::is_directory(status)) refuse("is a directory", Fault::directory);
  // HDF5 would take content from pipes that others are to read.
  if (!std::filesystem::is_regular_file(status)) refuse("is no regular file", Fault::unspecified);
  // HDF5 would tell of it with the names of its own calls. By the effective user, who is to read.
  if (::faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) != 0) {
    code = std::error_code(errno, std::generic_category());
    refuse(code.message(), fault_of(code));
  }
  require_sound(path);
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) {
    throw IoError("cannot read " + path.string() + " as an HDF5 file: " + failure_cause(),
                  {.fault = Fault::hdf5_content, .path = path.string()});
  }
  return {id, kReading};
}

bool is_number(const Type& type) {
  const H5T_class_t kind = H5Tget_class(type.id());
  return kind == H5T_FLOAT || kind == H5T_INTEGER;
}

std::vector<hsize_t> shape_of(const Dataset& dataset) {
  const Space space(H5Dget_space(dataset.id()), kReading);
  std::vector<hsize_t> shape(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.id()), kReading)));
  check(H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr), kReading);
  return shape;
}

bool is_scalar(const Attribute& attribute) {
  const Space space(H5Aget_space(attribute.id()), kReading);
  return H5Sget_simple_extent_npoints(space.id()) == 1;
}

/// Variable-length texts, which HDF5 allocates, and those of a fixed length, which other programs write.
std::vector<std::string> read_texts(const Attribute& attribute, const Type& type) {
  const Space space(H5Aget_space(attribute.id()), kReading);
  const auto count = static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space.id()), kReading));
  std::vector<std::string> texts;
  if (check(H5Tis_variable_str(type.id()), kReading) > 0) {
    std::vector<char*> pointers(count, nullptr);
    check(H5Aread(attribute.id(), type.id(), pointers.data()), kReading);
    for (char* pointer : pointers) {
      texts.emplace_back(pointer == nullptr ? "" : pointer);
      H5free_memory(pointer);
    }
    return texts;
  }
  const std::size_t length = H5Tget_size(type.id());
  const bool is_padded = H5Tget_strpad(type.id()) == H5T_STR_SPACEPAD;
  std::string all(count * length, '\0');
  check(H5Aread(attribute.id(), type.id(), all.data()), kReading);
  for (std::size_t i = 0; i < count; ++i) {
    std::string text = all.substr(i * length, length);
    text.resize(std::min(text.find('\0'), text.size()));
    if (is_padded) text.erase(text.find_last_not_of(' ') + 1);
    texts.push_back(std::move(text));
  }
  return texts;
}

/// Wherever a path leads, no other file is opened.
herr_t refuse_external_link(const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) {
  return -1;
}

Properties without_external_links(hid_t kind) {
  Properties properties(H5Pcreate(kind), kReading);
  check(H5Pset_elink_cb(properties.id(), refuse_external_link, nullptr), kReading);
  return properties;
}

bool leads_elsewhere(H5L_type_t link) {
  return link != H5L_TYPE_HARD && link != H5L_TYPE_SOFT;
}

/// Product of numbers of the file, as large as they claim to be.
double size_of(std::span<const hsize_t> shape, std::size_t bytes) {
  return std::accumulate(shape.begin(), shape.end(), static_cast<double>(bytes),
                         [](double product, hsize_t length) { return product * static_cast<double>(length); });
}

}  // namespace

std::size_t volume(std::span<const hsize_t> shape) {
  return static_cast<std::size_t>(std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>()));
}

InputFile::InputFile(const std::filesystem::path& path)
    : name_(path.string()),
      file_(open_file(path)),
      links_(without_external_links(H5P_LINK_ACCESS)),
      groups_(without_external_links(H5P_GROUP_ACCESS)),
      datasets_(without_external_links(H5P_DATASET_ACCESS)) {}

bool InputFile::has(const std::string& object) const {
  // HDF5 takes a missing group on the way for a failure.
  for (std::size_t slash = object.find('/', 1);; slash = object.find('/', slash + 1)) {
    const std::string path = object.substr(0, slash);
    if (path == "/") return true;
    if (H5Lexists(file_.id(), path.c_str(), links_.id()) <= 0) return false;
    H5L_info_t link{};
    if (H5Lget_info(file_.id(), path.c_str(), &link, links_.id()) >= 0 && leads_elsewhere(link.type)) {
      refuse(path + " is a link to another file; expected all in one file");
    }
    if (slash == std::string::npos) return true;
  }
}

bool InputFile::has_attribute(const std::string& object, const char* name) const {
  return H5Aexists_by_name(file_.id(), object.c_str(), name, links_.id()) > 0;
}

std::string InputFile::text(const std::string& object, const char* attribute) const {
  const Attribute opened = open_attribute(object, attribute);
  const Type type(H5Aget_type(opened.id()), kReading);
  if (H5Tget_class(type.id()) != H5T_STRING || !is_scalar(opened)) {
    refuse("attribute " + std::string(attribute) + " of " + object + " is no text");
  }
  require_stored(opened, type, "attribute " + std::string(attribute) + " of " + object);
  std::string text;
  try {
    text = read_texts(opened, type).front();
  } catch (const IoError&) {
    refuse_damaged("attribute " + std::string(attribute) + " of " + object);
  }
  require_plain(text, "attribute " + std::string(attribute) + " of " + object);
  return text;
}

std::string InputFile::line(const std::string& object, const char* attribute) const {
  std::string text = this->text(object, attribute);
  if (has_control_characters(text)) {
    refuse("attribute " + std::string(attribute) + " of " + object + " has several lines or tabs; expected one line");
  }
  return text;
}

void InputFile::require_plain(std::string text, const std::string& what) const {
  std::erase_if(text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; });
  if (has_control_characters(text)) refuse(what + " has control characters; expected a text");
}

std::vector<std::string> InputFile::text_list(const std::string& object, const char* attribute) const {
  const Attribute opened = open_attribute(object, attribute);
  const Type type(H5Aget_type(opened.id()), kReading);
  if (H5Tget_class(type.id()) != H5T_STRING)
    refuse("attribute " + std::string(attribute) + " of " + object + " is no text");
  require_stored(opened, type, "attribute " + std::string(attribute) + " of " + object);
  std::vector<std::string> texts;
  try {
    texts = read_texts(opened, type);
  } catch (const IoError&) {
    refuse_damaged("attribute " + std::string(attribute) + " of " + object);
  }
  for (const auto& text : texts) require_plain(text, "attribute " + std::string(attribute) + " of " + object);
  if (texts.size() != 1) return texts;
  const std::string lines = std::move(texts.front());
  texts.clear();
  for (const auto line : split(lines, '\n')) texts.emplace_back(line);
  return texts;
}

double InputFile::number(const std::string& object, const char* attribute) const {
  const Attribute opened = open_attribute(object, attribute);
  if (!is_number({H5Aget_type(opened.id()), kReading}) || !is_scalar(opened)) {
    refuse("attribute " + std::string(attribute) + " of " + object + " is no number");
  }
  double value = 0;
  if (H5Aread(opened.id(), H5T_NATIVE_DOUBLE, &value) < 0) {
    refuse_damaged("attribute " + std::string(attribute) + " of " + object);
  }
  return value;
}

std::vector<std::string> InputFile::groups(const std::string& parent) const {
  return members(parent, H5I_GROUP);
}

std::vector<std::string> InputFile::numeric_datasets() const {
  constexpr std::ptrdiff_t kDeepest = 32;  // groups within groups: links may lead in a circle
  std::vector<std::string> found;
  std::vector<std::string> left{"/"};
  while (!left.empty()) {
    const std::string group = left.back();
    left.pop_back();
    if (std::ranges::count(group, '/') > kDeepest) refuse("group " + group + " is nested more than 32 times");
    const std::string base = group == "/" ? group : group + "/";
    for (const auto& name : members(group, H5I_DATASET)) {
      if (is_number({H5Dget_type(open_dataset(base + name).id()), kReading})) found.push_back(base + name);
    }
    for (const auto& name : members(group, H5I_GROUP)) left.push_back(base + name);
  }
  return found;
}

std::uint64_t InputFile::read_through(const std::string& dataset) const {
  constexpr std::size_t kNumbers = std::size_t{1} << 20;  // at a time, at least a line
  const auto whole = shape(dataset);
  if (std::ranges::find(whole, hsize_t{0}) != whole.end()) return 0;
  if (whole.empty()) {
    double value = 0;
    if (H5Dread(open_numbers(dataset).id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) < 0) {
      refuse_damaged("dataset " + dataset);
    }
    return sizeof(double);
  }
  const std::size_t line = volume(std::span(whole).subspan(1));
  const hsize_t lines = std::max<hsize_t>(1, kNumbers / std::max<std::size_t>(line, 1));
  std::vector<hsize_t> offset(whole.size(), 0);
  for (; offset.front() < whole.front(); offset.front() += lines) {
    auto count = whole;
    count.front() = std::min(lines, whole.front() - offset.front());
    static_cast<void>(read_box(dataset, offset, count));
  }
  return sizeof(double) * whole.front() * line;
}

std::vector<std::string> InputFile::members(const std::string& parent, H5I_type_t type) const {
  const hid_t id = H5Gopen2(file_.id(), parent.c_str(), groups_.id());
  if (id < 0) refuse_damaged("group " + parent);
  const Group group(id, kReading);
  struct Found {
    std::vector<std::string> names;
    std::string elsewhere;
    hid_t links;
    H5I_type_t type;
  } found{{}, {}, links_.id(), type};
  const auto add = [](hid_t of, const char* name, const H5L_info_t* link, void* data) -> herr_t {
    auto& all = *static_cast<Found*>(data);
    if (leads_elsewhere(link->type)) {
      all.elsewhere = name;
      return -1;
    }
    // H5Oget_info() would tell without opening it, but means other things from one version of HDF5 to the next.
    const hid_t object = H5Oopen(of, name, all.links);
    if (object < 0) return -1;
    if (H5Iget_type(object) == all.type) all.names.emplace_back(name);
    return H5Oclose(object);
  };
  // Files of other programs need not know the order in which they were made.
  if (H5Literate(group.id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, add, &found) < 0) {
    found.names.clear();
    if (H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &found) < 0) {
      if (found.elsewhere.empty()) refuse_damaged("group " + parent);
      refuse("'" + found.elsewhere + "' in group " + parent + " is a link to another file; expected all in one file");
    }
  }
  const auto& names = found.names;
  for (const auto& name : names) {
    if (has_control_characters(name)) refuse("group " + parent + " has one with control characters in its name");
  }
  return names;
}

std::vector<hsize_t> InputFile::shape(const std::string& dataset) const {
  return shape_of(open_numbers(dataset));
}

bool InputFile::is_narrow(const std::string& dataset) const {
  const Dataset opened = open_numbers(dataset);
  const Type type(H5Dget_type(opened.id()), kReading);
  return H5Tget_size(type.id()) < sizeof(double);
}

std::vector<std::string> InputFile::texts(const std::string& dataset) const {
  const Dataset opened = open_dataset(dataset);
  const hid_t id = opened.id();
  const Type type(H5Dget_type(id), kReading);
  const std::vector<hsize_t> shape = shape_of(opened);
  if (H5Tis_variable_str(type.id()) <= 0 || shape.size() != 1) refuse("dataset " + dataset + " is no list of texts");
  std::vector<char*> pointers(static_cast<std::size_t>(shape.front()), nullptr);
  if (pointers.empty()) return {};
  if (H5Dread(id, type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0) refuse_damaged("dataset " + dataset);
  std::vector<std::string> texts;
  for (const char* pointer : pointers) texts.emplace_back(pointer == nullptr ? "" : pointer);
  const Space space(H5Dget_space(id), kReading);
  H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, pointers.data());
  for (const auto& text : texts) require_plain(text, "dataset " + dataset);
  return texts;
}

void InputFile::require_shape(const std::string& dataset, std::span<const hsize_t> shape) const {
  const std::vector<hsize_t> seen = this->shape(dataset);
  if (!std::ranges::equal(seen, shape)) {
    refuse("dataset " + dataset + " has the shape " + shape_text(seen) + "; expected " + shape_text(shape));
  }
}

void InputFile::read(const std::string& dataset, std::span<const hsize_t> shape, std::span<double> values) const {
  require_shape(dataset, shape);
  const Dataset opened = open_numbers(dataset);
  if (H5Dread(opened.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    refuse_damaged("dataset " + dataset);
  }
}

std::vector<double> InputFile::read(const std::string& dataset, std::span<const hsize_t> shape) const {
  require_shape(dataset, shape);
  std::vector<double> values(volume(shape));
  read(dataset, shape, values);
  return values;
}

std::vector<double> InputFile::read_box(const std::string& dataset, std::span<const hsize_t> offset,
                                        std::span<const hsize_t> count) const {
  const Dataset opened = open_numbers(dataset);
  const Space in_file(H5Dget_space(opened.id()), kReading);
  check(H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, offset.data(), nullptr, count.data(), nullptr), kReading);
  const Space in_memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), kReading);
  std::vector<double> values(volume(count));
  if (H5Dread(opened.id(), H5T_NATIVE_DOUBLE, in_memory.id(), in_file.id(), H5P_DEFAULT, values.data()) < 0) {
    refuse_damaged("dataset " + dataset);
  }
  return values;
}

Dataset InputFile::open_dataset(const std::string& dataset) const {
  if (!has(dataset)) refuse("dataset " + dataset + " is missing");
  const hid_t id = H5Dopen2(file_.id(), dataset.c_str(), datasets_.id());
  if (id < 0) refuse_damaged("dataset " + dataset);
  Dataset opened(id, kReading);
  require_stored(opened, dataset);
  return opened;
}

Dataset InputFile::open_numbers(const std::string& dataset) const {
  Dataset opened = open_dataset(dataset);
  if (!is_number({H5Dget_type(opened.id()), kReading})) refuse("dataset " + dataset + " holds no numbers");
  return opened;
}

hsize_t InputFile::file_size() const {
  hsize_t size = 0;
  check(H5Fget_filesize(file_.id(), &size), kReading);
  return size;
}

void InputFile::require_stored(const Dataset& opened, const std::string& dataset) const {
  // Deflate makes 1032 bytes of one at most.
  constexpr double kMostUnpacked = 1100;
  constexpr double kSmall = 4096;
  const Properties creation(H5Dget_create_plist(opened.id()), kReading);
  if (H5Pget_external_count(creation.id()) != 0 || H5Pget_layout(creation.id()) == H5D_VIRTUAL) {
    refuse("dataset " + dataset + " has its values in other files; expected them in this one");
  }
  const Type type(H5Dget_type(opened.id()), kReading);
  const double stored = static_cast<double>(std::min(H5Dget_storage_size(opened.id()), file_size()));
  const std::vector<hsize_t> shape = shape_of(opened);
  if (size_of(shape, H5Tget_size(type.id())) > kMostUnpacked * stored + kSmall) {
    refuse("dataset " + dataset + " claims to have " + shape_text(shape) + " values, which are not in the file");
  }
}

void InputFile::require_stored(const Attribute& opened, const Type& type, const std::string& what) const {
  const Space space(H5Aget_space(opened.id()), kReading);
  const auto count = static_cast<hsize_t>(check(H5Sget_simple_extent_npoints(space.id()), kReading));
  if (size_of({&count, 1}, H5Tget_size(type.id())) > static_cast<double>(file_size())) {
    refuse(what + " claims to be larger than the file");
  }
}

Attribute InputFile::open_attribute(const std::string& object, const char* name) const {
  if (!has_attribute(object, name)) refuse("attribute " + std::string(name) + " of " + object + " is missing");
  const hid_t id = H5Aopen_by_name(file_.id(), object.c_str(), name, H5P_DEFAULT, links_.id());
  if (id < 0) refuse_damaged("attribute " + std::string(name) + " of " + object);
  return {id, kReading};
}

void InputFile::refuse(const std::string& complaint) const {
  throw IoError(printable("cannot read " + name_ + ": " + complaint), {.fault = Fault::content, .path = name_});
}

void InputFile::refuse_damaged(const std::string& object) const {
  refuse(object + ": " + failure_cause());
}

}  // namespace lobe::hdf5
