#include "lobe/lut/lut_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "core/text.hpp"
#include "formats/file_bytes.hpp"
#include "formats/npy.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "lut/exr.hpp"
#include "lut/ktx2.hpp"
#include "lut/lut_hdf5.hpp"
#include "lut/png.hpp"

namespace lobe {
namespace {

constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

/// Numbers of a file.
enum class Numbers { doubles, floats, halves, levels };

/// A format and what it holds.
struct FormatRow {
  std::string_view name;
  std::string_view ending;
  std::size_t most_axes;
  std::size_t most_columns;
  std::array<int, 2> bits;  ///< that may be chosen, the usual ones first; 0: none
};
constexpr std::array kFormats{FormatRow{"csv", ".csv", kAny, kAny, {}}, FormatRow{"npy", ".npy", kAny, kAny, {}},
                              FormatRow{"c", ".h", kAny, kAny, {}},     FormatRow{"glsl", ".glsl", kAny, 4, {}},
                              FormatRow{"png", ".png", 2, 4, {16, 8}},  FormatRow{"spi1d", ".spi1d", 1, 3, {}},
                              FormatRow{"hdf5", ".h5", kAny, kAny, {}}, FormatRow{"exr", ".exr", 2, kAny, {32, 16}},
                              FormatRow{"ktx2", ".ktx2", 3, 4, {16, 8}}};
constexpr std::array<int, 2> kFloatBits{16, 32};  // of ktx2 with floating-point numbers

const FormatRow& row_of(LutFormat format) {
  return kFormats.at(static_cast<std::size_t>(format));
}

constexpr auto kNames = [] {
  std::array<std::string_view, kFormats.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kFormats[i].name;
  return names;
}();

std::array<int, 2> bits_of_format(const LutFileOptions& options) {
  return options.format == LutFormat::ktx2 && options.is_float ? kFloatBits : row_of(options.format).bits;
}

int bits_of(const LutFileOptions& options) {
  return options.bits == 0 ? bits_of_format(options).front() : options.bits;
}

Numbers numbers_of(const LutFileOptions& options) {
  const bool is_half = bits_of(options) == 16;
  switch (options.format) {
    case LutFormat::csv:
    case LutFormat::npy:
    case LutFormat::hdf5:
      return Numbers::doubles;
    case LutFormat::c:
    case LutFormat::glsl:
    case LutFormat::spi1d:
      return Numbers::floats;
    case LutFormat::png:
      return Numbers::levels;
    case LutFormat::exr:
      return is_half ? Numbers::halves : Numbers::floats;
    case LutFormat::ktx2:
      return !options.is_float ? Numbers::levels : is_half ? Numbers::halves : Numbers::floats;
  }
  return Numbers::doubles;
}

double levels_of(int bits) {
  return std::exp2(bits) - 1;
}

bool is_image(LutFormat format) {
  return format == LutFormat::png || format == LutFormat::exr || format == LutFormat::ktx2;
}

/// The lines that every file with a header has.
std::vector<std::string> header(const Lut& lut, const std::optional<LutErrors>& errors, const LutFileOptions& options) {
  std::vector<std::string> lines{lut_quantity_text(lut.request)};
  lines.push_back(fmt::format("made by lobe {}{}{}", version(), options.command_line.empty() ? "" : ": ",
                              printable(options.command_line)));
  const auto& axes = lut.request.axes;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    std::string role = axes.size() == 1       ? ""
                       : a == 0               ? ", the slowest index"
                       : a + 1 == axes.size() ? ", the quickest"
                                              : "";
    if (is_image(options.format)) {
      role = a + 1 == axes.size() ? ", along the rows" : a + 2 == axes.size() ? ", from the top down" : ", by depth";
    }
    lines.push_back(fmt::format("axis {}: {}{}", a + 1, lut_axis_text(axes[a]), role));
  }
  if (lut.columns.size() > 1) lines.push_back(fmt::format("columns: {}", fmt::join(lut.columns, ", ")));
  if (errors) {
    lines.push_back(fmt::format("largest error of an entry as stored: {:.2g} at {}", errors->entries.largest,
                                lut_place_text(lut, errors->entries)));
    lines.push_back(fmt::format("largest error of linear interpolation between entries: {:.2g} at {}",
                                errors->between.largest, lut_place_text(lut, errors->between)));
    if (errors->all.largest > errors->between.largest) {
      lines.push_back(fmt::format("largest error up to the ends of the axes, clamped: {:.2g} at {}",
                                  errors->all.largest, lut_place_text(lut, errors->all)));
    }
    lines.push_back(fmt::format("errors are absolute and were measured at {} points", errors->points));
  }
  return lines;
}

std::string commented(const std::vector<std::string>& lines, std::string_view mark) {
  std::string text;
  for (const auto& line : lines) text += fmt::format("{} {}\n", mark, line);
  return text;
}

std::string csv(const Lut& lut, const std::vector<std::string>& lines) {
  std::string text = commented(lines, "#");
  std::vector<std::string> names;
  for (const auto& axis : lut.request.axes) names.push_back(axis.name == "theta" ? "theta_deg" : axis.name);
  names.insert(names.end(), lut.columns.begin(), lut.columns.end());
  const bool has_errors = !lut.errors.empty();
  if (has_errors) {
    for (const auto& column : lut.columns) names.push_back(column + "_error");
  }
  text += fmt::format("{}\n", fmt::join(names, ","));
  const std::size_t columns = lut.columns.size();
  for (std::size_t i = 0; i < lut.entries(); ++i) {
    std::vector<std::string> fields(lut.request.axes.size());
    std::size_t rest = i;
    for (std::size_t a = fields.size(); a-- > 0;) {
      const LutAxis& axis = lut.request.axes[a];
      fields[a] = shortest(axis.value(axis.coordinate(rest % axis.count)));
      rest /= axis.count;
    }
    for (std::size_t c = 0; c < columns; ++c) fields.push_back(shortest(lut.values[i * columns + c]));
    for (std::size_t c = 0; has_errors && c < columns; ++c) {
      fields.push_back(fmt::format("{:.2g}", lut.errors[i * columns + c]));
    }
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

/// The shortest text of a number that reads back as the same float, with a point.
std::string float_text(double value) {
  std::string text = fmt::format("{}", static_cast<float>(value));
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::vector<std::size_t> shape_of(const Lut& lut) {
  std::vector<std::size_t> shape;
  for (const auto& axis : lut.request.axes) shape.push_back(axis.count);
  if (lut.columns.size() > 1) shape.push_back(lut.columns.size());
  return shape;
}

std::string c_header(const Lut& lut, const std::vector<std::string>& lines, const std::string& name) {
  std::string text = commented(lines, "//");
  std::string extents;
  for (const std::size_t extent : shape_of(lut)) extents += fmt::format("[{}]", extent);
  // Nested braces, which C and C++ take alike.
  const auto shape = shape_of(lut);
  text += fmt::format("static const float {}{} = ", name, extents);
  for (std::size_t i = 0; i < lut.values.size(); ++i) {
    std::size_t below = 1;
    std::string opening;
    for (std::size_t d = shape.size(); d-- > 0;) {
      below *= shape[d];
      if (i % below == 0) opening += "{";
    }
    if (!opening.empty()) {
      if (i > 0) text += "\n";
      text += opening;
    }
    text += float_text(lut.values[i]) + "f";
    below = 1;
    for (std::size_t d = shape.size(); d-- > 0;) {
      below *= shape[d];
      if ((i + 1) % below == 0) text += "}";
    }
    if (i + 1 < lut.values.size()) text += (i + 1) % shape.back() == 0 ? "," : ", ";
  }
  return text + ";\n";
}

std::string glsl(const Lut& lut, const std::vector<std::string>& lines, const std::string& name) {
  const std::size_t columns = lut.columns.size();
  const std::string type = columns == 1 ? "float" : fmt::format("vec{}", columns);
  std::string text = commented(lines, "//");
  text += fmt::format("const {0} {1}[{2}] = {0}[{2}](\n", type, name, lut.entries());
  for (std::size_t i = 0; i < lut.entries(); ++i) {
    std::vector<std::string> numbers;
    for (std::size_t c = 0; c < columns; ++c) numbers.push_back(float_text(lut.values[i * columns + c]));
    const std::string joined = fmt::format("{}", fmt::join(numbers, ", "));
    text += columns == 1 ? joined : fmt::format("{}({})", type, joined);
    if (i + 1 < lut.entries()) text += (i + 1) % lut.request.axes.back().count == 0 ? ",\n" : ", ";
  }
  return text + ");\n";
}

std::string spi1d(const Lut& lut, const std::vector<std::string>& lines) {
  const LutAxis& axis = lut.request.axes.front();
  std::string text = fmt::format("Version 1\nFrom {} {}\nLength {}\nComponents {}\n{{\n", shortest(axis.from),
                                 shortest(axis.to), axis.count, lut.columns.size());
  for (std::size_t i = 0; i < lut.entries(); ++i) {
    std::vector<std::string> numbers;
    for (std::size_t c = 0; c < lut.columns.size(); ++c) {
      numbers.push_back(float_text(lut.values[i * lut.columns.size() + c]));
    }
    text += fmt::format("  {}\n", fmt::join(numbers, " "));
  }
  return text + "}\n" + commented(lines, "#");
}

std::string png(const Lut& lut, const std::vector<std::string>& lines, int bits) {
  const auto& axes = lut.request.axes;
  // Two columns are red and green of an image whose blue is 0: few programs read grey with a second channel as data.
  const std::size_t columns = lut.columns.size();
  LinearImage image{.width = axes.back().count,
                    .height = axes.size() == 1 ? 1 : axes.front().count,
                    .channels = columns == 2 ? 3 : columns,
                    .bits = bits,
                    .values = {}};
  for (std::size_t i = 0; i < lut.entries(); ++i) {
    for (std::size_t c = 0; c < image.channels; ++c) {
      const double value = c < columns ? lut.values[i * columns + c] : 0;
      image.values.push_back(static_cast<std::uint16_t>(std::lround(value * levels_of(bits))));
    }
  }
  return png_content(image, {{"Description", fmt::format("{}", fmt::join(lines, "\n"))},
                             {"Software", fmt::format("lobe {}", version())}});
}

/// Names of an image's channels: those that programs know, as far as they have them.
std::vector<std::string> channel_names(const std::vector<std::string>& columns) {
  if (columns.size() == 1) return {"Y"};
  if (columns.size() == 2) return {"R", "G"};
  if (columns.size() == 3) return {"R", "G", "B"};
  return columns;
}

std::string exr(const Lut& lut, const std::vector<std::string>& lines, int bits) {
  const auto& axes = lut.request.axes;
  return exr_content({.width = axes.back().count,
                      .height = axes.size() == 1 ? 1 : axes.front().count,
                      .channels = channel_names(lut.columns),
                      .values = {lut.values.begin(), lut.values.end()}},
                     bits, {{"comments", fmt::format("{}", fmt::join(lines, "\n"))}});
}

/// Sides of a texture, the last axis along the first one; 0 where there are fewer axes.
std::array<std::size_t, 3> sides_of(const LutRequest& request) {
  std::array<std::size_t, 3> sides{};
  for (std::size_t a = 0; a < request.axes.size(); ++a) sides.at(a) = request.axes[request.axes.size() - 1 - a].count;
  return sides;
}

std::string ktx2(const Lut& lut, const std::vector<std::string>& lines, const LutFileOptions& options) {
  const auto [width, height, depth] = sides_of(lut.request);
  return ktx2_content(
      {.width = width,
       .height = height,
       .depth = depth,
       .channels = lut.columns.size(),
       .bits = bits_of(options),
       .is_float = options.is_float,
       .values = lut.values},
      {{"Description", fmt::format("{}", fmt::join(lines, "\n"))}, {"KTXwriter", fmt::format("lobe {}", version())}});
}

[[noreturn]] void refuse(const LutFileOptions& options, std::string_view what, std::string_view expected) {
  throw ArgumentError(fmt::format("format {} {}; expected {}", row_of(options.format).name, what, expected));
}

void check_shape(const Lut& lut, const LutFileOptions& options) {
  const std::size_t axes = lut.request.axes.size();
  const std::size_t columns = lut.columns.size();
  const FormatRow& row = row_of(options.format);
  if (axes > row.most_axes) {
    refuse(
        options, fmt::format("holds no table of {} axes", axes),
        fmt::format("{} or another format", row.most_axes == 1 ? "one," : fmt::format("at most {},", row.most_axes)));
  }
  if (columns > row.most_columns) {
    refuse(options, fmt::format("holds no {} columns", columns),
           fmt::format("at most {}, or another format", row.most_columns));
  }
  const auto bits = bits_of_format(options);
  if (options.bits != 0 && bits.front() == 0) {
    refuse(options, "has one kind of numbers", "bits for png, exr or ktx2 alone");
  }
  if (options.bits != 0 && std::ranges::find(bits, options.bits) == bits.end()) {
    refuse(options, fmt::format("has no {} bits", options.bits),
           fmt::format("{} or {}", std::min(bits[0], bits[1]), std::max(bits[0], bits[1])));
  }
  if (options.is_float && options.format != LutFormat::ktx2) {
    refuse(options, "has one kind of numbers", "floating-point numbers as a choice for ktx2 alone");
  }
  if (options.format == LutFormat::spi1d) {
    const LutAxis& axis = lut.request.axes.front();
    if (axis.map != AxisMap::linear || axis.entries != AxisEntries::nodes || !(axis.from < axis.to)) {
      refuse(options, "has equally spaced nodes from the least value to the largest",
             "an axis with map=linear,entries=nodes");
    }
  }
  const bool is_name =
      !options.name.empty() && std::isdigit(static_cast<unsigned char>(options.name.front())) == 0 &&
      std::ranges::all_of(options.name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  if ((options.format == LutFormat::c || options.format == LutFormat::glsl) && !is_name) {
    refuse(options, fmt::format("cannot name an array '{}'", excerpt(options.name)), "letters, digits and underscores");
  }
}

/// Numbers of a text, in their order; words, and what stands in brackets, are none.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < text.size();) {
    const unsigned char c = static_cast<unsigned char>(text[i]);
    if (std::isalpha(c) != 0 || c == '_') {
      while (i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_')) ++i;
      continue;
    }
    if (c == '[') {
      while (i < text.size() && text[i] != ']') ++i;
      continue;
    }
    double value = 0;
    const std::size_t start = c == '+' ? i + 1 : i;
    const auto [end, code] = std::from_chars(text.data() + start, text.data() + text.size(), value);
    if (code != std::errc()) {
      ++i;
      continue;
    }
    numbers.push_back(value);
    i = static_cast<std::size_t>(end - text.data());
    if (i < text.size() && (text[i] == 'f' || text[i] == 'F')) ++i;
  }
  return numbers;
}

std::string without_comments(std::string_view text) {
  std::string rest;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i).starts_with("//")) {
      i = std::min(text.find('\n', i), text.size());
    } else if (text.substr(i).starts_with("/*")) {
      const std::size_t end = text.find("*/", i + 2);
      i = end == std::string_view::npos ? text.size() : end + 2;
    } else {
      rest += text[i++];
    }
  }
  return rest;
}

/// The initialiser of the first array of a C or GLSL text.
std::vector<double> array_numbers(const FileBytes& file) {
  const std::string text = without_comments(file.content());
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) file.refuse("holds no array with an initialiser");
  const std::size_t end = std::min(text.find(';', equals), text.size());
  return numbers_in(std::string_view(text).substr(equals + 1, end - equals - 1));
}

std::vector<double> spi1d_numbers(const FileBytes& file) {
  const std::string_view text = file.content();
  const std::size_t open = text.find('{');
  const std::size_t close = text.find('}', open == std::string_view::npos ? 0 : open);
  if (open == std::string_view::npos || close == std::string_view::npos) file.refuse("holds no values between braces");
  return numbers_in(text.substr(open + 1, close - open - 1));
}

/// What the columns of a CSV hold, by its line of names.
struct CsvColumns {
  std::vector<std::size_t> of_axes;    ///< places of the axes' values; empty: rows are in the order of the entries
  std::vector<std::size_t> of_values;  ///< places of the table's columns, or of the first one

  /// \throws IoError for names that are no axes, columns or errors of the table, and for some of them alone
  static CsvColumns of(const FileBytes& file, std::size_t line, const std::vector<std::string_view>& names,
                       const Lut& lut) {
    CsvColumns columns;
    std::vector<bool> is_known(names.size());
    const auto place_of = [&](std::string_view name) -> std::optional<std::size_t> {
      const auto found = std::ranges::find_if(names, [&](std::string_view field) { return trim(field) == name; });
      if (found == names.end()) return std::nullopt;
      const auto place = static_cast<std::size_t>(found - names.begin());
      is_known[place] = true;
      return place;
    };
    std::string missing;
    for (const auto& column : lut.columns) {
      (void)place_of(column + "_error");
      const auto place = place_of(column);
      if (place) columns.of_values.push_back(*place);
      if (!place && (columns.of_values.empty() || missing.empty())) missing = column;
    }
    const bool has_first = !columns.of_values.empty() && trim(names[columns.of_values.front()]) == lut.columns.front();
    if (!has_first) file.refuse_line(line, fmt::format("names no column '{}'", lut.columns.front()));
    if (columns.of_values.size() != 1 && columns.of_values.size() != lut.columns.size()) {
      file.refuse_line(line, fmt::format("names no column '{}'", missing));
    }
    for (const LutAxis& axis : lut.request.axes) {
      auto place = place_of(axis.name);
      if (!place && axis.name == "theta") place = place_of("theta_deg");
      if (place) columns.of_axes.push_back(*place);
      if (!place) missing = axis.name;
    }
    if (!columns.of_axes.empty() && columns.of_axes.size() != lut.request.axes.size()) {
      file.refuse_line(line, fmt::format("names no axis '{}'", missing));
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (is_known[i]) continue;
      file.refuse_line(line, fmt::format("'{}' is no axis or column of the table", excerpt(trim(names[i]))));
    }
    return columns;
  }
};

/// The entries of axes, by their values.
class CsvEntries {
 public:
  explicit CsvEntries(const LutRequest& request) : request_(request) {
    for (const LutAxis& axis : request.axes) {
      along_.emplace_back();
      for (std::size_t i = 0; i < axis.count; ++i) along_.back().push_back(axis.value(axis.coordinate(i)));
    }
  }

  /// The entry of a row.
  [[nodiscard]] std::size_t at(const FileBytes& file, std::size_t line, const std::vector<double>& values) const {
    std::size_t entry = 0;
    for (std::size_t a = 0; a < along_.size(); ++a) {
      entry = entry * along_[a].size() + place(file, line, a, values[a]);
    }
    return entry;
  }

 private:
  [[nodiscard]] std::size_t place(const FileBytes& file, std::size_t line, std::size_t axis, double value) const {
    constexpr double kOfAStep = 0.02;  // values in files are rounded by far less
    const std::vector<double>& along = along_[axis];
    const bool rises = along.front() < along.back();
    const auto found =
        std::ranges::lower_bound(along, value, [rises](double x, double y) { return rises ? x < y : y < x; });
    std::size_t nearest = std::min(static_cast<std::size_t>(found - along.begin()), along.size() - 1);
    if (nearest > 0 && std::abs(along[nearest - 1] - value) < std::abs(along[nearest] - value)) --nearest;
    const std::size_t beside = nearest > 0 ? nearest - 1 : nearest + 1;
    if (std::abs(along[nearest] - value) <= kOfAStep * std::abs(along[nearest] - along[beside])) return nearest;
    file.refuse_line(line, fmt::format("{} is {}, where the axis has no entry; the nearest is {}",
                                       request_.axes[axis].name, shortest(value), shortest(along[nearest])));
  }

  const LutRequest& request_;
  std::vector<std::vector<double>> along_;
};

/// Rows of a CSV. With a line of names they are the table's, and where the axes are among them each row is the entry
/// that it says.
std::vector<double> csv_numbers(const FileBytes& file, const Lut& lut) {
  std::vector<double> numbers;
  CsvColumns columns;
  const CsvEntries entries(lut.request);
  std::vector<bool> is_there;  // entries, by the axes
  bool is_first = true;
  std::size_t rows = 0;
  std::size_t number_of_line = 0;
  for (const std::string_view line : split(file.content(), '\n')) {
    ++number_of_line;
    const std::string_view content = trim(line);
    if (content.empty() || content.starts_with('#')) continue;
    const auto fields = split(content, ',');
    double value = 0;
    if (std::exchange(is_first, false) && !parse_number(trim(fields.front()), value)) {
      columns = CsvColumns::of(file, number_of_line, fields, lut);
      if (columns.of_axes.empty()) continue;
      is_there.resize(lut.entries());
      numbers.resize(lut.entries() * columns.of_values.size());
      continue;
    }
    const auto number_at = [&](std::size_t at) {
      if (at >= fields.size() || !parse_number(trim(fields[at]), value)) {
        file.refuse_line(number_of_line,
                         fmt::format("'{}' is no number", at < fields.size() ? excerpt(trim(fields[at])) : ""));
      }
      return value;
    };
    ++rows;
    if (columns.of_axes.empty()) {
      for (const std::size_t i : columns.of_values) numbers.push_back(number_at(i));
      for (std::size_t i = 0; columns.of_values.empty() && i < fields.size(); ++i) numbers.push_back(number_at(i));
      continue;
    }
    std::vector<double> places;
    for (const std::size_t i : columns.of_axes) places.push_back(number_at(i));
    const std::size_t entry = entries.at(file, number_of_line, places);
    if (is_there[entry]) file.refuse_line(number_of_line, "has the values of the axes of an earlier line");
    is_there[entry] = true;
    for (std::size_t k = 0; k < columns.of_values.size(); ++k) {
      numbers[entry * columns.of_values.size() + k] = number_at(columns.of_values[k]);
    }
  }
  if (!columns.of_axes.empty() && rows != lut.entries()) {
    file.refuse(fmt::format("holds {} entries; the axes ask for {}", rows, lut.entries()));
  }
  return numbers;
}

/// Numbers of an array along the axes, with one more for several columns, or of one in a row.
std::vector<double> npy_numbers(const FileBytes& file, const LutRequest& request, std::size_t columns) {
  NpyArray array = read_npy(file);
  std::vector<std::size_t> wanted;
  for (const LutAxis& axis : request.axes) wanted.push_back(axis.count);
  std::vector<std::size_t> found(array.shape.begin(), array.shape.end());
  const bool has_columns = found.size() == wanted.size() + 1 && (found.back() == 1 || found.back() == columns);
  if (has_columns) found.pop_back();
  if (found.size() != 1 && found != wanted) {
    file.refuse(
        fmt::format("is an array of {}; the axes ask for {}", fmt::join(array.shape, " x "), fmt::join(wanted, " x ")));
  }
  return std::move(array.values);
}

/// Numbers of an image, as many per pixel as there are columns.
std::vector<double> png_numbers(const FileBytes& file, const LutRequest& request, std::size_t columns) {
  const LinearImage image = read_png(file);
  const auto& axes = request.axes;
  const std::size_t height = axes.size() == 1 ? 1 : axes.front().count;
  if (axes.size() > 2 || image.width != axes.back().count || image.height != height) {
    file.refuse(fmt::format("is an image of {} x {} pixels; the axes ask for {} x {}", image.width, image.height,
                            axes.back().count, height));
  }
  const std::size_t taken = std::min(columns, image.channels);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (i % image.channels < taken) numbers.push_back(image.values[i] / levels_of(image.bits));
  }
  return numbers;
}

/// Numbers of an image with named channels: those of the columns, or the first ones.
std::vector<double> exr_numbers(const FileBytes& file, const LutRequest& request,
                                const std::vector<std::string>& columns) {
  const auto& axes = request.axes;
  if (axes.size() > 2) file.refuse(fmt::format("is an image; the definition has {} axes", axes.size()));
  const FloatImage image = read_exr(file, axes.back().count, axes.size() == 1 ? 1 : axes.front().count);
  std::vector<std::size_t> taken;
  for (const auto& column : columns) {
    const auto found = std::ranges::find(image.channels, column);
    if (found != image.channels.end()) taken.push_back(static_cast<std::size_t>(found - image.channels.begin()));
  }
  if (taken.size() < columns.size()) {
    taken.resize(std::min(columns.size(), image.channels.size()));
    std::iota(taken.begin(), taken.end(), 0U);
  }
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin < image.values.size(); begin += image.channels.size()) {
    for (const std::size_t c : taken) numbers.push_back(static_cast<double>(image.values[begin + c]));
  }
  return numbers;
}

std::vector<double> ktx2_numbers(const FileBytes& file, const LutRequest& request, std::size_t columns) {
  const Texture texture = read_ktx2(file);
  const auto wanted = request.axes.size() > 3 ? std::array<std::size_t, 3>{} : sides_of(request);
  const std::array<std::size_t, 3> found{texture.width, texture.height, texture.depth};
  // A side of one texel is none.
  const bool fits = std::ranges::equal(
      found, wanted, {}, [](std::size_t n) { return std::max<std::size_t>(n, 1); },
      [](std::size_t n) { return std::max<std::size_t>(n, 1); });
  if (!fits) {
    std::vector<std::string> counts;
    for (auto axis = request.axes.rbegin(); axis != request.axes.rend(); ++axis)
      counts.push_back(std::to_string(axis->count));
    file.refuse(fmt::format("is a texture of {} x {} x {} texels; the axes ask for {}", texture.width, texture.height,
                            texture.depth, fmt::join(counts, " x ")));
  }
  const std::size_t taken = std::min(columns, texture.channels);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < texture.values.size(); ++i) {
    if (i % texture.channels < taken) numbers.push_back(texture.values[i]);
  }
  return numbers;
}

}  // namespace

std::vector<std::string_view> lut_format_names() {
  return {kNames.begin(), kNames.end()};
}

LutFormat parse_lut_format(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) {
    throw ArgumentError(fmt::format("unknown format '{}'{}", excerpt(name), did_you_mean(name, kNames)));
  }
  return static_cast<LutFormat>(found - kNames.begin());
}

LutFormat lut_format_of(const std::filesystem::path& path) {
  const auto found = std::ranges::find(kFormats, lowercase(path.extension().string()), &FormatRow::ending);
  if (found == kFormats.end()) {
    std::vector<std::string_view> endings;
    for (const FormatRow& row : kFormats) endings.push_back(row.ending);
    throw ArgumentError(fmt::format("no format of lookup tables has the ending '{}'; expected one of {}",
                                    excerpt(path.extension().string()), fmt::join(endings, ", ")));
  }
  return static_cast<LutFormat>(found - kFormats.begin());
}

Lut as_stored(const Lut& lut, const LutFileOptions& options) {
  check_shape(lut, options);
  Lut stored = lut;
  const Numbers numbers = numbers_of(options);
  if (numbers == Numbers::floats || numbers == Numbers::halves) {
    for (std::size_t i = 0; i < stored.values.size(); ++i) {
      double& value = stored.values[i];
      value = numbers == Numbers::halves ? rounded_to_half(value) : static_cast<double>(static_cast<float>(value));
      if (std::isfinite(value)) continue;
      refuse(options, fmt::format("holds no number as large as {:.6g}", lut.values[i]),
             fmt::format("{} or another format", numbers == Numbers::halves ? "32 bits," : "csv,"));
    }
  }
  if (numbers != Numbers::levels) return stored;
  const double levels = levels_of(bits_of(options));
  for (std::size_t i = 0; i < stored.values.size(); ++i) {
    double& value = stored.values[i];
    const double level = std::round(value * levels);
    // A value of 1 that is off by its error is still one.
    const double allowed = lut.errors.empty() ? 0 : lut.errors[i];
    if (!(value >= -allowed - 0.5 / levels && value <= 1 + allowed + 0.5 / levels)) {
      refuse(options,
             fmt::format("holds values from 0 to 1, and {} is {:.6g}", lut.columns[i % lut.columns.size()], value),
             "another format");
    }
    value = std::clamp(level, 0.0, levels) / levels;
  }
  return stored;
}

std::string lut_file(const Lut& stored, const std::optional<LutErrors>& errors, const LutFileOptions& options) {
  check_shape(stored, options);
  const auto lines = header(stored, errors, options);
  switch (options.format) {
    case LutFormat::csv:
      return csv(stored, lines);
    case LutFormat::npy:
      return npy_content(shape_of(stored), stored.values);
    case LutFormat::c:
      return c_header(stored, lines, options.name);
    case LutFormat::glsl:
      return glsl(stored, lines, options.name);
    case LutFormat::png:
      return png(stored, lines, bits_of(options));
    case LutFormat::hdf5:
      return lut_hdf5(stored, errors, lines);
    case LutFormat::exr:
      return exr(stored, lines, bits_of(options));
    case LutFormat::ktx2:
      return ktx2(stored, lines, options);
    case LutFormat::spi1d:
      return spi1d(stored, lines);
  }
  return {};
}

Lut read_lut(const std::filesystem::path& path, const LutRequest& request) {
  Lut lut{.request = request, .columns = lut_columns(request), .values = {}, .errors = {}};
  const FileBytes file = FileBytes::read(path);
  switch (lut_format_of(path)) {
    case LutFormat::csv:
      lut.values = csv_numbers(file, lut);
      break;
    case LutFormat::npy:
      lut.values = npy_numbers(file, request, lut.columns.size());
      break;
    case LutFormat::png:
      lut.values = png_numbers(file, request, lut.columns.size());
      break;
    case LutFormat::spi1d:
      lut.values = spi1d_numbers(file);
      break;
    case LutFormat::hdf5:
      lut.values = read_lut_hdf5(path, request, lut.columns);
      break;
    case LutFormat::exr:
      lut.values = exr_numbers(file, request, lut.columns);
      break;
    case LutFormat::ktx2:
      lut.values = ktx2_numbers(file, request, lut.columns.size());
      break;
    case LutFormat::c:
    case LutFormat::glsl:
      lut.values = array_numbers(file);
  }
  const LutFormat format = lut_format_of(path);
  if (format == LutFormat::c || format == LutFormat::glsl || format == LutFormat::spi1d) {
    for (double& value : lut.values) value = static_cast<double>(static_cast<float>(value));
  }
  const std::size_t wanted = lut.entries() * lut.columns.size();
  if (lut.values.size() == lut.entries() && lut.columns.size() > 1) lut.columns.resize(1);
  if (lut.values.size() != lut.entries() * lut.columns.size()) {
    file.refuse(fmt::format("holds {} numbers; the axes ask for {}", lut.values.size(), wanted));
  }
  if (!std::ranges::all_of(lut.values, [](double value) { return std::isfinite(value); })) {
    file.refuse("holds values that are no finite numbers");
  }
  return lut;
}

}  // namespace lobe
