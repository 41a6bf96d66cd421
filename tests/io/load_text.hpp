#pragma once

#include <string>

#include "core/files.hpp"
#include "lobe/study/study.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {

/// The study of a file "file.toml" with this text.
inline Study load_text(const std::string& text) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "file.toml";
  write_text(path, false, text);
  return load_study(path);
}

}  // namespace lobe::test
