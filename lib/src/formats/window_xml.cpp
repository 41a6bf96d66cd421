#include "formats/window_xml.hpp"

#include <expat.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <iterator>
#include <memory>
#include <new>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20;  // bytes that the parser gets at a time
constexpr std::size_t kLongestMark = 2 * kChunk;
constexpr std::size_t kDeepest = 32;       // elements within each other
constexpr std::size_t kLongestText = 256;  // of names
constexpr std::size_t kLongestWord = 64;   // of matrices
constexpr std::size_t kMostBlocks = 1024;
constexpr std::size_t kMostRings = 64;
constexpr std::string_view kSeparators = " \t\r\n,";

// Expat 2.9 wants the names with 64 bits, which earlier ones lack.
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
std::int64_t byte_index(XML_Parser parser) {
  return XML_GetCurrentByteIndex64(parser);
}
std::size_t line_number(XML_Parser parser) {
  return XML_GetCurrentLineNumber64(parser);
}
#else
std::int64_t byte_index(XML_Parser parser) {
  return XML_GetCurrentByteIndex(parser);
}
std::size_t line_number(XML_Parser parser) {
  return XML_GetCurrentLineNumber(parser);
}
#endif

/// Without blanks at the ends, and with single ones between words.
std::string collapsed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  std::string result;
  for (text = trim(text); !text.empty(); text = trim(text)) {
    const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
    if (!result.empty()) result += ' ';
    result += text.substr(0, end);
    text.remove_prefix(end);
  }
  return result;
}

/// Whether a word is 0, however it is written.
bool is_zero(std::string_view word) {
  const std::string_view mantissa = word.substr(0, word.find_first_of("eE"));
  return !mantissa.empty() && mantissa.find_first_not_of("+-.0") == mantissa.npos;
}

bool is_utf16(std::string_view content) {
  return content.starts_with("\xFF\xFE") || content.starts_with("\xFE\xFF");
}

/// Files of genBSDF may begin with a line of its own, "Recover using: ...".
std::size_t begin_of_xml(std::string_view content) {
  return is_utf16(content) ? 0 : std::min(content.find('<'), content.size());
}

/// Cuts texts that come in pieces into words and braces.
class WordCutter {
 public:
  /// False for a word that is too long for a number.
  template <typename Take>
  [[nodiscard]] bool cut(std::string_view text, const Take& take) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n,{}"), text.size());
      if (begun_.size() + end > kLongestWord) return false;
      if (end == text.size()) {
        begun_ += text;
        return true;
      }
      if (begun_.empty()) {
        if (end > 0) take(text.substr(0, end));
      } else {
        begun_ += text.substr(0, end);
        finish(take);
      }
      if (text[end] == '{' || text[end] == '}') take(text.substr(end, 1));
      text.remove_prefix(std::min(text.find_first_not_of(kSeparators, end + 1), text.size()));
    }
    return true;
  }

  template <typename Take>
  void finish(const Take& take) {
    if (!begun_.empty()) take(std::string_view(begun_));
    begun_.clear();
  }

 private:
  std::string begun_;
};

/// Reads a file by expat and passes on what it finds. Exceptions of the functions below end the reading.
class XmlReader {
 public:
  explicit XmlReader(const FileBytes& file) : file_(file), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    if (!parser_) throw std::bad_alloc();
    const std::string_view before = file.content().substr(0, begin_of_xml(file.content()));
    lines_before_ = static_cast<std::size_t>(std::ranges::count(before, '\n'));
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), &XmlReader::on_start, &XmlReader::on_end);
    XML_SetCharacterDataHandler(parser_.get(), &XmlReader::on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), &XmlReader::on_doctype);
  }
  XmlReader(const XmlReader&) = delete;
  XmlReader& operator=(const XmlReader&) = delete;
  virtual ~XmlReader() = default;

  void read() {
    std::string_view rest = file_.content().substr(begin_of_xml(file_.content()));
    do {
      const std::string_view chunk = rest.substr(0, kChunk);
      rest.remove_prefix(chunk.size());
      const auto status = XML_Parse(parser_.get(), chunk.data(), static_cast<int>(chunk.size()), rest.empty());
      if (error_) std::rethrow_exception(error_);
      if (status != XML_STATUS_OK) {
        refuse(fmt::format("it is no well-formed XML: {}", XML_ErrorString(XML_GetErrorCode(parser_.get()))));
      }
      // Expat looks at an unfinished mark again with every chunk.
      const auto done = byte_index(parser_.get());
      const auto given = static_cast<std::int64_t>(file_.size() - rest.size());
      if (given - done > static_cast<std::int64_t>(kLongestMark)) refuse("a mark of more than two megabytes");
    } while (!rest.empty());
  }

 protected:
  virtual void start(std::string_view name, const XML_Char** attributes) = 0;
  virtual void end(std::string_view name) = 0;
  virtual void text(std::string_view text) = 0;

  /// The n-th element from the innermost one on; empty beyond the root.
  [[nodiscard]] std::string_view enclosing(std::size_t n) const {
    return n < path_.size() ? std::string_view(path_[path_.size() - 1 - n]) : std::string_view();
  }
  /// Whether the innermost element holds the numbers of a block.
  [[nodiscard]] bool is_in_data() const {
    return enclosing(0) == "ScatteringData" && enclosing(1) == "WavelengthDataBlock";
  }
  [[nodiscard]] std::size_t line() const { return lines_before_ + line_number(parser_.get()); }
  [[nodiscard]] const FileBytes& file() const { return file_; }
  [[noreturn]] void refuse(std::string_view complaint) const { file_.refuse_line(line(), complaint); }

 private:
  /// Exceptions must not pass through expat.
  template <typename Work>
  static void guarded(void* self, const Work& work) {
    auto& reader = *static_cast<XmlReader*>(self);
    if (reader.error_) return;
    try {
      work(reader);
    } catch (...) {
      reader.error_ = std::current_exception();
      (void)XML_StopParser(reader.parser_.get(), XML_FALSE);
    }
  }

  static void on_start(void* self, const XML_Char* full_name, const XML_Char** attributes) {
    guarded(self, [&](XmlReader& reader) {
      const std::string_view name = local(full_name);
      if (reader.path_.size() == kDeepest) reader.refuse(fmt::format("more than {} elements in each other", kDeepest));
      if (name.size() > kLongestText) reader.refuse("an element's name is too long");
      if (reader.path_.empty() && name != "WindowElement") {
        reader.refuse(fmt::format("the root is '{}'; expected WindowElement", name));
      }
      reader.path_.emplace_back(name);
      reader.start(name, attributes);
    });
  }

  static void on_end(void* self, const XML_Char* full_name) {
    guarded(self, [&](XmlReader& reader) {
      reader.end(local(full_name));
      reader.path_.pop_back();
    });
  }

  static void on_text(void* self, const XML_Char* text, int length) {
    guarded(self, [&](XmlReader& reader) { reader.text({text, static_cast<std::size_t>(length)}); });
  }

  static void on_doctype(void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    guarded(self, [](XmlReader& reader) { reader.refuse("it has a document type (DOCTYPE); expected none"); });
  }

  /// Without the prefix of a name space.
  static std::string_view local(std::string_view name) {
    return name.substr(name.rfind(':') == name.npos ? 0 : name.rfind(':') + 1);
  }

  const FileBytes& file_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::size_t lines_before_ = 0;
  std::vector<std::string> path_;
  std::exception_ptr error_;
};

/// Everything but the numbers.
class OutlineReader final : public XmlReader {
 public:
  using XmlReader::XmlReader;

  [[nodiscard]] WindowXml outline() {
    read();
    if (xml_.structure_line == 0) xml_.structure_line = line();
    return std::move(xml_);
  }

 private:
  void start(std::string_view name, const XML_Char** attributes) override {
    if (is_counting_) refuse("an element within ScatteringData");
    text_.clear();
    is_counting_ = is_in_data();
    if (is_counting_) begin_data();
    if (name == "Layer" && enclosing(1) == "Optical" && ++layers_ > 1) refuse("a second Layer; expected one");
    if (name == "Wavelength" && enclosing(1) == "WavelengthData") unit_ = attribute(attributes, "unit");
    if (name == "WavelengthData") begin_band();
    if (name == "WavelengthDataBlock") begin_block();
    if (name == "AngleBasis" && enclosing(1) == "DataDefinition") {
      if (xml_.bases.size() == kMostRings) refuse("too many angle bases");
      xml_.bases.push_back({{}, line(), false, {}});
    }
    if (name == "AngleBasisBlock" && is_in_basis(1)) begin_ring();
  }

  void text(std::string_view text) override {
    if (is_counting_) {
      if (!words_.cut(text, [&](std::string_view word) { count(word); })) refuse("a word too long for a number");
      return;
    }
    // Geometries are long, and in no element that counts.
    if (text_.size() < kLongestText) text_ += text.substr(0, kLongestText - text_.size());
  }

  void end(std::string_view name) override {
    if (is_counting_) {
      words_.finish([&](std::string_view word) { count(word); });
      is_counting_ = false;
    }
    const std::string value = collapsed(text_);
    text_.clear();
    const std::string_view parent = enclosing(1);
    if (name == "WavelengthData") return end_band();
    if (parent == "Material" && name == "Name") xml_.material = value;
    if (parent == "Material" && name == "Manufacturer") xml_.manufacturer = value;
    if (parent == "DataDefinition" && name == "IncidentDataStructure") {
      xml_.structure = value;
      xml_.structure_line = line();
    }
    if (parent == "WavelengthData" && name == "Wavelength") band_ = value;
    if (parent == "WavelengthDataBlock") end_of_block(name, value);
    if (is_in_basis(1) || is_in_basis(2) || is_in_basis(3)) end_of_basis(name, value);
  }

  [[nodiscard]] bool is_in_basis(std::size_t n) const {
    return enclosing(n) == "AngleBasis" && enclosing(n + 1) == "DataDefinition";
  }

  static std::string attribute(const XML_Char** attributes, std::string_view name) {
    for (; *attributes != nullptr; attributes += 2) {
      if (*attributes == name) return std::string(std::string_view(attributes[1]).substr(0, kLongestText));
    }
    return {};
  }

  void begin_band() {
    first_of_band_ = xml_.blocks.size();
    band_.clear();
    unit_.clear();
  }

  /// The wavelength may come after its blocks.
  void end_band() {
    double nanometres = 0;
    const bool is_number = parse_number(band_, nanometres) && nanometres > 0;
    for (std::size_t i = first_of_band_; i < xml_.blocks.size(); ++i) {
      xml_.blocks[i].band = band_;
      if (is_number && lowercase(unit_).starts_with("nanomet")) xml_.blocks[i].wavelength = nanometres;
    }
  }

  void begin_block() {
    if (xml_.blocks.size() == kMostBlocks) refuse(fmt::format("more than {} WavelengthDataBlocks", kMostBlocks));
    xml_.blocks.emplace_back();
    xml_.blocks.back().begin = line();
  }

  void begin_data() {
    WindowBlock& block = xml_.blocks.back();
    if (block.line > 0) refuse("a second ScatteringData in the block");
    block.line = line();
  }

  void count(std::string_view word) {
    WindowBlock& block = xml_.blocks.back();
    if (word == "{") {
      ++block.braces;
    } else if (word != "}") {
      ++block.words;
      block.has_values = block.has_values || !is_zero(word);
    }
  }

  void end_of_block(std::string_view name, const std::string& value) {
    WindowBlock& block = xml_.blocks.back();
    if (name == "WavelengthDataDirection") block.direction = value;
    if (name == "ColumnAngleBasis") block.column_basis = value;
    if (name == "RowAngleBasis") block.row_basis = value;
    if (name == "AngleBasis") block.basis = value;
    if (name == "ScatteringDataType") block.type = value;
  }

  void begin_ring() {
    auto& rings = xml_.bases.back().rings;
    // Bases that list their directions one by one are long; that they are such is all that counts.
    if (rings.size() < kMostRings) rings.emplace_back();
  }

  void end_of_basis(std::string_view name, const std::string& value) {
    WindowBasis& basis = xml_.bases.back();
    if (name == "AngleBasisName") basis.name = value;
    if (basis.rings.empty()) return;
    if (name == "LowerTheta") basis.rings.back().lower = window_number(file(), value, line());
    if (name == "UpperTheta") basis.rings.back().upper = window_number(file(), value, line());
    if (name == "nPhis") basis.rings.back().phis = window_number(file(), value, line());
    if (name == "Phi") basis.has_phi = true;
  }

  WindowXml xml_;
  WordCutter words_;
  std::string text_;
  std::string band_;
  std::string unit_;
  std::size_t first_of_band_ = 0;
  std::size_t layers_ = 0;
  bool is_counting_ = false;
};

/// The numbers of some blocks.
class DataReader final : public XmlReader {
 public:
  DataReader(const FileBytes& file, const std::vector<std::size_t>& blocks, const TakeWord& take)
      : XmlReader(file), blocks_(blocks), take_(take) {}

 private:
  void start(std::string_view name, const XML_Char**) override {
    if (name == "WavelengthDataBlock") ++begun_;
    is_wanted_ = is_in_data() && std::ranges::binary_search(blocks_, begun_ - 1);
  }

  void text(std::string_view text) override {
    if (!is_wanted_) return;
    const std::size_t here = line();
    // The words are those of the outline, which has refused what is too long.
    (void)words_.cut(text, [&](std::string_view word) { take_(begun_ - 1, word, here); });
  }

  void end(std::string_view) override {
    if (is_wanted_) words_.finish([&](std::string_view word) { take_(begun_ - 1, word, line()); });
    is_wanted_ = false;
  }

  const std::vector<std::size_t>& blocks_;
  const TakeWord& take_;
  WordCutter words_;
  std::size_t begun_ = 0;
  bool is_wanted_ = false;
};

/// "Transmission Front, Reflection Back", each once, the first of them where they are many.
std::string directions_of(const WindowXml& xml) {
  constexpr std::size_t kMostNamed = 8;  // more than the schema has
  std::vector<std::string> found;
  for (const WindowBlock& block : xml.blocks) {
    if (std::ranges::find(found, block.direction) == found.end()) found.push_back(block.direction);
  }
  if (found.size() > kMostNamed) found.resize(kMostNamed);
  return found.empty() ? "no data at all" : fmt::format("{}", fmt::join(found, ", "));
}

std::vector<std::size_t> blocks_with(const WindowXml& xml, std::string_view component) {
  std::vector<std::size_t> blocks;
  for (std::size_t i = 0; i < xml.blocks.size(); ++i) {
    if (is_same_text(xml.blocks[i].direction, component)) blocks.push_back(i);
  }
  return blocks;
}

std::vector<std::string> bands_without(const WindowXml& xml, const WindowChoice& choice) {
  std::vector<std::string> found;
  for (const WindowBlock& block : xml.blocks) {
    const bool is_there = std::ranges::any_of(
        choice.blocks, [&](std::size_t chosen) { return is_same_text(xml.blocks[chosen].band, block.band); });
    if (!is_there && std::ranges::find(found, block.band) == found.end()) found.push_back(block.band);
  }
  return found;
}

/// \param prefix "reflection", "transmission"
bool has_values(const WindowXml& xml, std::string_view prefix) {
  return std::ranges::any_of(xml.blocks, [&](const WindowBlock& block) {
    return block.has_values && is_same_text(std::string_view(block.direction).substr(0, prefix.size()), prefix);
  });
}

/// Checks a choice that is 0 everywhere.
void check_black(const FileBytes& file, const WindowXml& xml, const WindowChoice& choice, bool is_asked_for,
                 std::vector<std::string>& remarks) {
  const auto is_black = [&](std::size_t i) { return !xml.blocks[i].has_values; };
  if (!std::ranges::all_of(choice.blocks, is_black)) return;
  const bool has_reflection = has_values(xml, "reflection");
  if (!is_asked_for && !has_reflection && has_values(xml, "transmission")) {
    throw ArgumentError(
        fmt::format("{} holds transmission only: its reflectances are 0 everywhere; expected a reflectance, or "
                    "component '{}' to read it as black",
                    file.path().string(), choice.component));
  }
  const std::string_view other = choice.component == "reflection front" ? "reflection back" : "reflection front";
  remarks.push_back(choice.component + " is 0 everywhere" +
                    (has_reflection ? fmt::format("; {} is not", other) : std::string()));
}

void check_blocks(const FileBytes& file, const WindowXml& xml, const WindowChoice& choice) {
  for (auto i = choice.blocks.begin(); i != choice.blocks.end(); ++i) {
    const WindowBlock& block = xml.blocks[*i];
    if (block.line == 0) {
      file.refuse_line(block.begin, fmt::format("{} of '{}' has no ScatteringData", choice.component, block.band));
    }
    if (lowercase(block.type).starts_with("fractional")) {
      file.refuse_line(block.line, fmt::format("ScatteringDataType '{}'; expected values in sr^-1", block.type));
    }
    const bool is_second = std::any_of(
        choice.blocks.begin(), i, [&](std::size_t other) { return is_same_text(xml.blocks[other].band, block.band); });
    if (is_second) file.refuse_line(block.line, fmt::format("a second {} of '{}'", choice.component, block.band));
  }
}

/// A comment, in which "--" must not be.
std::string comment(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '-' && result.ends_with('-')) result += ' ';
    result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return "<!-- " + result + " -->\n";
}

/// Name that Radiance looks for, if the only channel has none.
std::string band_of(const BrdfFunction& brdf, std::size_t channel) {
  if (!brdf.wavelengths.empty()) {
    return fmt::format("<Wavelength unit=\"Nanometer\">{}</Wavelength>", shortest(brdf.wavelengths[channel]));
  }
  const std::string& name = brdf.channels[channel];
  const bool is_plain = brdf.channels.size() == 1 && (name == "value" || name == "luminance");
  return fmt::format("<Wavelength unit=\"Integral\">{}</Wavelength>", is_plain ? "Visible" : escaped_markup(name));
}

}  // namespace

void describe_cells(const BrdfFunction& brdf, BrdfTable& table) {
  constexpr double kRounding = 1e-15;  // of decimal numbers and of sums over cells
  const std::size_t squares = table.grid.rings().size() * table.grid.rings().size();
  table.error.clear();
  for (std::size_t c = 0; c < table.channels; ++c) {
    double largest = 0;
    for (const double value : table.channel(c)) largest = std::max(largest, std::abs(value));
    table.error.insert(table.error.end(), squares, kRounding * largest);
  }
  table.expression = brdf.name + " (" + brdf.format + ")";
  table.conventions = brdf.format + ": " + brdf.conventions;
  table.channel_names = brdf.channels;
}

bool is_tensor_tree(std::string_view structure) {
  constexpr std::string_view kName = "tensortree";
  return is_same_text(structure.substr(0, kName.size()), kName);
}

bool is_same_text(std::string_view a, std::string_view b) {
  return a.size() == b.size() && lowercase(a) == lowercase(b);
}

bool is_window_xml(const FileBytes& head) {
  std::string wide;
  std::string_view content = head.content();
  if (is_utf16(content)) {
    std::ranges::copy_if(content.substr(2), std::back_inserter(wide), [](char c) { return c != '\0'; });
    content = wide;
  }
  return content.find("<WindowElement") != content.npos || content.find(":WindowElement") != content.npos;
}

WindowXml read_window_xml(const FileBytes& file) {
  return OutlineReader(file).outline();
}

void read_scattering_data(const FileBytes& file, const std::vector<std::size_t>& blocks, const TakeWord& take) {
  DataReader(file, blocks, take).read();
}

double window_number(const FileBytes& file, std::string_view word, std::size_t line) {
  double value = 0;
  if (!parse_number(word, value)) {
    file.refuse_line(line, fmt::format("'{}' is no finite number", word.substr(0, kLongestWord)));
  }
  return value;
}

WindowChoice choose_component(const FileBytes& file, const WindowXml& xml, const ReadOptions& options,
                              std::vector<std::string>& remarks) {
  constexpr std::string_view kFront = "reflection front";
  constexpr std::string_view kBack = "reflection back";
  const std::string asked = lowercase(trim(options.component));
  if (!asked.empty() && asked != kFront && asked != kBack) {
    throw ArgumentError(fmt::format("'{}' is no reflectance; expected {} or {}; {} has {}", options.component, kFront,
                                    kBack, file.path().string(), directions_of(xml)));
  }
  WindowChoice choice{asked.empty() ? std::string(kFront) : asked, {}};
  choice.blocks = blocks_with(xml, choice.component);
  if (asked.empty() && choice.blocks.empty()) {
    choice = {std::string(kBack), blocks_with(xml, kBack)};
    if (!choice.blocks.empty()) {
      remarks.emplace_back(
          "it has no reflection front; reflection back was taken (what WINDOW calls front, Radiance calls "
          "back)");
    }
  }
  if (choice.blocks.empty()) {
    throw ArgumentError(fmt::format("{} has no {}; it has {}", file.path().string(),
                                    asked.empty() ? "reflection" : asked, directions_of(xml)));
  }
  check_blocks(file, xml, choice);
  check_black(file, xml, choice, !asked.empty(), remarks);
  for (const std::string& band : bands_without(xml, choice)) {
    remarks.push_back(fmt::format("'{}' has no {} and is left out", band, choice.component));
  }
  return choice;
}

BrdfFunction window_function(const FileBytes& file, const WindowXml& xml, const WindowChoice& choice,
                             std::string_view format) {
  BrdfFunction brdf;
  // genBSDF calls all materials "Name".
  const bool has_name = !xml.material.empty() && !is_same_text(xml.material, "Name");
  brdf.name = has_name ? xml.material : file.stem();
  brdf.format = format;
  bool is_spectral = true;
  for (const std::size_t i : choice.blocks) {
    const WindowBlock& block = xml.blocks[i];
    is_spectral = is_spectral && block.wavelength.has_value();
    brdf.wavelengths.push_back(block.wavelength.value_or(0));
    brdf.channels.push_back(block.wavelength ? shortest(*block.wavelength) + " nm" : block.band);
    if (brdf.channels.back().empty()) brdf.channels.back() = "value";
  }
  if (!is_spectral) brdf.wavelengths.clear();
  return brdf;
}

std::string window_text(const BrdfFunction& brdf, const WriteOptions& options, std::string_view structure,
                        std::string_view definition, const std::function<std::string(std::size_t channel)>& block) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += comment("Created by lobe" + (options.command_line.empty() ? "" : ": " + options.command_line));
  text += fmt::format(
      "<WindowElement xmlns=\"http://windows.lbl.gov\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://windows.lbl.gov/BSDF-v1.4.xsd\">\n"
      "  <WindowElementType>System</WindowElementType>\n  <FileType>BSDF</FileType>\n  <Optical>\n  <Layer>\n"
      "    <Material>\n      <Name>{}</Name>\n      <Manufacturer></Manufacturer>\n"
      "      <DeviceType>Other</DeviceType>\n    </Material>\n"
      "    <DataDefinition>\n      <IncidentDataStructure>{}</IncidentDataStructure>\n{}    </DataDefinition>\n",
      escaped_markup(brdf.name), structure, definition);
  for (std::size_t c = 0; c < brdf.channels.size(); ++c) {
    const std::string lines = block(c);
    for (const char* side : {"Front", "Back"}) {
      text += fmt::format(
          "    <WavelengthData>\n      <LayerNumber>System</LayerNumber>\n      {}\n      <WavelengthDataBlock>\n"
          "        <WavelengthDataDirection>Reflection {}</WavelengthDataDirection>\n{}      </WavelengthDataBlock>\n"
          "    </WavelengthData>\n",
          band_of(brdf, c), side, lines);
    }
  }
  return text + "  </Layer>\n  </Optical>\n</WindowElement>\n";
}

}  // namespace lobe
