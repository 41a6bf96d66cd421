#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>

namespace lobe::test {

/// A text as GoogleTest wants names of test parameters: letters, digits and underscores.
inline std::string test_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    if (c == '-') {
      name += "minus_";
    } else if (c == '.') {
      name += 'p';
    } else if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  return name;
}

/// Names the cases of a parametrised test by their field `name`.
struct ByName {
  template <typename Case>
  std::string operator()(const ::testing::TestParamInfo<Case>& info) const {
    return test_name(info.param.name);
  }
};

}  // namespace lobe::test
