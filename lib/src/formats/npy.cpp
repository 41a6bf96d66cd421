// Arrays of NumPy. Source: numpy.lib.format (NEP 1), versions 1.0 to 3.0.
#include "formats/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

#include "formats/byte_reader.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMostDimensions = 32;  // as NumPy
constexpr std::size_t kQuoted = 40;          // characters of the file that complaints show

/// The literal of a dictionary that stands in the header: {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }.
class HeaderParser {
 public:
  HeaderParser(const FileBytes& file, std::size_t offset, std::string_view text, bool wants_texts)
      : file_(file), offset_(offset), text_(text), wants_texts_(wants_texts) {}

  void parse(NpyHeader& header) {
    expect('{');
    bool has_descr = false;
    bool has_order = false;
    bool has_shape = false;
    while (!accept('}')) {
      const std::string_view key = string();
      expect(':');
      if (key == "descr") {
        once(has_descr, key);
        read_descr(header);
      } else if (key == "fortran_order") {
        once(has_order, key);
        header.is_by_columns = boolean();
      } else if (key == "shape") {
        once(has_shape, key);
        header.shape = tuple();
      } else {
        refuse(fmt::format("unknown key '{}'; expected descr, fortran_order and shape", key.substr(0, kQuoted)));
      }
      if (accept('}')) break;
      expect(',');
    }
    skip_blanks();
    if (at_ < text_.size()) refuse("something after the dictionary");
    if (!has_descr || !has_order || !has_shape) refuse("descr, fortran_order or shape is missing");
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  [[nodiscard]] bool accept(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) refuse(fmt::format("expected '{}' in the header of an array", c));
  }
  void once(bool& seen, std::string_view key) {
    if (seen) refuse(fmt::format("a second {}", key));
    seen = true;
  }

  std::string_view string() {
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '\'' && quote != '"') refuse("expected a text in quotes in the header of an array");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == text_.npos) refuse("a quote that does not end");
    const std::string_view found = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return found;
  }

  bool boolean() {
    skip_blanks();
    for (const auto& [word, value] : {std::pair{std::string_view("True"), true}, {std::string_view("False"), false}}) {
      if (!text_.substr(at_).starts_with(word)) continue;
      at_ += word.size();
      return value;
    }
    refuse("fortran_order is neither True nor False");
  }

  std::vector<std::size_t> tuple() {
    expect('(');
    std::vector<std::size_t> lengths;
    while (!accept(')')) {
      skip_blanks();
      std::size_t length = 0;
      const char* const begin = text_.data() + at_;
      const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), length);
      if (error != std::errc()) refuse("shape is no tuple of lengths");
      if (lengths.size() == kMostDimensions) refuse(fmt::format("more than {} dimensions", kMostDimensions));
      at_ += static_cast<std::size_t>(end - begin);
      lengths.push_back(length);
      if (accept(')')) {
        if (lengths.size() == 1) refuse("shape is no tuple: a comma is missing");
        break;
      }
      expect(',');
    }
    return lengths;
  }

  void read_descr(NpyHeader& header) {
    skip_blanks();
    if (at_ < text_.size() && text_[at_] == '[') refuse("it is a structured array; expected numbers");
    const std::string_view descr = string();
    const auto complain = [&] {
      refuse(fmt::format("numbers of type '{}'; expected '<f8', '<f4' or integers, little-endian",
                         descr.substr(0, kQuoted)));
    };
    if (wants_texts_) return read_text_descr(header, descr);
    if (descr.size() != 3) complain();
    header.kind = descr[1];
    header.width = static_cast<std::size_t>(descr[2] - '0');
    const bool is_float = header.kind == 'f' && (header.width == 4 || header.width == 8);
    const bool is_integer = (header.kind == 'i' || header.kind == 'u') &&
                            (header.width == 1 || header.width == 2 || header.width == 4 || header.width == 8);
    const bool is_ordered = descr[0] == '<' || (descr[0] == '|' && header.width == 1);
    if (!(is_float || is_integer) || !is_ordered) complain();
  }

  /// '<U5': five characters of four bytes each.
  void read_text_descr(NpyHeader& header, std::string_view descr) const {
    constexpr std::size_t kLongest = 1000;
    std::size_t length = 0;
    const char* const end = descr.data() + descr.size();
    const bool is_text = descr.starts_with("<U") && std::from_chars(descr.data() + 2, end, length).ptr == end;
    if (!is_text || length == 0 || length > kLongest) {
      refuse(fmt::format("elements of type '{}'; expected texts ('<U...')", descr.substr(0, kQuoted)));
    }
    header.kind = 'U';
    header.width = length * sizeof(char32_t);
  }

  [[noreturn]] void refuse(std::string_view complaint) const { file_.refuse_at(offset_ + at_, complaint); }

  const FileBytes& file_;
  std::size_t offset_;
  std::string_view text_;
  bool wants_texts_;
  std::size_t at_ = 0;
};

template <typename Number>
void convert(std::string_view bytes, std::vector<double>& values) {
  static_assert(std::endian::native == std::endian::little);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(number_at<Number>(bytes, i * sizeof(Number)));
  }
}

void convert(const NpyHeader& header, std::string_view bytes, std::vector<double>& values) {
  if (header.kind == 'f') return header.width == 8 ? convert<double>(bytes, values) : convert<float>(bytes, values);
  const bool is_signed = header.kind == 'i';
  switch (header.width) {
    case 1:
      return is_signed ? convert<std::int8_t>(bytes, values) : convert<std::uint8_t>(bytes, values);
    case 2:
      return is_signed ? convert<std::int16_t>(bytes, values) : convert<std::uint16_t>(bytes, values);
    case 4:
      return is_signed ? convert<std::int32_t>(bytes, values) : convert<std::uint32_t>(bytes, values);
    default:
      return is_signed ? convert<std::int64_t>(bytes, values) : convert<std::uint64_t>(bytes, values);
  }
}

/// Numbers with the first index the quickest, to the last one.
std::vector<double> by_rows(const std::vector<std::size_t>& shape, const std::vector<double>& values) {
  std::vector<double> result(values.size());
  std::vector<std::size_t> index(shape.size(), 0);
  std::vector<std::size_t> stride(shape.size(), 1);
  for (std::size_t d = 1; d < shape.size(); ++d) stride[d] = stride[d - 1] * shape[d - 1];
  std::size_t from = 0;
  for (double& value : result) {
    value = values[from];
    for (std::size_t d = shape.size(); d-- > 0;) {
      from += stride[d];
      if (++index[d] < shape[d]) break;
      from -= stride[d] * shape[d];
      index[d] = 0;
    }
  }
  return result;
}

/// The product of lengths; nothing where it is beyond `most`. A length of 0 makes it 0.
bool product_of(std::span<const std::size_t> shape, std::size_t most, std::size_t& product) {
  product = 1;
  if (std::ranges::find(shape, std::size_t{0}) != shape.end()) product = 0;
  for (const std::size_t length : shape) {
    if (product > 0 && length > most / product) return false;
    product *= length;
  }
  return product <= most;
}

NpyHeader read_header(const FileBytes& file, bool wants_texts) {
  ByteReader bytes(file);
  if (bytes.bytes(kMagic.size(), "the mark of an array of NumPy") != kMagic) {
    file.refuse_at(0, "it is no array of NumPy (.npy)");
  }
  const auto major = bytes.read<std::uint8_t>("the version");
  const auto minor = bytes.read<std::uint8_t>("the version");
  if (major < 1 || major > 3 || minor != 0) {
    file.refuse_at(kMagic.size(), fmt::format("version {}.{} of .npy; expected 1.0, 2.0 or 3.0", major, minor));
  }
  const std::size_t length = major == 1 ? bytes.read<std::uint16_t>("the length of the header")
                                        : bytes.read<std::uint32_t>("the length of the header");
  const std::size_t begin = bytes.offset();
  NpyHeader header;
  HeaderParser(file, begin, bytes.bytes(length, "the header"), wants_texts).parse(header);
  header.offset = bytes.offset();
  const std::size_t there = bytes.remaining() / header.width;
  std::size_t count = 0;
  if (!product_of(header.shape, there, count)) {
    file.refuse_at(header.offset, fmt::format("the shape {} asks for more than the {} numbers that are there",
                                              fmt::join(header.shape, " x "), there));
  }
  if (count * header.width != bytes.remaining()) {
    file.refuse_at(header.offset + count * header.width, "the file goes on after the last number");
  }
  return header;
}

/// A character as UTF-8; what is none becomes a question mark.
void append_utf8(std::string& text, std::uint32_t c) {
  const auto low = [](std::uint32_t bits) { return static_cast<char>(0x80 | (bits & 0x3f)); };
  if (c > 0x10ffff || (c >= 0xd800 && c < 0xe000)) c = '?';
  if (c < 0x80) {
    text += static_cast<char>(c);
  } else if (c < 0x800) {
    text += {static_cast<char>(0xc0 | c >> 6), low(c)};
  } else if (c < 0x10000) {
    text += {static_cast<char>(0xe0 | c >> 12), low(c >> 6), low(c)};
  } else {
    text += {static_cast<char>(0xf0 | c >> 18), low(c >> 12), low(c >> 6), low(c)};
  }
}

}  // namespace

std::size_t NpyHeader::count() const {
  std::size_t product = 1;
  for (const std::size_t length : shape) product *= length;
  return product;
}

NpyHeader read_npy_header(const FileBytes& file) {
  return read_header(file, false);
}

std::vector<std::string> read_npy_texts(const FileBytes& file) {
  const NpyHeader header = read_header(file, true);
  std::vector<std::string> texts(header.count());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    for (std::size_t at = 0; at < header.width; at += sizeof(char32_t)) {
      const auto c = number_at<std::uint32_t>(file.content(), header.offset + i * header.width + at);
      if (c == 0) break;
      append_utf8(texts[i], c);
    }
  }
  return texts;
}

NpyArray read_npy(const FileBytes& file) {
  const NpyHeader header = read_npy_header(file);
  NpyArray array{header.shape, std::vector<double>(header.count())};
  convert(header, file.content().substr(header.offset), array.values);
  if (header.is_by_columns && header.rank() > 1) array.values = by_rows(array.shape, array.values);
  return array;
}

std::string npy_header(std::span<const std::size_t> shape) {
  constexpr std::size_t kAlignment = 64;
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}{}), }}",
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  const std::size_t before = kMagic.size() + 2 + sizeof(std::uint16_t);
  header.append(kAlignment - 1 - (before + header.size()) % kAlignment, ' ');
  header += '\n';
  if (header.size() > std::numeric_limits<std::uint16_t>::max()) throw ArgumentError("an array of too many dimensions");
  std::string content(kMagic);
  content += {'\1', '\0', static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)};
  return content + header;
}

std::string npy_content(std::span<const std::size_t> shape, std::span<const double> values) {
  std::size_t count = 0;
  if (!product_of(shape, values.size(), count) || count != values.size()) {
    throw ArgumentError(fmt::format("{} numbers for an array of {}; expected as many as its shape says", values.size(),
                                    fmt::join(shape, " x ")));
  }
  std::string content = npy_header(shape);
  const std::size_t offset = content.size();
  content.resize(offset + values.size_bytes());
  if (!values.empty()) std::memcpy(content.data() + offset, values.data(), values.size_bytes());
  return content;
}

}  // namespace lobe
