#include "lobe/hdf5/file_summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/text.hpp"
#include "hdf5/file_digest.hpp"
#include "hdf5/hdf5_input.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::array kSummarised{"lobe-modes/1", "lobe-lut/1"};
constexpr std::array kTexts{"material", "convention", "quantity", "split", "comment", "history", "source"};
constexpr std::array kNumbers{"tolerance", "error_of_entries", "error_of_interpolation", "error_up_to_the_ends"};
constexpr const char* kSchemaName = "lobe_schema";

bool is_summarised(const hdf5::InputFile& file) {
  return file.has_attribute("/", kSchemaName) &&
         std::ranges::find(kSummarised, file.text("/", kSchemaName)) != kSummarised.end();
}

DatasetSummary summary_of(const hdf5::InputFile& file, const std::string& path) {
  const auto text = [&](const char* attribute) {
    return file.has_attribute(path, attribute) ? file.line(path, attribute) : std::string();
  };
  DatasetSummary summary{.name = path.substr(1), .description = text("long_name"), .unit = text("units")};
  const std::vector<hsize_t> shape = file.shape(path);
  summary.shape.assign(shape.begin(), shape.end());
  const std::vector<double> numbers = file.read(path, shape);
  if (numbers.empty()) return summary;
  const auto [least, largest] = std::ranges::minmax_element(numbers);
  summary.least = *least;
  summary.largest = *largest;
  return summary;
}

}  // namespace

bool is_summarised_file(const std::filesystem::path& path) {
  require_sound(path);
  try {
    return is_summarised(hdf5::InputFile(path));
  } catch (const IoError&) {
    return false;
  }
}

FileSummary load_file_summary(const std::filesystem::path& path) {
  require_sound(path);
  const hdf5::InputFile file(path);
  if (!is_summarised(file)) file.refuse("it has no azimuthal modes and no lookup table; expected a file of either");
  FileSummary summary{.schema = file.text("/", kSchemaName)};
  for (const char* name : kTexts) {
    if (!file.has_attribute("/", name)) continue;
    std::string text = file.text("/", name);
    if (!text.empty()) summary.attributes.emplace_back(name, std::move(text));
  }
  for (const char* name : kNumbers) {
    if (file.has_attribute("/", name)) summary.attributes.emplace_back(name, shortest(file.number("/", name)));
  }
  if (file.has("/channel")) summary.channels = file.texts("/channel");
  for (const std::string& dataset : file.numeric_datasets()) summary.datasets.push_back(summary_of(file, dataset));
  return summary;
}

}  // namespace lobe
