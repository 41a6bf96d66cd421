#include "formats/plain_hdf5.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

namespace lobe {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kEntryRest = 24;  // bytes of a symbol after name and address

// Types of messages in the headers of objects.
constexpr std::uint16_t kDataspace = 1;
constexpr std::uint16_t kDatatype = 3;
constexpr std::uint16_t kLayout = 8;
constexpr std::uint16_t kContinuation = 16;
constexpr std::uint16_t kSymbolTable = 17;

// IEEE, 32 bits, the lower bytes first: class and version, size; bit offset, precision, places and sizes of exponent
// and mantissa, bias. Bytes 1 to 3 tell byte order, padding and the place of the sign.
constexpr std::string_view kFloatSize = "\x04\0\0\0"sv;
constexpr std::string_view kFloatBits = "\0\0\x20\0\x17\x08\0\x17\x7f\0\0\0"sv;

}  // namespace

PlainHdf5::PlainHdf5(const FileBytes& file) : file_(file) {
  ByteReader reader(file);
  if (reader.bytes(8, "the superblock") != "\x89HDF\r\n\x1a\n"sv) file.refuse_at(0, "no HDF5 file");
  const auto versions = reader.bytes(8, "the superblock");
  if (versions.substr(0, 3) != "\0\0\0"sv || versions.substr(5, 2) != "\x08\x08"sv) {
    file.refuse_at(8, "HDF5 of another version than 0 with addresses of 8 bytes; 'h5repack -l CONTI' converts it");
  }
  (void)reader.bytes(8, "the superblock");
  if (reader.read<Address>("the superblock") != 0)
    file.refuse_at(24, "HDF5 that begins within the file; expected at 0");
  (void)reader.bytes(8, "the superblock");
  const auto end = reader.read<Address>("the superblock");
  if (end > file.size()) file.refuse_at(file.size(), fmt::format("the file ends; expected {} bytes", end));
  (void)reader.bytes(16, "the superblock");
  root_ = reader.read<Address>("the superblock");
}

ByteReader PlainHdf5::reader_at(Address address, std::string_view what) const {
  if (address > file_.size()) {
    file_.refuse_at(file_.size(), fmt::format("the file ends before {}, which is to be at byte {}", what, address));
  }
  return ByteReader(file_, static_cast<std::size_t>(address));
}

ByteReader PlainHdf5::block_at(Address address, std::string_view signature) const {
  ByteReader reader = reader_at(address, signature);
  if (reader.bytes(signature.size(), signature) != signature) {
    file_.refuse_at(static_cast<std::size_t>(address), fmt::format("no {}; expected a block of that name", signature));
  }
  return reader;
}

/// The first message of a type in the header of an object. Headers may go on elsewhere in the file.
PlainHdf5::Message PlainHdf5::message(Address object, std::uint16_t type, std::string_view what) const {
  ByteReader header = reader_at(object, what);
  if (header.read<std::uint8_t>(what) != 1) {
    file_.refuse_at(header.offset() - 1, fmt::format("no object header of version 1 for {}", what));
  }
  (void)header.bytes(7, what);
  std::vector<Message> blocks{{header.offset() + 8, header.read<std::uint32_t>(what)}};
  std::size_t budget = file_.size();  // of a header, which cannot be longer than the file
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    auto [begin, size] = blocks[block];
    if (size > budget) file_.refuse_at(begin, fmt::format("a header of {} bytes for {}", size, what));
    budget -= size;
    while (size >= 8) {
      ByteReader reader = reader_at(begin, what);
      const auto found = reader.read<std::uint16_t>(what);
      const std::size_t length = reader.read<std::uint16_t>(what);
      (void)reader.bytes(4, what);
      if (length + 8 > size) file_.refuse_at(begin, fmt::format("a message longer than the header of {}", what));
      if (found == type) {
        (void)reader.bytes(length, what);
        return {begin + 8, length};
      }
      if (found == kContinuation) {
        const auto next = reader.read<Address>(what);
        const std::uint64_t count = reader.read<std::uint64_t>(what);
        if (next > file_.size() || count == 0)
          file_.refuse_at(begin, fmt::format("the header of {} goes astray", what));
        blocks.push_back({static_cast<std::size_t>(next), static_cast<std::size_t>(count)});
      }
      begin += length + 8;
      size -= length + 8;
    }
  }
  file_.refuse_at(static_cast<std::size_t>(object), fmt::format("the header of {} has no message {}", what, type));
}

/// The object with a name in a group: the symbols of all leaves of its tree are compared.
PlainHdf5::Address PlainHdf5::find(Address group, std::string_view name) const {
  const auto [begin, size] = message(group, kSymbolTable, name);
  ByteReader table(file_, begin);
  std::vector<Address> nodes{table.read<Address>(name)};
  ByteReader heap = block_at(table.read<Address>(name), "HEAP");
  (void)heap.bytes(20, "HEAP");
  const auto text = file_.content().substr(reader_at(heap.read<Address>("HEAP"), "HEAP").offset());
  const auto has_name = [&](Address offset) {
    const auto from = text.substr(static_cast<std::size_t>(std::min<Address>(offset, text.size())));
    return from.starts_with(name) && from.size() > name.size() && from[name.size()] == '\0';
  };

  std::size_t budget = file_.size() / 8;  // of nodes and symbols, which cannot be more than there are addresses
  const auto count_in = [&](ByteReader& block, std::string_view what) {
    const std::size_t count = block.read<std::uint16_t>(what);
    if (count > budget) file_.refuse_at(block.offset(), "a group has more members than the file can hold");
    budget -= count;
    return count;
  };
  const auto found_in = [&](Address leaf) -> std::optional<Address> {
    ByteReader symbols = block_at(leaf, "SNOD");
    (void)symbols.bytes(2, "SNOD");
    for (std::size_t left = count_in(symbols, "SNOD"); left > 0; --left) {
      const auto offset = symbols.read<Address>("SNOD");
      const auto object = symbols.read<Address>("SNOD");
      if (has_name(offset)) return object;
      (void)symbols.bytes(kEntryRest, "SNOD");
    }
    return {};
  };
  while (!nodes.empty()) {
    ByteReader tree = block_at(nodes.back(), "TREE");
    nodes.pop_back();
    (void)tree.bytes(1, "TREE");
    const int level = tree.read<std::uint8_t>("TREE");
    const std::size_t children = count_in(tree, "TREE");
    (void)tree.bytes(16, "TREE");
    for (std::size_t i = 0; i < children; ++i) {
      (void)tree.bytes(8, "TREE");
      const auto child = tree.read<Address>("TREE");
      if (level > 0)
        nodes.push_back(child);
      else if (const auto object = found_in(child))
        return *object;
    }
  }
  file_.refuse_at(static_cast<std::size_t>(group), fmt::format("the group has no member '{}'", name));
}

std::vector<double> PlainHdf5::read(std::string_view path, std::span<const std::size_t> shape) const {
  Address object = root_;
  for (std::string_view rest = path.substr(1); !rest.empty();) {
    const std::string_view name = rest.substr(0, rest.find('/'));
    object = find(object, name);
    rest.remove_prefix(std::min(name.size() + 1, rest.size()));
  }

  const auto space = message(object, kDataspace, path);
  ByteReader reader(file_, space.begin);
  const auto version = reader.read<std::uint8_t>(path);
  const std::size_t rank = reader.read<std::uint8_t>(path);
  (void)reader.bytes(version == 1 ? 6 : 2, path);
  std::vector<std::uint64_t> seen;
  for (std::size_t i = 0; i < std::min(rank, shape.size() + 1); ++i) seen.push_back(reader.read<std::uint64_t>(path));
  if (!std::ranges::equal(seen, shape)) {
    file_.refuse_at(space.begin, fmt::format("{} has the shape {}; expected {}", path, fmt::join(seen, " x "),
                                             fmt::join(shape, " x ")));
  }

  const auto type = message(object, kDatatype, path);
  const auto bits = file_.content().substr(type.begin, type.size);
  const bool is_float = bits.size() >= 20 && (bits[0] & 0x0f) == 1 && (bits[1] & 1) == 0 &&
                        bits.substr(4, 4) == kFloatSize && bits.substr(8, 12) == kFloatBits;
  if (!is_float) file_.refuse_at(type.begin, fmt::format("{} has no 32-bit numbers, lower bytes first", path));

  const auto layout = message(object, kLayout, path);
  ByteReader place(file_, layout.begin);
  if (place.read<std::uint16_t>(path) != 0x0103) {
    file_.refuse_at(layout.begin,
                    fmt::format("the data of {} is not in one piece; 'h5repack -l CONTI' converts it", path));
  }
  const auto address = place.read<Address>(path);
  const std::size_t count = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  const auto data = reader_at(address, path).bytes(count * sizeof(float), path);
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<double>(number_at<float>(data, i * sizeof(float)));
    if (!std::isfinite(values[i])) {
      file_.refuse_at(static_cast<std::size_t>(address) + i * sizeof(float),
                      fmt::format("{} has a number that is not finite", path));
    }
  }
  return values;
}

}  // namespace lobe
