#include "lobe/hdf5/table_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/clock.hpp"
#include "core/files.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "hdf5/chunk_codec.hpp"
#include "hdf5/file_digest.hpp"
#include "hdf5/hdf5_input.hpp"
#include "hdf5/hdf5_output.hpp"
#include "hdf5/table_layout.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSchema = "lobe-table/1";
constexpr const char* kReference =
    "A. Neumann: Constructions of Bidirectional Reflection Distribution Functions, dissertation, TU Wien 2001";

using Shape = std::vector<hsize_t>;

/// Shape of a dataset along axes of a layout, with the channels first where there are several.
Shape shape_along(const TableLayout& layout, std::size_t channels, const std::vector<std::size_t>& axes) {
  Shape shape;
  if (channels > 1) shape.push_back(channels);
  for (const std::size_t length : layout.lengths(axes)) shape.push_back(length);
  return shape;
}

std::vector<std::size_t> joined(std::vector<std::size_t> first, const std::vector<std::size_t>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::string_view form_name(TableForm form) {
  return form == TableForm::isotropic ? "isotropic" : "general";
}

// --- writing ---

/// One material per line.
std::string json_lines(std::span<const Material> materials) {
  std::string lines;
  for (const auto& material : materials) {
    if (!lines.empty()) lines += '\n';
    lines += to_json(material);
  }
  return lines;
}

/// A table's numbers as the file has them: an isotropic table can be written in its general form without ever being in
/// memory as such.
class TableRows {
 public:
  TableRows(const BrdfTable& table, TableForm form)
      : table_(table), is_spread_(form == TableForm::general && table.form == TableForm::isotropic) {}

  [[nodiscard]] std::size_t rows() const { return is_spread_ ? table_.grid.nodes() : table_.rows(); }
  [[nodiscard]] std::size_t length() const { return is_spread_ ? table_.grid.nodes() : table_.size() / table_.rows(); }

  /// Copies a part of a row of brdf.
  /// \param row of all channels' rows, one channel after the other
  void copy(std::size_t row, std::size_t begin, std::span<double> target) const {
    if (is_spread_) return spread(row, begin, target);
    std::copy_n(table_.values.begin() + static_cast<std::ptrdiff_t>(row * length() + begin), target.size(),
                target.begin());
  }

  /// Numbers by row: those of a ring for each of its nodes.
  [[nodiscard]] std::vector<double> by_row(const std::vector<double>& numbers) const {
    if (!is_spread_) return numbers;
    std::vector<double> result;
    for (const double number : numbers) result.insert(result.end(), table_.grid.n_phi(), number);
    return result;
  }

 private:
  void spread(std::size_t row, std::size_t begin, std::span<double> target) const {
    const std::size_t azimuths = table_.grid.n_phi();
    const std::size_t half = table_.grid.half_azimuths();
    const std::size_t phi_in = row % azimuths;
    // Rows of the isotropic table, all channels' one after the other, begin every n_theta * half values.
    const double* source = table_.values.data() + row / azimuths * table_.grid.n_theta() * half;
    for (std::size_t i = 0; i < target.size(); ++i) {
      const std::size_t phi_out = (begin + i) % azimuths;
      const std::size_t difference = phi_out >= phi_in ? phi_out - phi_in : phi_in - phi_out;
      target[i] = source[(begin + i) / azimuths * half + std::min(difference, azimuths - difference)];
    }
  }

  const BrdfTable& table_;
  bool is_spread_;
};

/// Part of a row of brdf: all of it where it fits into a chunk, else some of its first axis.
Shape chunk_of_row(Shape out) {
  constexpr std::size_t kLargest = (std::size_t{1} << 20) / sizeof(double);
  const std::size_t rest = hdf5::volume(std::span(out).subspan(1));
  out.front() = std::clamp<hsize_t>(kLargest / rest, 1, out.front());
  return out;
}

class TableWriter {
 public:
  TableWriter(const BrdfTable& table, const TableFileOptions& options, hdf5::OutputFile& file)
      : table_(table),
        options_(options),
        file_(file),
        form_(options.dense ? TableForm::general : table.form),
        layout_(table_layout(table.grid, form_)),
        rows_(table, form_) {}

  void write() {
    write_root();
    write_axes();
    write_values();
    write_error();
    if (!table_.mirror.empty()) {
      write_by_row(file_.root(), "mirror", "factor of the ideal mirror (Neumann 2001, eq. 1.29)", table_.mirror,
                   layout_.in);
    }
    if (!table_.retro.empty()) {
      write_by_row(file_.root(), "retro", "factor of the retro-reflecting ideal mirror (Neumann 2001, eq. 1.26)",
                   table_.retro, layout_.in);
    }
    if (!table_.factors.empty()) write_factors();
    write_provenance();
  }

 private:
  void write_root() const {
    const std::string created = time_of_writing();
    hdf5::write_attributes(file_.root(), {{"Conventions", "CF-1.10, ACDD-1.3"},
                                          {"title", "BRDF table: " + table_.expression},
                                          {"history", created + ": " + options_.command_line},
                                          {"source", fmt::format("lobe {} ({})", version(), commit())},
                                          {"references", kReference},
                                          {"date_created", created},
                                          {"lobe_schema", kSchema},
                                          {"grid", table_.grid.name()},
                                          {"form", form_name(form_)},
                                          {"expression", table_.expression}});
    if (!table_.source.empty()) hdf5::write_attribute(file_.root(), "material_json", json_lines(table_.source));
    if (!table_.channel_names.empty()) {
      hdf5::write_attribute(file_.root(), "channel_names", fmt::format("{}", fmt::join(table_.channel_names, "\n")));
    }
    if (!table_.conventions.empty()) hdf5::write_attribute(file_.root(), "conventions", table_.conventions);
    hdf5::write_attribute(file_.root(), "resolution_error", table_.resolution_error);
    hdf5::write_attribute(file_.root(), "is_unresolved", std::int64_t{table_.is_unresolved});
  }

  void write_axes() {
    if (table_.channels > 1) {
      channel_.emplace(hdf5::create_index_axis(file_.root(), "channel", table_.channels));
      hdf5::write_attribute(channel_->id(), "long_name", "number of the channel");
    }
    for (const auto& axis : layout_.axes) {
      axes_.push_back(axis.radians.empty() ? hdf5::create_index_axis(file_.root(), axis.name, axis.length)
                                           : hdf5::create_number_axis(file_.root(), axis.name, axis.radians));
      hdf5::write_attribute(axes_.back().id(), "long_name", axis.long_name);
      if (!axis.radians.empty()) hdf5::write_attribute(axes_.back().id(), "units", "radian");
    }
    for (const auto& variable : layout_.variables) {
      const hdf5::Dataset* const along[] = {&axes_[variable.axis]};
      const auto dataset = hdf5::create_dataset(file_.root(), variable.name, variable.values, along);
      hdf5::write_attributes(dataset.id(), {{"long_name", variable.long_name}, {"units", variable.units}});
    }
  }

  [[nodiscard]] std::vector<const hdf5::Dataset*> along(const std::vector<std::size_t>& axes) const {
    std::vector<const hdf5::Dataset*> result;
    if (channel_) result.push_back(&*channel_);
    for (const std::size_t axis : axes) result.push_back(&axes_[axis]);
    return result;
  }

  void write_values() const {
    const Shape out = shape_along(layout_, 1, layout_.out);
    const Shape part = chunk_of_row(out);
    const Shape in = shape_along(layout_, table_.channels, layout_.in);
    Shape chunk(in.size(), 1);
    chunk.insert(chunk.end(), part.begin(), part.end());
    const auto brdf =
        hdf5::define_dataset(file_.root(), "brdf", along(joined(layout_.in, layout_.out)), chunk, options_.compress);
    hdf5::write_attributes(brdf.id(), {{"long_name", "bidirectional reflectance distribution function, smooth part"},
                                       {"units", "sr-1"},
                                       {"ancillary_variables", "brdf_error"},
                                       {"comment", table_.grid.has_cells() ? "averages over the grid's cells"
                                                                           : "values at the grid's nodes"}});
    if (!layout_.coordinates.empty()) hdf5::write_attribute(brdf.id(), "coordinates", layout_.coordinates);
    write_chunks(brdf, in, out, part);
  }

  /// Compresses a batch of chunks on all cores, then writes it.
  void write_chunks(const hdf5::Dataset& brdf, const Shape& in, const Shape& out, const Shape& part) const {
    constexpr std::size_t kBatchDoubles = std::size_t{1} << 21;
    const std::size_t chunk_size = hdf5::volume(part);
    const std::size_t parts = (out.front() + part.front() - 1) / part.front();
    const std::size_t count = hdf5::volume(in) * parts;
    std::vector<std::vector<unsigned char>> batch(std::clamp<std::size_t>(kBatchDoubles / chunk_size, 1, count));
    for (std::size_t first = 0; first < count; first += batch.size()) {
      const std::size_t size = std::min(batch.size(), count - first);
      parallel_for(size, [&](std::size_t i) {
        const std::size_t begin = (first + i) % parts * chunk_size;
        std::vector<double> values(chunk_size, std::numeric_limits<double>::quiet_NaN());
        rows_.copy((first + i) / parts, begin, std::span(values).first(std::min(chunk_size, rows_.length() - begin)));
        batch[i] = hdf5::encode_chunk(values, options_.compress);
      });
      for (std::size_t i = 0; i < size; ++i) {
        Shape offset = position_of((first + i) / parts, in);
        offset.resize(in.size() + out.size());
        offset[in.size()] = (first + i) % parts * part.front();
        file_.write_chunk(brdf, offset, batch[i]);
      }
      file_.check_writes();
    }
  }

  /// Indices of the n-th element of a row-major array.
  static Shape position_of(std::size_t n, const Shape& shape) {
    Shape position(shape.size());
    for (std::size_t i = shape.size(); i-- > 0; n /= shape[i]) position[i] = n % shape[i];
    return position;
  }

  void write_error() const {
    const auto dataset =
        hdf5::create_dataset(file_.root(), "brdf_error", table_.error, along({layout_.ring_in, layout_.ring_out}));
    hdf5::write_attributes(dataset.id(),
                           {{"long_name", "bound on the error of brdf, over all azimuths"}, {"units", "sr-1"}});
    write_part_of_error("brdf_even_error", table_.even_error,
                        "that of the mean of both signs of delta_phi, root mean square over azimuth");
    write_part_of_error("brdf_odd_part", table_.odd_part,
                        "half the difference of both signs of delta_phi, root mean square over azimuth");
  }

  void write_part_of_error(const std::string& name, const std::vector<double>& numbers, const std::string& what) const {
    if (numbers.empty()) return;
    const auto dataset = hdf5::create_dataset(file_.root(), name, numbers, along({layout_.ring_in, layout_.ring_out}));
    hdf5::write_attributes(dataset.id(), {{"long_name", what}, {"units", "sr-1"}});
  }

  /// Numbers by row of one direction,
  /// \param axes those of the direction
  void write_by_row(hid_t group, const std::string& name, const std::string& long_name,
                    const std::vector<double>& numbers, const std::vector<std::size_t>& axes) const {
    const auto dataset = hdf5::create_dataset(group, name, rows_.by_row(numbers), along(axes));
    hdf5::write_attributes(dataset.id(), {{"long_name", long_name}, {"units", "1"}});
  }

  void write_factors() const {
    const auto factors = hdf5::create_group(file_.root(), "factors");
    const char* name = "first";
    for (const auto& factor : table_.factors) {
      const auto group = hdf5::create_group(factors.id(), name);
      hdf5::write_attribute(group.id(), "expression", factor.expression);
      write_by_row(group.id(), "in", "albedo: integral over V, by L", factor.in, layout_.in);
      write_by_row(group.id(), "out", "albedo: integral over L, by V", factor.out, layout_.viewer);
      name = "second";
    }
  }

  void write_provenance() const {
    const auto group = hdf5::create_group(file_.root(), "provenance");
    hdf5::write_attributes(group.id(), {{"software", "lobe"},
                                        {"software_version", version()},
                                        {"git_commit", commit()},
                                        {"hdf5_version", hdf5_version()},
                                        {"command_line", options_.command_line}});
  }

  const BrdfTable& table_;
  const TableFileOptions& options_;
  hdf5::OutputFile& file_;
  TableForm form_;
  TableLayout layout_;
  TableRows rows_;
  std::optional<hdf5::Dataset> channel_;
  std::vector<hdf5::Dataset> axes_;
};

// --- reading ---

HemisphereGrid read_grid(const hdf5::InputFile& file) {
  try {
    return HemisphereGrid::parse(file.text("/", "grid"));
  } catch (const ArgumentError& error) {
    file.refuse(std::string("attribute grid of /: ") + error.what());
  }
}

TableForm read_form(const hdf5::InputFile& file) {
  const std::string form = file.text("/", "form");
  for (const TableForm known : {TableForm::isotropic, TableForm::general}) {
    if (form == form_name(known)) return known;
  }
  file.refuse("attribute form of / is '" + form + "'; expected isotropic or general");
}

std::vector<Material> read_source(const hdf5::InputFile& file) {
  std::vector<Material> source;
  if (!file.has_attribute("/", "material_json")) return source;
  const std::string lines = file.text("/", "material_json");
  try {
    for (const auto line : split(lines, '\n')) source.push_back(material_from_json(line));
  } catch (const ArgumentError& error) {
    file.refuse(std::string("attribute material_json of /: ") + error.what());
  }
  return source;
}

class TableReader {
 public:
  explicit TableReader(const fs::path& path) : file_(path), stem_(path.stem().string()) {
    check_schema();
    table_.grid = read_grid(file_);
    table_.form = file_.has_attribute("/", "form") ? read_form(file_) : form_of_values();
    if (table_.form == TableForm::isotropic && !table_.grid.is_product()) {
      file_.refuse("it is an isotropic table on grid " + table_.grid.name() + "; expected a product grid");
    }
    layout_ = table_layout(table_.grid, table_.form);
    table_.channels = read_channels();
    check_axes();
  }

  /// All but the values.
  BrdfTable header() {
    const Shape errors = shape({layout_.ring_in, layout_.ring_out});
    table_.error = file_.has("/brdf_error") ? file_.read("/brdf_error", errors)
                                            : std::vector<double>(hdf5::volume(errors), kUnknown);
    if (file_.has("/brdf_even_error") && file_.has("/brdf_odd_part")) {
      table_.even_error = file_.read("/brdf_even_error", errors);
      table_.odd_part = file_.read("/brdf_odd_part", errors);
    }
    table_.mirror = parts("/mirror");
    table_.retro = parts("/retro");
    if (file_.has("/factors")) table_.factors = {factor("/factors/first"), factor("/factors/second")};
    table_.expression = name();
    table_.source = read_source(file_);
    table_.channel_names = read_names();
    if (file_.has_attribute("/", "conventions")) table_.conventions = file_.text("/", "conventions");
    table_.resolution_error = number_or("resolution_error", kUnknown);
    table_.is_unresolved = number_or("is_unresolved", 0) != 0;
    return std::move(table_);
  }

  void read_values(TableValues& values) const { read_all("/brdf", values); }

  [[nodiscard]] bool has_deviations() const { return file_.has("/brdf_std"); }
  void read_deviations(TableValues& values) const {
    read_all("/brdf_std", values);
    const auto wrong = std::ranges::find_if(values, [](double value) { return value < 0; });
    if (wrong != values.end()) {
      file_.refuse(
          fmt::format("dataset /brdf_std has a standard deviation of {}; expected 0 or more", shortest(*wrong)));
    }
  }

  [[nodiscard]] std::vector<double> row(std::size_t channel, std::size_t row) const {
    require_below(channel, table_.channels, "channel");
    require_below(row, table_.rows(), "row");
    const Shape in = shape_along(layout_, 1, layout_.in);
    Shape offset;
    if (table_.channels > 1) offset.push_back(channel);
    if (in.size() > 1) offset.push_back(row / in.back());
    offset.push_back(in.size() > 1 ? row % in.back() : row);
    Shape count(offset.size(), 1);
    for (const auto length : shape_along(layout_, 1, layout_.out)) {
      offset.push_back(0);
      count.push_back(length);
    }
    return file_.read_box("/brdf", offset, count);
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  void read_all(const std::string& dataset, TableValues& values) const {
    const Shape all = shape(joined(layout_.in, layout_.out));
    values.resize(hdf5::volume(all));
    file_.read(dataset, all, values);
    // A chunk that is missing reads as the fill value.
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
      file_.refuse("dataset " + dataset + " has values that are no numbers");
    }
  }

  /// Files of other programs need neither a schema nor more than a grid and values; what they lack is said at once.
  void check_schema() const {
    if (file_.has_attribute("/", "lobe_schema")) {
      const std::string schema = file_.text("/", "lobe_schema");
      if (schema.starts_with("lobe-study/")) file_.refuse("it is the result of a study; expected a table");
      if (schema != kSchema && schema.starts_with("lobe-table/")) {
        file_.refuse("it was written by a newer lobe, as " + schema + "; read it with that one (this one reads " +
                     kSchema + ")");
      }
      if (schema != kSchema) file_.refuse("its schema is '" + schema + "'; expected " + kSchema);
    }
    const bool has_grid = file_.has_attribute("/", "grid");
    const bool has_values = file_.has("/brdf");
    if (has_grid && has_values) return;
    file_.refuse(fmt::format("it is no table: {}{}{} missing (all that a table needs, see docs/file-formats.md)",
                             has_grid ? "" : "attribute grid of /, such as 'gauss:64x128',",
                             has_grid || has_values ? "" : " and ",
                             has_values ? " is"
                             : has_grid ? "dataset /brdf is"
                                        : "dataset /brdf are"));
  }

  [[nodiscard]] std::string name() const {
    for (const char* attribute : {"expression", "name"}) {
      if (file_.has_attribute("/", attribute)) return file_.line("/", attribute);
    }
    return stem_;
  }

  [[nodiscard]] double number_or(const char* attribute, double otherwise) const {
    return file_.has_attribute("/", attribute) ? file_.number("/", attribute) : otherwise;
  }

  /// Axes of brdf, without that of channels.
  [[nodiscard]] static Shape value_shape(const HemisphereGrid& grid, TableForm form) {
    const TableLayout layout = table_layout(grid, form);
    return shape_along(layout, 1, joined(layout.in, layout.out));
  }

  /// "18 x 18 x 19 (theta_in x theta_out x delta_phi)"
  [[nodiscard]] static std::string shape_text(const HemisphereGrid& grid, TableForm form) {
    const TableLayout layout = table_layout(grid, form);
    std::vector<std::string> names;
    for (const std::size_t axis : joined(layout.in, layout.out)) names.push_back(layout.axes[axis].name);
    return fmt::format("{} ({})", fmt::join(value_shape(grid, form), " x "), fmt::join(names, " x "));
  }

  /// Whether values of a shape are of a form, of one channel or of several, which come first.
  [[nodiscard]] static bool is_shape_of(const Shape& seen, const HemisphereGrid& grid, TableForm form) {
    const Shape one = value_shape(grid, form);
    return seen == one || (seen.size() == one.size() + 1 && std::equal(one.begin(), one.end(), seen.begin() + 1));
  }

  [[nodiscard]] TableForm form_of_values() const {
    const Shape seen = file_.shape("/brdf");
    const HemisphereGrid& grid = table_.grid;
    const bool is_isotropic = grid.is_product() && is_shape_of(seen, grid, TableForm::isotropic);
    const bool is_general = is_shape_of(seen, grid, TableForm::general);
    if (is_isotropic && is_general) {
      file_.refuse("dataset /brdf may be isotropic or general; expected attribute form of /, which says so");
    }
    if (is_isotropic) return TableForm::isotropic;
    if (is_general) return TableForm::general;
    file_.refuse(fmt::format("dataset /brdf has the shape {}; expected {}{}, on grid {}, with channels in front",
                             fmt::join(seen, " x "),
                             grid.is_product() ? shape_text(grid, TableForm::isotropic) + " or " : "",
                             shape_text(grid, TableForm::general), grid.name()));
  }

  [[nodiscard]] Shape shape(const std::vector<std::size_t>& axes) const {
    return shape_along(layout_, table_.channels, axes);
  }

  /// Number of channels, from a first axis of brdf beside those of the grid. The rest of its shape is checked too.
  [[nodiscard]] std::size_t read_channels() const {
    const Shape seen = file_.shape("/brdf");
    const auto axes = joined(layout_.in, layout_.out);
    const std::size_t channels = seen.size() == axes.size() + 1 ? static_cast<std::size_t>(seen.front()) : 1;
    if (seen != shape_along(layout_, channels, axes)) {
      file_.refuse("the shape of dataset /brdf is not that of " + std::string(form_name(table_.form)) +
                   " tables on grid " + table_.grid.name());
    }
    return channels;
  }

  [[nodiscard]] std::vector<std::string> read_names() const {
    std::vector<std::string> names;
    if (!file_.has_attribute("/", "channel_names")) return names;
    names = file_.text_list("/", "channel_names");
    if (names.size() != table_.channels) {
      file_.refuse(
          fmt::format("attribute channel_names of / has {} names; expected {}", names.size(), table_.channels));
    }
    return names;
  }

  void check_axes() const {
    for (const auto& axis : layout_.axes) {
      if (axis.radians.empty()) continue;
      check_numbers(axis.name, axis.radians);
    }
    for (const auto& variable : layout_.variables) check_numbers(variable.name, variable.values);
  }

  /// Checks that a dataset, if it exists, agrees with the grid.
  void check_numbers(const std::string& name, std::span<const double> expected) const {
    if (!file_.has("/" + name)) return;
    const double tolerance = file_.is_narrow("/" + name) ? 1e-6 : 1e-12;
    const hsize_t length = expected.size();
    const auto seen = file_.read("/" + name, {&length, 1});
    const auto is_near = [&](double a, double b) { return std::abs(a - b) <= tolerance; };
    if (!std::ranges::equal(seen, expected, is_near)) {
      file_.refuse("dataset /" + name + " does not hold the numbers of grid " + table_.grid.name());
    }
  }

  [[nodiscard]] std::vector<double> parts(const std::string& name) const {
    if (!file_.has(name)) return {};
    return file_.read(name, shape(layout_.in));
  }

  [[nodiscard]] FactorAlbedo factor(const std::string& group) const {
    return {file_.line(group, "expression"), file_.read(group + "/in", shape(layout_.in)),
            file_.read(group + "/out", shape(layout_.viewer))};
  }

  static void require_below(std::size_t index, std::size_t count, const char* what) {
    if (index < count) return;
    throw ArgumentError(fmt::format("the table has no {} {}; its {}s are 0 to {}", what, index, what, count - 1));
  }

  hdf5::InputFile file_;
  std::string stem_;
  BrdfTable table_;
  TableLayout layout_;
};

}  // namespace

void save(const BrdfTable& table, const fs::path& path, const TableFileOptions& options) {
  check(table);
  (void)HemisphereGrid::parse(table.grid.name());  // no file for a grid that it could not name
  write_atomically(path, options.overwrite, [&](const fs::path& temporary) {
    hdf5::OutputFile file(temporary, path.string());
    TableWriter(table, options, file).write();
    file.close();
  });
}

BrdfTable load_table(const fs::path& path) {
  TableReader reader(path);
  TableValues values;
  reader.read_values(values);
  BrdfTable table = reader.header();
  table.values = std::move(values);
  return table;
}

BrdfTable load_table_header(const fs::path& path) {
  return TableReader(path).header();
}

bool states_deviations(const fs::path& path) {
  return TableReader(path).has_deviations();
}

TableValues load_table_deviations(const fs::path& path) {
  const TableReader reader(path);
  TableValues values;
  if (reader.has_deviations()) reader.read_deviations(values);
  return values;
}

std::vector<double> load_table_row(const fs::path& path, std::size_t channel, std::size_t row) {
  return TableReader(path).row(channel, row);
}

bool is_table_file(const fs::path& path) {
  require_sound(path);
  try {
    const hdf5::InputFile file(path);
    if (file.has_attribute("/", "lobe_schema")) return file.text("/", "lobe_schema") == kSchema;
    return file.has_attribute("/", "grid") && file.has("/brdf");
  } catch (const IoError&) {
    return false;
  }
}

}  // namespace lobe
