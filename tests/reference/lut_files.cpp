#include "reference/lut_files.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

namespace lobe::reference {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("no file " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

std::uint64_t whole(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint64_t number = 0;
  for (std::size_t i = count; i-- > 0;) number = number << 8U | static_cast<unsigned char>(bytes.at(at + i));
  return number;
}

void require(bool holds, const char* rule) {
  if (!holds) throw std::runtime_error(rule);
}

/// IEEE 754, section 3.4: one sign, 5 bits of exponent, 10 of fraction.
double binary16(std::uint64_t bits) {
  const double sign = bits >> 15U == 0 ? 1 : -1;
  const int exponent = static_cast<int>(bits >> 10U & 31U);
  const auto fraction = static_cast<double>(bits & 1023U);
  if (exponent == 0) return sign * std::ldexp(fraction, -24);
  return sign * std::ldexp(1024 + fraction, exponent - 25);
}

}  // namespace

DoubleArray read_double_array(const std::filesystem::path& path) {
  const std::string bytes = bytes_of(path);
  if (!bytes.starts_with(std::string("\x93NUMPY\x01\x00", 8))) throw std::runtime_error("no array of version 1.0");
  const std::size_t begin = 10 + whole(bytes, 8, 2);
  if (begin % 16 != 0 || bytes.at(begin - 1) != '\n') throw std::runtime_error("the header is not aligned");
  const std::string header = bytes.substr(10, begin - 10);
  for (const char* part : {"'descr': '<f8'", "'fortran_order': False", "'shape': ("}) {
    if (header.find(part) == std::string::npos) throw std::runtime_error("no " + std::string(part));
  }
  DoubleArray array;
  std::istringstream shape(header.substr(header.find('(') + 1, header.find(')') - header.find('(') - 1));
  std::size_t count = 1;
  for (std::string extent; std::getline(shape, extent, ',');) {
    if (extent.find_first_not_of(' ') == std::string::npos) continue;
    array.shape.push_back(std::stoul(extent));
    count *= array.shape.back();
  }
  if (bytes.size() != begin + 8 * count) throw std::runtime_error("another number of doubles");
  for (std::size_t i = 0; i < count; ++i) {
    array.values.push_back(std::bit_cast<double>(whole(bytes, begin + 8 * i, 8)));
  }
  return array;
}

std::vector<float> constants_of_module(const std::filesystem::path& path) {
  constexpr std::uint32_t kMagic = 0x07230203;
  constexpr std::uint32_t kConstant = 43;   // type, result, literal
  constexpr std::uint32_t kComposite = 44;  // type, result, constituents
  const std::string bytes = bytes_of(path);
  const auto word = [&](std::size_t i) { return static_cast<std::uint32_t>(whole(bytes, 4 * i, 4)); };
  if (bytes.size() < 20 || word(0) != kMagic) throw std::runtime_error("no module");
  std::map<std::uint32_t, std::vector<float>> constants;
  std::vector<float> longest;
  for (std::size_t i = 5; i < bytes.size() / 4;) {
    const std::size_t count = word(i) >> 16U;
    const std::uint32_t operation = word(i) & 0xFFFFU;
    if (count == 0) throw std::runtime_error("an instruction of no words");
    if (operation == kConstant && count == 4) constants[word(i + 2)] = {std::bit_cast<float>(word(i + 3))};
    if (operation == kComposite) {
      auto& parts = constants[word(i + 2)];
      for (std::size_t k = 3; k < count; ++k) {
        const auto& part = constants.at(word(i + k));
        parts.insert(parts.end(), part.begin(), part.end());
      }
      if (parts.size() > longest.size()) longest = parts;
    }
    i += count;
  }
  return longest;
}

KtxFile read_ktx(const std::filesystem::path& path) {
  const std::string bytes = bytes_of(path);
  const unsigned char identifier[] = {0xAB, 0x4B, 0x54, 0x58, 0x20, 0x32, 0x30, 0xBB, 0x0D, 0x0A, 0x1A, 0x0A};
  require(std::memcmp(bytes.data(), identifier, sizeof identifier) == 0, "another identifier");
  const auto word = [&](std::size_t at) { return static_cast<std::uint32_t>(whole(bytes, at, 4)); };
  KtxFile file;
  file.format = word(12);
  const std::uint32_t size_of_type = word(16);
  file.width = word(20);
  file.height = word(24);
  file.depth = word(28);
  file.levels = word(40);
  require(word(32) == 0 && word(36) == 1, "layers or faces");
  require(word(44) == 0, "supercompression");
  const std::size_t described = word(48);
  require(described == 80 + 24 * file.levels, "the descriptor does not follow the levels");
  require(word(described) == word(52), "two sizes of the descriptor");
  require(word(56) == described + word(52) || word(60) == 0, "the keys do not follow the descriptor");
  require(whole(bytes, 64, 8) == 0 && whole(bytes, 72, 8) == 0, "data of supercompression");

  // The basic block.
  const std::size_t block = described + 4;
  require(word(block) == 0 && (word(block + 4) & 0xFFFFU) == 2, "no basic descriptor of version 1.3");
  require((word(block + 4) >> 16U) + 4 == word(52), "more than one block");
  file.color_model = word(block + 8) & 0xFFU;
  file.primaries = word(block + 8) >> 8U & 0xFFU;
  file.transfer = word(block + 8) >> 16U & 0xFFU;
  require(word(block + 12) == 0, "blocks of several texels");
  file.bytes_of_texel = word(block + 16) & 0xFFU;
  for (std::size_t at = block + 24; at < described + word(52); at += 16) {
    file.samples.push_back(
        {word(at) & 0xFFFFU, (word(at) >> 16U & 0xFFU) + 1, word(at) >> 24U, word(at + 8), word(at + 12)});
  }

  std::string before;
  for (std::size_t at = word(56); at < word(56) + word(60);) {
    const std::string entry = bytes.substr(at + 4, word(at));
    const std::size_t end = entry.find('\0');
    const std::string key = entry.substr(0, end);
    require(before < key, "keys are not sorted");
    require(entry.back() == '\0', "a text without an end");
    file.texts[key] = entry.substr(end + 1, entry.size() - end - 2);
    before = key;
    at += (4 + word(at) + 3) / 4 * 4;
  }

  const std::size_t begin = whole(bytes, 80, 8);
  const std::size_t length = whole(bytes, 88, 8);
  require(length == whole(bytes, 96, 8) && begin + length == bytes.size(), "the level is not the rest of the file");
  require(begin % file.bytes_of_texel == 0 && begin % 4 == 0, "the level is not aligned");
  for (std::size_t texel = begin; texel < bytes.size(); texel += file.bytes_of_texel) {
    for (const auto& sample : file.samples) {
      require(sample.length == 8 * size_of_type && sample.offset % 8 == 0, "samples of another size");
      const std::uint64_t bits = whole(bytes, texel + sample.offset / 8, size_of_type);
      const bool is_float = (sample.channel & 0x80U) != 0;
      file.values.push_back(!is_float ? static_cast<double>(bits) / sample.upper
                            : size_of_type == 2
                                ? binary16(bits)
                                : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits))));
    }
  }
  return file;
}

}  // namespace lobe::reference
