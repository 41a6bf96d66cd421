#include "reference/lut_files.hpp"

#include <bit>
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

}  // namespace lobe::reference
