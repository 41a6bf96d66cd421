#include "formats/pair_list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

#include "core/text.hpp"
#include "formats/npy.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kQuoted = 40;  // characters of a cell that complaints show
constexpr double kVertical = 90;
constexpr std::string_view kNpyMark = "\x93NUMPY";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

enum Role : std::size_t { theta_in, phi_in, theta_out, phi_out, delta_phi, x_in, y_in, z_in, x_out, y_out, z_out };
constexpr std::array<std::string_view, PairList::kRoles> kNames{
    "theta_in", "phi_in", "theta_out", "phi_out", "delta_phi", "x_in", "y_in", "z_in", "x_out", "y_out", "z_out"};
constexpr std::string_view kExpected =
    "expected the columns theta_in, theta_out, delta_phi (and phi_in), or theta_in, phi_in, theta_out, phi_out, or "
    "x_in, "
    "y_in, z_in, x_out, y_out, z_out";
constexpr std::array<Role, 3> kThree{theta_in, theta_out, delta_phi};
constexpr std::array<Role, 4> kThreeAndAzimuth{theta_in, theta_out, delta_phi, phi_in};
constexpr std::array<Role, 4> kFour{theta_in, phi_in, theta_out, phi_out};
constexpr std::array<Role, 6> kVectors{x_in, y_in, z_in, x_out, y_out, z_out};
constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

bool is_angle(std::size_t role) {
  return role < x_in;
}

/// A column's name without its unit, and the radians of 1 in that; 0 where it has none.
struct Heading {
  std::string name;
  double unit = 0;
};

Heading heading_of(std::string_view cell) {
  std::string name = lowercase(trim(cell));
  if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  for (const auto& [mark, unit] : {std::pair(std::string_view("deg"), kDegree), {"rad", 1.0}}) {
    if (name.size() <= mark.size() + 1 || !name.ends_with(mark)) continue;
    const char before = name[name.size() - mark.size() - 1];
    if (before == '_' || before == '/') return {name.substr(0, name.size() - mark.size() - 1), unit};
  }
  return {name, 0};
}

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// Cuts the next cell off a row, with the separator behind it.
/// \param separator a blank: any number of blanks and tabs
/// \param has_more whether another cell follows, empty or not
std::string_view take_cell(std::string_view& row, char separator, bool& has_more) {
  const std::size_t size = row.size();
  std::size_t begin = 0;
  while (begin < size && is_blank(row[begin])) ++begin;
  std::size_t end = begin;
  while (end < size && row[end] != separator && !(separator == ' ' && row[end] == '\t')) ++end;
  std::size_t next = end + (end < size ? 1 : 0);
  if (separator == ' ') {
    while (next < size && is_blank(row[next])) ++next;
  }
  std::string_view cell = row.substr(begin, end - begin);
  row.remove_prefix(next);
  has_more = separator == ' ' ? !row.empty() : end < size;
  while (!cell.empty() && is_blank(cell.back())) cell.remove_suffix(1);
  return cell;
}

std::vector<std::string_view> cells_of(std::string_view row, char separator) {
  std::vector<std::string_view> cells;
  for (bool has_more = true; has_more;) cells.push_back(take_cell(row, separator, has_more));
  return cells;
}

/// The line from an offset on, without its end; the offset goes behind it.
std::string_view take_line(std::string_view content, std::size_t& offset) {
  const char* begin = content.data() + offset;
  const auto* end = static_cast<const char*>(std::memchr(begin, '\n', content.size() - offset));
  std::string_view line(begin, end == nullptr ? content.size() - offset : static_cast<std::size_t>(end - begin));
  offset += std::min(line.size() + 1, content.size() - offset);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// Neither blank nor a comment.
bool is_row(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] != '#';
}

char separator_of(std::string_view line) {
  for (const char mark : {',', ';', '\t'}) {
    if (line.find(mark) != std::string_view::npos) return mark;
  }
  return ' ';
}

}  // namespace

PairList::PairList(const std::filesystem::path& path, bool radians)
    : file_(FileBytes::read(path)), is_array_(file_.content().starts_with(kNpyMark)) {
  where_.fill(kNowhere);
  if (is_array_) {
    read_array(radians);
  } else {
    read_text(radians);
  }
  if (size_ == 0) file_.refuse(fmt::format("no pairs of directions; {}", kExpected));
}

void PairList::read_array(bool radians) {
  const NpyHeader header = read_npy_header(file_);
  if (header.rank() != 2) {
    file_.refuse(
        fmt::format("an array of {} dimensions; expected 2, a row for each pair of directions", header.rank()));
  }
  size_ = header.shape.front();
  assume_columns(header.shape.back(), 0, radians);
  if (header.kind == 'f' && header.width == sizeof(double) && !header.is_by_columns) {
    numbers_at_ = header.offset;
  } else {
    values_ = read_npy(file_).values;
  }
  for (std::size_t first = 0; first < size_; first += kBlock) blocks_.push_back({.first = first});
}

void PairList::read_text(bool radians) {
  const std::string_view content = file_.content();
  std::size_t offset = content.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  std::size_t line = 0;
  while (offset < content.size()) {
    const std::size_t begin = offset;
    const std::string_view text = take_line(content, offset);
    ++line;
    if (!is_row(text)) continue;
    separator_ = separator_of(text);
    const auto cells = cells_of(text, separator_);
    double ignored = 0;
    // Something that is nearly a number is a wrong row, not a name.
    const std::string_view first = cells.front();
    const bool is_number = parse_number(first, ignored) || lowercase(first) == "nan" || lowercase(first) == "inf";
    if (is_number) {
      assume_columns(cells.size(), line, radians);
      place_blocks(begin, line);
    } else {
      read_names(cells, line, radians);
      place_blocks(offset, line + 1);
    }
    break;
  }
}

void PairList::add_column(std::size_t role, std::size_t place, double unit) {
  where_[role] = places_.size();
  units_[role] = unit;
  places_.push_back(place);
  names_.push_back(std::string(kNames[role]) + (!is_angle(role) ? "" : unit == 1 ? "_rad" : "_deg"));
}

void PairList::assume_columns(std::size_t count, std::size_t line, bool radians) {
  cells_ = count;
  const double unit = radians ? 1 : kDegree;
  const auto assume = [&](std::span<const Role> roles) {
    for (const Role role : roles) add_column(role, places_.size(), unit);
  };
  if (count == kThree.size()) {
    assume(kThree);
  } else if (count == kFour.size()) {
    assume(kFour);
  } else if (count == kVectors.size()) {
    assume(kVectors);
  } else {
    const std::string complaint = fmt::format(
        "{} columns without names; expected 3 (theta_in, theta_out, delta_phi), 4 (theta_in, phi_in, theta_out, "
        "phi_out) or 6 (two vectors)",
        count);
    if (is_array_) file_.refuse(complaint);
    file_.refuse_line(line, complaint);
  }
  is_vectors_ = count == kVectors.size();
  lacks_unit_ = !is_vectors_ && !radians;
}

void PairList::read_names(std::span<const std::string_view> cells, std::size_t line, bool radians) {
  cells_ = cells.size();
  std::array<std::size_t, kRoles> given{};
  given.fill(kNowhere);
  std::array<double, kRoles> units{};
  for (std::size_t place = 0; place < cells.size(); ++place) {
    const Heading heading = heading_of(cells[place]);
    const auto* found = std::ranges::find(kNames, heading.name);
    if (found == kNames.end()) {
      const std::string near = nearest_word(heading.name, kNames);
      if (near.empty()) continue;
      file_.refuse_line(line, fmt::format("unknown column '{}'; did you mean '{}'?", heading.name, near));
    }
    const auto role = static_cast<std::size_t>(found - kNames.begin());
    if (given[role] != kNowhere) {
      file_.refuse_line(line, fmt::format("column '{}' is there twice; expected it once", *found));
    }
    given[role] = place;
    units[role] = heading.unit;
  }
  const auto has = [&](std::span<const Role> roles) {
    const auto count = std::ranges::count_if(given, [](std::size_t place) { return place != kNowhere; });
    return static_cast<std::size_t>(count) == roles.size() &&
           std::ranges::all_of(roles, [&](Role role) { return given[role] != kNowhere; });
  };
  is_vectors_ = has(kVectors);
  if (!is_vectors_ && !has(kThree) && !has(kThreeAndAzimuth) && !has(kFour)) {
    std::vector<std::string_view> shown;
    for (const auto cell : cells.first(std::min<std::size_t>(cells.size(), 8)))
      shown.push_back(cell.substr(0, kQuoted));
    file_.refuse_line(line,
                      fmt::format("the columns {} are no pairs of directions; {}", fmt::join(shown, ", "), kExpected));
  }
  for (std::size_t place = 0; place < cells.size(); ++place) {
    const auto* found = std::ranges::find(given, place);
    if (found == given.end()) continue;
    const auto role = static_cast<std::size_t>(found - given.begin());
    const double unit = units[role];
    if (is_angle(role) && unit == kDegree && radians) {
      throw ArgumentError(fmt::format("the column '{}' of {} is in degrees; expected no other unit", cells[place],
                                      file_.path().string()));
    }
    lacks_unit_ = lacks_unit_ || (is_angle(role) && unit == 0 && !radians);
    add_column(role, place, unit != 0 ? unit : radians ? 1 : kDegree);
  }
}

void PairList::place_blocks(std::size_t offset, std::size_t line) {
  const std::string_view content = file_.content();
  while (offset < content.size()) {
    const std::size_t begin = offset;
    if (is_row(take_line(content, offset))) {
      if (size_ % kBlock == 0) blocks_.push_back({begin, line, size_});
      ++size_;
    }
    ++line;
  }
}

void PairList::read(std::size_t index, PairBlock& block) const {
  const auto [begin, first_line, first] = blocks_.at(index);
  const std::size_t rows = std::min(kBlock, size_ - first);
  block.numbers.clear();
  block.numbers.reserve(rows * places_.size());
  block.directions.clear();
  block.directions.reserve(rows);
  block.largest_angle = 0;
  if (is_array_) {
    std::array<double, kRoles> numbers{};
    const std::span<const double> row_numbers = std::span(numbers).first(places_.size());
    for (std::size_t row = first; row < first + rows; ++row) {
      const std::size_t at = row * places_.size();
      if (numbers_at_ > 0) {
        std::memcpy(numbers.data(), file_.content().data() + numbers_at_ + at * sizeof(double),
                    row_numbers.size_bytes());
      } else {
        std::copy_n(values_.data() + at, places_.size(), numbers.begin());
      }
      add_row(row_numbers, row + 1, block);
    }
    return;
  }
  std::size_t offset = begin;
  for (std::size_t line = first_line; block.directions.size() < rows; ++line) {
    const std::string_view text = take_line(file_.content(), offset);
    if (is_row(text)) add_row(text, line, block);
  }
}

void PairList::add_row(std::string_view text, std::size_t line, PairBlock& block) const {
  constexpr std::size_t kMost = 6;
  std::array<double, kMost> numbers{};
  std::string_view rest = text;
  std::size_t found = 0;
  bool has_more = true;
  for (std::size_t place = 0; place < cells_ && has_more; ++place) {
    const std::string_view cell = take_cell(rest, separator_, has_more);
    const auto column = static_cast<std::size_t>(std::ranges::find(places_, place) - places_.begin());
    if (column == places_.size()) continue;
    if (!parse_number(cell, numbers.at(column))) {
      file_.refuse_line(line, fmt::format("'{}' in column {} is no finite number; expected one",
                                          cell.substr(0, kQuoted), names_[column]));
    }
    ++found;
  }
  if (found < places_.size() || has_more) {
    file_.refuse_line(line, fmt::format("{} columns; expected {}", cells_of(text, separator_).size(), cells_));
  }
  add_row(std::span(numbers).first(places_.size()), line, block);
}

void PairList::add_row(std::span<const double> numbers, std::size_t row, PairBlock& block) const {
  for (std::size_t column = 0; column < numbers.size(); ++column) {
    if (std::isfinite(numbers[column])) continue;
    refuse(row, fmt::format("{} in column {} is no finite number; expected one", numbers[column], names_[column]));
  }
  block.directions.push_back(directions_of(numbers, row));
  block.numbers.insert(block.numbers.end(), numbers.begin(), numbers.end());
  if (is_vectors_) return;
  for (const double angle : numbers) block.largest_angle = std::max(block.largest_angle, std::abs(angle));
}

void PairList::refuse(std::size_t row, std::string_view complaint) const {
  if (!is_array_) file_.refuse_line(row, complaint);
  file_.refuse(fmt::format("row {}: {}", row, complaint));
}

Directions PairList::directions_of(std::span<const double> numbers, std::size_t row) const {
  const auto angle = [&](Role role) { return numbers[where_[role]] * units_[role]; };
  const auto polar = [&](Role role) {
    const double given = numbers[where_[role]];
    const double top = units_[role] == 1 ? std::numbers::pi / 2 : kVertical;
    if (given >= 0 && given <= top) return std::min(given * units_[role], std::numbers::pi / 2);
    const std::string_view range = units_[role] == 1 ? "0 to pi/2 radians" : "0 to 90 degrees";
    refuse(row, fmt::format("{} is {}{}; expected {}", kNames[role], shortest(given),
                            given > top ? ", below the horizon" : "", range));
  };
  const auto vector = [&](Role x, Role y, Role z) {
    const std::array<double, 3> v{numbers[where_[x]], numbers[where_[y]], numbers[where_[z]]};
    const double across = std::hypot(v[0], v[1]);
    if (!(v[2] >= 0) || (across == 0 && v[2] == 0)) {
      refuse(row, fmt::format("the vector ({}) of {} {}; expected z above 0", fmt::join(v, ", "),
                              x == x_in ? "x_in, y_in, z_in" : "x_out, y_out, z_out",
                              v[2] < 0 ? "is below the horizon" : "has no length"));
    }
    return Direction{std::atan2(across, v[2]), across == 0 ? 0 : std::atan2(v[1], v[0])};
  };
  if (is_vectors_) {
    const Direction in = vector(x_in, y_in, z_in);
    const Direction out = vector(x_out, y_out, z_out);
    return {in.theta, out.theta, out.phi - in.phi, in.phi};
  }
  const double azimuth = where_[phi_in] == kNowhere ? 0 : angle(phi_in);
  const double difference = where_[delta_phi] == kNowhere ? angle(phi_out) - azimuth : angle(delta_phi);
  return {polar(theta_in), polar(theta_out), difference, azimuth};
}

}  // namespace lobe
