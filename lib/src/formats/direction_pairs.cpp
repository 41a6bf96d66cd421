#include "lobe/formats/direction_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <exception>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "core/file_writer.hpp"
#include "core/files.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "formats/npy.hpp"
#include "formats/pair_list.hpp"
#include "hdf5/hdf5_output.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "model/delta.hpp"
#include "model/values.hpp"
#include "reflectance/prepared.hpp"
#include "table/as_function.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kAtOnce = 64;    // blocks that are evaluated before they are written
constexpr std::size_t kTelling = 100;  // pairs whose angles say something of their unit

bool is_numbered(const std::vector<std::string>& channels) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c] != std::to_string(c + 1)) return false;
  }
  return true;
}

BrdfFunction function_of_pairs(const Device& device, const Reflectance& reflectance, Precision precision) {
  const Material* formula = reflectance.formula();
  return formula != nullptr ? kept_function(device, smooth_part(*formula), precision, NodeMaking::quickly)
                            : smooth_function(device, reflectance, precision);
}

/// Values at pairs of directions, and what stands beside them.
struct PairSource {
  BrdfFunction brdf;
  bool has_errors = false;
  std::optional<BrdfFunction> replicated = std::nullopt;

  /// Number of quantities of a channel.
  [[nodiscard]] std::size_t quantities() const { return 1 + (has_errors ? 1U : 0U) + (replicated ? 1U : 0U); }
};

PairSource pair_source_of(const Device& device, const Reflectance& reflectance, const PairOptions& options) {
  PairSource source{function_of_pairs(device, adjusted(device, reflectance), options.precision)};
  const Directions normal{};
  source.has_errors = source.brdf.at({&normal, 1}).error.size() > 0;
  source.replicated = options.replicated;
  if (!source.replicated) return source;
  const std::size_t own = own_channels(*source.replicated);
  if (source.replicated->replicates == 0 || own != source.brdf.channels.size()) {
    throw ArgumentError(fmt::format("'{}' has {} replicates of {} channels; expected some of {}",
                                    source.replicated->name, source.replicated->replicates, own,
                                    source.brdf.channels.size()));
  }
  return source;
}

/// Columns of the values, then of the errors and of the standard deviations.
std::vector<std::string> value_columns(const PairSource& source) {
  const auto& channels = source.brdf.channels;
  std::vector<std::string> names;
  const bool is_plain = channels.size() == 1 && (channels.front() == "value" || is_numbered(channels));
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const bool has_name = !is_plain && !is_numbered(channels);
    names.push_back(is_plain ? "brdf" : has_name ? channels[c] : fmt::format("brdf_{}", c + 1));
  }
  const auto append_all = [&](const char* suffix) {
    for (std::size_t c = 0; c < channels.size(); ++c) names.push_back(names[c] + suffix);
  };
  if (source.has_errors) append_all("_error");
  if (source.replicated) append_all("_std");
  return names;
}

/// A block with its values: rows x columns, as value_columns() names them.
struct Answer {
  PairBlock pairs;
  std::vector<double> values;
};

std::vector<double> values_of(const PairSource& source, const PairBlock& block) {
  const BrdfValues found = source.brdf.at(block.directions);
  std::vector<std::vector<double>> deviations;
  if (source.replicated) {
    deviations = measurement_deviations(*source.replicated, source.replicated->at(block.directions).value);
  }
  const auto rows = static_cast<Eigen::Index>(block.directions.size());
  const Eigen::Index channels = found.value.cols();
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(rows * channels) * source.quantities());
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index c = 0; c < channels; ++c) values.push_back(found.value(i, c));
    for (Eigen::Index c = 0; source.has_errors && c < channels; ++c) values.push_back(found.error(i, c));
    for (const auto& channel : deviations) values.push_back(channel[static_cast<std::size_t>(i)]);
  }
  return values;
}

/// Appends the shortest text that reads back as the same number.
void append(std::string& text, double value) {
  constexpr std::size_t kLongest = 32;
  const std::size_t size = text.size();
  text.resize(size + kLongest);
  const auto end = std::to_chars(text.data() + size, text.data() + text.size(), value).ptr;
  text.resize(static_cast<std::size_t>(end - text.data()));
}

void append_row(std::string& text, std::span<const double> pair, std::span<const double> values) {
  for (const double number : pair) {
    append(text, number);
    text += ',';
  }
  for (const double value : values) {
    append(text, value);
    text += ',';
  }
  text.back() = '\n';
}

std::string csv_text(const Answer& answer, std::size_t directions, std::size_t columns) {
  std::string text;
  const std::span<const double> numbers = answer.pairs.numbers;
  const std::span<const double> values = answer.values;
  for (std::size_t row = 0; row < answer.pairs.directions.size(); ++row) {
    append_row(text, numbers.subspan(row * directions, directions), values.subspan(row * columns, columns));
  }
  return text;
}

/// Processing of the answers: `prepare` runs for several at once, `write` for one after the other.
struct Sink {
  std::function<void(const PairList& list, const PairSummary& summary)> begin;
  std::function<std::string(Answer& answer)> prepare;
  std::function<void(std::size_t first, const Answer& answer, const std::string& text)> write;
};

std::string csv_heading(const PairSummary& summary) {
  std::string text;
  for (const auto* names : {&summary.directions, &summary.values}) {
    for (const auto& name : *names) text += csv_field(name) + ",";
  }
  text.back() = '\n';
  return text;
}

/// Answers blocks on all cores, in the order of the list; of several that fail the first one counts.
PairSummary answer_all(const PairSource& source, const fs::path& pairs, const PairOptions& options, const Sink& sink) {
  const PairList list(pairs, options.radians);
  PairSummary summary{list.size(), list.columns(), {}};
  summary.values = value_columns(source);
  sink.begin(list, summary);
  double largest_angle = 0;
  std::vector<Answer> answers;
  std::vector<std::string> texts;
  std::vector<std::exception_ptr> failures;
  for (std::size_t begin = 0; begin < list.blocks(); begin += kAtOnce) {
    const double done = static_cast<double>(begin) / static_cast<double>(list.blocks());
    if (options.progress && !options.progress("pairs", done)) throw Cancelled("cancelled");
    const std::size_t count = std::min(kAtOnce, list.blocks() - begin);
    answers.resize(count);  // pairs are read into the memory that is there
    texts.assign(count, {});
    failures.assign(count, nullptr);
    parallel_for(count, [&](std::size_t i) {
      try {
        list.read(begin + i, answers[i].pairs);
        answers[i].values = values_of(source, answers[i].pairs);
        texts[i] = sink.prepare(answers[i]);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (failures[i]) std::rethrow_exception(failures[i]);
      largest_angle = std::max(largest_angle, answers[i].pairs.largest_angle);
      sink.write(list.first(begin + i), answers[i], texts[i]);
    }
  }
  summary.may_be_radians =
      list.lacks_unit() && list.size() >= kTelling && largest_angle > 0 && largest_angle <= 2 * std::numbers::pi;
  return summary;
}

std::string_view bytes_of(std::span<const double> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

PairSummary write_csv(const PairSource& source, const fs::path& pairs, const PairOptions& options,
                      const std::function<void(std::string_view)>& write) {
  std::size_t directions = 0;
  std::size_t columns = 0;
  return answer_all(
      source, pairs, options,
      {.begin =
           [&](const PairList& /*list*/, const PairSummary& summary) {
             directions = summary.directions.size();
             columns = summary.values.size();
             write(csv_heading(summary));
           },
       .prepare = [&](Answer& answer) { return csv_text(answer, directions, columns); },
       .write = [&](std::size_t /*first*/, const Answer& /*answer*/, const std::string& text) { write(text); }});
}

PairSummary write_npy(const PairSource& source, const fs::path& pairs, const PairOptions& options, FileWriter& file) {
  return answer_all(source, pairs, options,
                    {.begin =
                         [&](const PairList& list, const PairSummary& summary) {
                           const std::array shape{list.size(), summary.values.size()};
                           file.write(npy_header(shape));
                         },
                     .prepare = [](Answer& /*answer*/) { return std::string(); },
                     .write = [&](std::size_t /*first*/, const Answer& answer,
                                  const std::string& /*text*/) { file.write(bytes_of(answer.values)); }});
}

/// Rows of a dataset of pairs x columns.
void write_rows(const hdf5::Dataset& dataset, std::size_t first, std::size_t columns, std::span<const double> numbers) {
  const std::array<hsize_t, 2> offset{first, 0};
  const std::array<hsize_t, 2> count{numbers.size() / columns, columns};
  const hdf5::Space memory(H5Screate_simple(2, count.data(), nullptr), "write pairs");
  const hdf5::Space place(H5Dget_space(dataset.id()), "write pairs");
  hdf5::check(H5Sselect_hyperslab(place.id(), H5S_SELECT_SET, offset.data(), nullptr, count.data(), nullptr),
              "write pairs");
  hdf5::check(H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, memory.id(), place.id(), H5P_DEFAULT, numbers.data()),
              "write pairs");
}

/// The datasets of the answers.
class PairDatasets {
 public:
  PairDatasets(hid_t root, const PairSource& source, const PairSummary& summary)
      : channels_(source.brdf.channels.size()),
        pairs_(summary.pairs),
        pair_(hdf5::create_index_axis(root, "pair", summary.pairs)),
        column_(hdf5::create_text_axis(root, "direction", summary.directions)),
        channel_(hdf5::create_text_axis(root, "channel", source.brdf.channels)),
        directions_(define(root, "directions", column_, summary.directions.size())) {
    hdf5::write_attributes(root, {{"title", "reflectances at pairs of directions"}, {"source", source.brdf.name}});
    if (!source.brdf.conventions.empty()) hdf5::write_attributes(root, {{"conventions", source.brdf.conventions}});
    add_quantity(root, "brdf");
    if (source.has_errors) add_quantity(root, "brdf_error");
    if (source.replicated) add_quantity(root, "brdf_std");
  }

  void write(std::size_t first, const Answer& answer) const {
    const std::size_t rows = answer.pairs.directions.size();
    write_rows(directions_, first, answer.pairs.numbers.size() / rows, answer.pairs.numbers);
    const std::size_t columns = quantities_.size() * channels_;
    std::vector<double> values(rows * channels_);
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
      for (std::size_t row = 0; row < rows; ++row) {
        const auto begin = answer.values.begin() + static_cast<std::ptrdiff_t>(row * columns + q * channels_);
        std::copy_n(begin, channels_, values.begin() + static_cast<std::ptrdiff_t>(row * channels_));
      }
      write_rows(quantities_[q], first, channels_, values);
    }
  }

 private:
  [[nodiscard]] hdf5::Dataset define(hid_t root, const std::string& name, const hdf5::Dataset& columns,
                                     std::size_t count) const {
    const std::array<const hdf5::Dataset*, 2> axes{&pair_, &columns};
    const std::array<hsize_t, 2> chunk{std::clamp<hsize_t>(pairs_, 1, kRowsOfChunk), count};
    return hdf5::define_dataset(root, name, axes, chunk, false);
  }

  void add_quantity(hid_t root, const std::string& name) {
    quantities_.push_back(define(root, name, channel_, channels_));
    hdf5::write_attributes(quantities_.back().id(), {{"units", "sr-1"}});
  }

  static constexpr hsize_t kRowsOfChunk = 8192;

  std::size_t channels_;
  std::size_t pairs_;
  hdf5::Dataset pair_;
  hdf5::Dataset column_;
  hdf5::Dataset channel_;
  hdf5::Dataset directions_;
  std::vector<hdf5::Dataset> quantities_;
};

PairSummary write_hdf5(const PairSource& source, const fs::path& pairs, const PairOptions& options,
                       hdf5::OutputFile& file) {
  std::optional<PairDatasets> datasets;
  return answer_all(source, pairs, options,
                    {.begin = [&](const PairList& /*list*/,
                                  const PairSummary& summary) { datasets.emplace(file.root(), source, summary); },
                     .prepare = [](Answer& /*answer*/) { return std::string(); },
                     .write =
                         [&](std::size_t first, const Answer& answer, const std::string& /*text*/) {
                           datasets->write(first, answer);
                           file.check_writes();
                         }});
}

}  // namespace

PairSummary evaluate_pairs(const Device& device, const Reflectance& reflectance, const fs::path& pairs,
                           const fs::path& output, const PairOptions& options) {
  const PairSource source = pair_source_of(device, reflectance, options);
  const std::string kind = lowercase(output.extension().string());
  if (kind != ".csv" && kind != ".npy" && kind != ".h5") {
    throw ArgumentError(
        fmt::format("{} is no name of a file of values; expected FILE.csv, FILE.npy or FILE.h5", output.string()));
  }
  PairSummary summary;
  write_atomically(output, options.overwrite, [&](const fs::path& temporary) {
    if (kind == ".h5") {
      hdf5::OutputFile file(temporary, output.string());
      summary = write_hdf5(source, pairs, options, file);
      file.close();
      return;
    }
    FileWriter file(temporary, output.string());
    summary = kind == ".npy" ? write_npy(source, pairs, options, file)
                             : write_csv(source, pairs, options, [&](std::string_view text) { file.write(text); });
    file.close();
  });
  return summary;
}

PairSummary evaluate_pairs(const Device& device, const Reflectance& reflectance, const fs::path& pairs,
                           std::string& text, const PairOptions& options) {
  const PairSource source = pair_source_of(device, reflectance, options);
  return write_csv(source, pairs, options, [&](std::string_view more) { text += more; });
}

}  // namespace lobe
