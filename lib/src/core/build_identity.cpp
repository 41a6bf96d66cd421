#include "core/build_identity.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <system_error>

namespace lobe {
namespace {

/// A place in a program or library, and the build ID of that, once it is found.
struct Sought {
  std::uintptr_t place;
  std::string build_id;
};

/// The ID among the notes of a segment; empty where there is none.
std::string id_among_notes(const char* notes, std::size_t size) {
  const auto padded = [](std::size_t bytes) { return (bytes + 3) / 4 * 4; };
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) note{};
    std::memcpy(&note, notes + at, sizeof note);
    const std::size_t name = at + sizeof note;
    const std::size_t content = name + padded(note.n_namesz);
    at = content + padded(note.n_descsz);
    if (at > size) break;
    if (note.n_type != NT_GNU_BUILD_ID || note.n_namesz != sizeof ELF_NOTE_GNU ||
        std::memcmp(notes + name, ELF_NOTE_GNU, sizeof ELF_NOTE_GNU) != 0) {
      continue;
    }
    std::string digits;
    for (std::size_t byte = 0; byte < note.n_descsz; ++byte) {
      fmt::format_to(std::back_inserter(digits), "{:02x}", static_cast<unsigned char>(notes[content + byte]));
    }
    return digits;
  }
  return {};
}

int look_at_object(dl_phdr_info* object, std::size_t, void* data) {
  auto& sought = *static_cast<Sought*>(data);
  bool is_ours = false;
  for (int k = 0; k < object->dlpi_phnum; ++k) {
    const auto& segment = object->dlpi_phdr[k];
    const std::uintptr_t begin = object->dlpi_addr + segment.p_vaddr;
    is_ours = is_ours || (segment.p_type == PT_LOAD && sought.place >= begin && sought.place < begin + segment.p_memsz);
  }
  if (!is_ours) return 0;
  for (int k = 0; k < object->dlpi_phnum && sought.build_id.empty(); ++k) {
    const auto& segment = object->dlpi_phdr[k];
    if (segment.p_type != PT_NOTE) continue;
    sought.build_id =
        id_among_notes(reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr), segment.p_memsz);
  }
  return 1;
}

}  // namespace

std::string build_identity() {
  Sought sought{reinterpret_cast<std::uintptr_t>(&build_identity), {}};
  ::dl_iterate_phdr(look_at_object, &sought);
  if (!sought.build_id.empty()) return sought.build_id;
  Dl_info where{};
  if (::dladdr(reinterpret_cast<const void*>(&build_identity), &where) == 0 || where.dli_fname == nullptr) return "";
  std::error_code code;
  const auto time = std::filesystem::last_write_time(where.dli_fname, code).time_since_epoch().count();
  return fmt::format("{} {}", std::filesystem::file_size(where.dli_fname, code), time);
}

}  // namespace lobe
