#include "golden.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>

#include "core/files.hpp"

namespace lobe::test {

std::string without_versions(const std::string& text) {
  static const std::regex sizes("SIZE [0-9]+ \\([0-9.]+:1 COMPRESSION\\)");
  static const std::regex offsets("OFFSET [0-9]+");
  static const std::regex results(":((cophenetic_correlation|mean_silhouette)(_error)?) = [^;]* ");
  static const std::regex versions(":(source|software_version|git_commit|hdf5_version) = \"[^\"]*\"");
  std::string result = std::regex_replace(text, sizes, "SIZE *");
  result = std::regex_replace(result, offsets, "OFFSET *");
  result = std::regex_replace(result, results, ":$1 = * ");
  return std::regex_replace(result, versions, ":$1 = \"*\"");
}

std::string compact(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t stop = text[at] == '{' ? text.find_first_of("{}", at + 1) : std::string::npos;
    if (stop == std::string::npos || text[stop] == '{') {
      result += text[at++];
      continue;
    }
    static const std::regex blanks("\\s+");
    result += std::regex_replace(text.substr(at, stop - at + 1), blanks, " ");
    at = stop + 1;
  }
  return result;
}

namespace {

/// As HDF5 1.14 has it: h5dump of 1.10 writes "}}" for "} }", and the numbers of dimensions were signed.
std::string as_in_1_14(const std::string& line) {
  static const std::regex kBraces(R"(\}\})");
  static const std::regex kDimension(R"(H5T_STD_I32LE "dimension")");
  return std::regex_replace(std::regex_replace(line, kBraces, "} }"), kDimension, R"(H5T_STD_U32LE "dimension")");
}

}  // namespace

void expect_golden(const std::string& name, const std::string& text) {
  const std::filesystem::path golden = std::filesystem::path(LOBE_GOLDEN_DIRECTORY) / name;
  const std::filesystem::path seen = std::filesystem::current_path() / ("seen-" + name);
  write_text(seen, true, text);
  std::istringstream seen_lines(text);
  std::istringstream golden_lines(read_text(golden));
  std::string a;
  std::string b;
  for (int line = 1;; ++line) {
    const bool has_a = static_cast<bool>(std::getline(seen_lines, a));
    const bool has_b = static_cast<bool>(std::getline(golden_lines, b));
    if (!has_a && !has_b) return;
    a = as_in_1_14(a);
    b = as_in_1_14(b);
    ASSERT_TRUE(has_a == has_b && a == b)
        << name << ":" << line << "\n  golden: " << (has_b ? b : "(end)") << "\n  seen:   " << (has_a ? a : "(end)")
        << "\nif the change is intended: cp " << seen << " " << golden;
  }
}

}  // namespace lobe::test
