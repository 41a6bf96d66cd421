#include "fuzz/fuzz_hdf5.hpp"

#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "hdf5/file_digest.hpp"
#include "io/synthetic_modes.hpp"
#include "io/synthetic_study.hpp"
#include "io/synthetic_table.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/modes_file.hpp"
#include "lobe/hdf5/file_summary.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/study/study_results.hpp"
#include "study/write/study_hdf5.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(std::string_view what, std::string_view detail) {
  std::fprintf(stderr, "lobe_fuzz: %.*s: %.*s\n", static_cast<int>(what.size()), what.data(),
               static_cast<int>(detail.size()), detail.data());
  std::abort();
}

/// Where a file is for as long as it is read.
const fs::path& place() {
  static const fs::path kPath = fs::temp_directory_path() / ("lobe-fuzz-" + std::to_string(::getpid()) + ".h5");
  return kPath;
}

class Placed {
 public:
  explicit Placed(std::string_view bytes) { std::ofstream(place(), std::ios::binary) << bytes; }
  ~Placed() {
    std::error_code ignored;
    fs::remove(place(), ignored);
  }
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;
};

/// Reads; what is refused is refused in one plain line that names the file.
template <typename Read>
void read_or_refuse(const Read& read) {
  try {
    read();
  } catch (const IoError& error) {
    const std::string_view complaint = error.what();
    if (complaint.find(place().filename().string()) == complaint.npos) fail("a complaint without the file", complaint);
    if (has_control_characters(complaint)) fail("a complaint is no plain line", complaint);
  }
}

void read_table() {
  read_or_refuse([] {
    (void)is_table_file(place());
    (void)load_table_header(place());
    (void)load_table_row(place(), 0, 0);
    if (states_deviations(place())) (void)load_table_deviations(place());
    const BrdfTable table = load_table(place());
    if (table.values.size() != table.channels * table.size()) fail("a table", "another number of values");
    if (std::ranges::any_of(table.error, [](double error) { return error < 0; })) fail("a table", "an error below 0");
  });
}

void read_summary() {
  read_or_refuse([] {
    if (!is_summarised_file(place())) return;
    const FileSummary summary = load_file_summary(place());
    for (const auto& [name, text] : summary.attributes) {
      if (text.empty()) fail("a summary", "an attribute without text");
    }
    for (const DatasetSummary& dataset : summary.datasets) {
      if (has_control_characters(dataset.description)) fail("a summary", "a description that is no plain line");
    }
  });
}

void read_results() {
  read_or_refuse([] {
    (void)is_study_results(place());
    (void)load_study_summary(place());
    const StudyResult results = load_study_results(place());
    const auto count = static_cast<Eigen::Index>(results.study.materials.size());
    for (const auto& metric : results.metrics) {
      const Metric& one = metric.combined;
      if (one.distance.rows() != count || one.distance.cols() != count) fail("results", "distances of other materials");
      if (!one.distance.allFinite()) fail("results", "a distance that is no number");
      if ((one.distance_error.array() < 0).any()) fail("results", "an error below 0");
    }
  });
}

/// An identifier of HDF5 that is given back.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: it is one

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// What there is in a file.
struct Content {
  std::vector<std::string> groups{"/"};
  std::vector<std::string> datasets;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< object, name
};

struct Visit {
  std::string path;
  Content* content;
};

herr_t note_attribute(hid_t, const char* name, const H5A_info_t*, void* data) {
  const auto& visit = *static_cast<Visit*>(data);
  visit.content->attributes.emplace_back(visit.path, name);
  return 0;
}

void visit_object(hid_t object, Visit& visit);

herr_t note_link(hid_t group, const char* name, const H5L_info_t*, void* data) {
  const auto& visit = *static_cast<Visit*>(data);
  Visit inner{(visit.path == "/" ? "/" : visit.path + "/") + name, visit.content};
  const Id object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
  if (object < 0) return 0;
  (H5Iget_type(object) == H5I_GROUP ? inner.content->groups : inner.content->datasets).push_back(inner.path);
  visit_object(object, inner);
  return 0;
}

void visit_object(hid_t object, Visit& visit) {
  hsize_t from = 0;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &from, note_attribute, &visit);
  if (H5Iget_type(object) == H5I_GROUP) H5Literate(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_link, &visit);
}

/// A file in memory.
class Image {
 public:
  explicit Image(std::string bytes) : bytes_(std::move(bytes)), access_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose) {
    H5Pset_fapl_core(access_, std::size_t{1} << 16, 0);
    H5Pset_file_image(access_, bytes_.data(), bytes_.size());
    file_ = H5Fopen("image", H5F_ACC_RDWR, access_);
    if (file_ < 0) fail("hdf5", "cannot open the file that was written");
  }
  ~Image() { H5Fclose(file_); }
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;

  [[nodiscard]] hid_t file() const { return file_; }
  [[nodiscard]] Content content() const {
    Content content;
    Visit visit{"/", &content};
    const Id root(H5Gopen2(file_, "/", H5P_DEFAULT), H5Gclose);
    visit_object(root, visit);
    return content;
  }
  [[nodiscard]] std::string bytes() const {
    H5Fflush(file_, H5F_SCOPE_GLOBAL);
    const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
    std::string all(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
    H5Fget_file_image(file_, all.data(), all.size());
    return all;
  }

 private:
  std::string bytes_;
  Id access_;
  hid_t file_ = -1;
};

/// Bytes that say what is changed; zeros when they are over.
class Changes {
 public:
  explicit Changes(std::span<const std::uint8_t> data) : rest_(data) {}

  [[nodiscard]] bool has_more() const { return !rest_.empty(); }
  std::size_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t first = rest_.front();
    rest_ = rest_.subspan(1);
    return first;
  }
  double number() {
    static constexpr std::array kNumbers{0.0,
                                         1.0,
                                         -1.0,
                                         2.0,
                                         0.5,
                                         1e-300,
                                         1e300,
                                         4294967296.0,
                                         -1e9,
                                         3.0,
                                         8.0,
                                         std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity(),
                                         -std::numeric_limits<double>::infinity()};
    const std::size_t which = byte();
    return which < 200 ? kNumbers[which % kNumbers.size()] : static_cast<double>(byte());
  }
  std::string text() {
    std::string text;
    for (std::size_t count = byte() % 40; count > 0 && has_more(); --count) text += static_cast<char>(byte());
    return text;
  }
  template <typename Item>
  const Item& one_of(const std::vector<Item>& items) {
    return items[byte() % items.size()];
  }

 private:
  std::span<const std::uint8_t> rest_;
};

void put_attribute(hid_t file, const std::pair<std::string, std::string>& where, hid_t type, hid_t space,
                   const void* value) {
  const auto& [object, name] = where;
  H5Adelete_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT);
  const Id attribute(
      H5Acreate_by_name(file, object.c_str(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (attribute >= 0) H5Awrite(attribute, type, value);
}

void put_text(hid_t file, const std::pair<std::string, std::string>& where, const std::string& text) {
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(text.size(), 1));
  H5Tset_cset(type, H5T_CSET_UTF8);
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  put_attribute(file, where, type, space, padded.data());
}

void put_texts(hid_t file, const std::pair<std::string, std::string>& where, const std::vector<std::string>& texts) {
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  const hsize_t count = texts.size();
  const Id space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  std::vector<const char*> pointers;
  for (const auto& text : texts) pointers.push_back(text.c_str());
  put_attribute(file, where, type, space, pointers.data());
}

void put_numbers(hid_t file, const std::pair<std::string, std::string>& where, const std::vector<double>& numbers) {
  const hsize_t count = numbers.size();
  const Id space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  put_attribute(file, where, H5T_NATIVE_DOUBLE, space, numbers.data());
}

/// Another dataset of the name, of any small shape.
void put_dataset(hid_t file, const std::string& path, Changes& changes) {
  H5Ldelete(file, path.c_str(), H5P_DEFAULT);
  static constexpr std::array<hsize_t, 8> kSizes{0, 1, 2, 3, 4, 5, 8, 16};
  std::vector<hsize_t> shape(changes.byte() % 5);
  hsize_t count = 1;
  for (hsize_t& size : shape) count *= size = kSizes[changes.byte() % kSizes.size()];
  const Id space(
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
      H5Sclose);
  static const std::array<hid_t, 4> kTypes{H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_I32LE, H5T_STD_U64LE};
  const Id dataset(H5Dcreate2(file, path.c_str(), kTypes[changes.byte() % kTypes.size()], space, H5P_DEFAULT,
                              H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose);
  const std::vector<double> values(count, changes.number());
  if (dataset >= 0) H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

/// A number of a dataset changes.
void change_value(hid_t file, const std::string& path, Changes& changes) {
  const Id dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (dataset < 0) return;
  const Id space(H5Dget_space(dataset), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const Id type(H5Dget_type(dataset), H5Tclose);
  if (count < 1 || count > 100'000 || H5Tget_class(type) == H5T_STRING) return;
  std::vector<double> values(static_cast<std::size_t>(count));
  if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return;
  values[(changes.byte() * 256 + changes.byte()) % values.size()] = changes.number();
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void change(hid_t file, const Content& content, Changes& changes) {
  switch (changes.byte() % 10) {
    case 0:
      H5Adelete_by_name(file, changes.one_of(content.attributes).first.c_str(),
                        changes.one_of(content.attributes).second.c_str(), H5P_DEFAULT);
      return;
    case 1:
      put_text(file, changes.one_of(content.attributes), changes.text());
      return;
    case 2: {
      // Something from elsewhere in the file.
      const auto& from = changes.one_of(content.attributes);
      const Id attribute(H5Aopen_by_name(file, from.first.c_str(), from.second.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
      if (attribute < 0) return;
      const Id type(H5Aget_type(attribute), H5Tclose);
      const Id space(H5Aget_space(attribute), H5Sclose);
      if (H5Tis_variable_str(type) > 0 || H5Tget_class(type) == H5T_VLEN || H5Tget_class(type) == H5T_REFERENCE) return;
      std::vector<char> value(H5Tget_size(type) * static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) + 1);
      H5Aread(attribute, type, value.data());
      put_attribute(file, changes.one_of(content.attributes), type, space, value.data());
      return;
    }
    case 3:
      put_numbers(file, changes.one_of(content.attributes), {changes.number()});
      return;
    case 4: {
      const auto& where = changes.one_of(content.attributes);
      put_numbers(file, where, std::vector<double>(changes.byte() % 20, changes.number()));
      return;
    }
    case 5: {
      const auto& where = changes.one_of(content.attributes);
      std::vector<std::string> texts(changes.byte() % 5);
      for (auto& text : texts) text = changes.text();
      put_texts(file, where, texts);
      return;
    }
    case 6:
      H5Ldelete(file, changes.one_of(content.datasets).c_str(), H5P_DEFAULT);
      return;
    case 7:
      put_dataset(file, changes.one_of(content.datasets), changes);
      return;
    case 8:
      change_value(file, changes.one_of(content.datasets), changes);
      return;
    default: {
      const std::string& group = changes.one_of(content.groups);
      if (changes.byte() % 2 == 0) {
        if (group != "/") H5Ldelete(file, group.c_str(), H5P_DEFAULT);
      } else {
        const std::string name = group + "/" + changes.text();
        const Id made(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
      }
    }
  }
}

/// A file of ours with changes, half of them under a checksum.
std::string changed(const std::string& sound, std::span<const std::uint8_t> data) {
  static const bool kIsQuiet = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  if (!kIsQuiet) fail("hdf5", "does not keep quiet");
  Changes changes(data);
  const bool is_sealed = changes.byte() % 2 == 1;
  const Image image(sound);
  static std::map<std::string, Content> known;
  const Content& content = known.try_emplace(sound.substr(sound.size() / 2), image.content()).first->second;
  for (int k = 0; k < 8 && changes.has_more(); ++k) change(image.file(), content, changes);
  std::string bytes = image.bytes();
  if (is_sealed) bytes += digest_of(bytes);
  return bytes;
}

}  // namespace

std::string sound_table_file() {
  static const std::string kBytes = [] {
    fs::remove(place());
    save(synthetic_composition(HemisphereGrid::gauss(4, 8), TableForm::isotropic, 2), place());
    std::ostringstream text;
    text << std::ifstream(place(), std::ios::binary).rdbuf();
    fs::remove(place());
    return std::move(text).str();
  }();
  return kBytes;
}

void fuzz_table(std::span<const std::uint8_t> data) {
  const Placed file(changed(sound_table_file(), data));
  read_table();
}

void fuzz_results(std::span<const std::uint8_t> data) {
  static const std::string kSound = study_table(synthetic_study(), "lobe run s.toml", "2001-01-01T00:00:00Z");
  const Placed file(changed(kSound, data));
  read_results();
}

void fuzz_modes(std::span<const std::uint8_t> data) {
  static const std::string kSound = modes_file(synthetic_modes(), ModesFormat::hdf5, "lobe modes paint.toml");
  const Placed file(changed(kSound, data));
  read_summary();
}

void fuzz_table_bytes(std::span<const std::uint8_t> data, bool is_sealed) {
  std::string bytes(data.begin(), data.end());
  if (is_sealed) bytes += digest_of(bytes);
  const Placed file(bytes);
  read_table();
}

}  // namespace lobe::test
