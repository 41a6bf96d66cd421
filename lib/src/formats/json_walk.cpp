#include "formats/json_walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/text.hpp"

namespace lobe {
namespace {

constexpr std::size_t kDeepest = 32;

/// The characters of a text, which tell somebody else how far they have been read.
class ToldCharacter {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  ToldCharacter(const char* at, const char*& told) : at_(at), told_(&told) {}
  reference operator*() const { return *at_; }
  ToldCharacter& operator++() {
    *told_ = ++at_;
    return *this;
  }
  ToldCharacter operator++(int) {
    ToldCharacter before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const ToldCharacter& a, const ToldCharacter& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  const char** told_;
};

/// What nlohmann's parser calls.
class Events {
 public:
  using Json = nlohmann::json;

  Events(const JsonWalk& walk, const std::function<void(JsonPath, const JsonScalar&)>& value,
         const std::function<void(JsonPath)>& array_end)
      : walk_(walk), value_(value), array_end_(array_end) {}

  bool null() { return scalar({}); }
  bool boolean(bool) { return scalar({JsonScalar::Kind::boolean}); }
  bool number_integer(std::int64_t number) { return scalar(number_of(static_cast<double>(number))); }
  bool number_unsigned(std::uint64_t number) { return scalar(number_of(static_cast<double>(number))); }
  bool number_float(double number, const std::string&) { return scalar(number_of(number)); }
  bool string(const std::string& text) { return scalar({JsonScalar::Kind::text, 0, text}); }
  bool binary(const Json::binary_t&) { return false; }  // which texts do not have
  bool start_object(std::size_t) { return enter({}); }
  bool key(std::string& key) {
    path_.back() = std::move(key);
    return true;
  }
  bool end_object() {
    path_.pop_back();
    return true;
  }
  bool start_array(std::size_t) { return enter("[]"); }
  bool end_array() {
    path_.pop_back();
    array_end_(path_);
    return true;
  }
  bool parse_error(std::size_t, const std::string& last, const Json::exception& error) {
    const bool ends = std::string_view(error.what()).find("end of input") != std::string_view::npos;
    walk_.refuse(ends ? "the file ends within its JSON" : fmt::format("'{}' is no JSON here", excerpt(last)));
  }

 private:
  static JsonScalar number_of(double number) { return {JsonScalar::Kind::number, number}; }
  bool scalar(const JsonScalar& value) {
    value_(path_, value);
    return true;
  }
  bool enter(std::string step) {
    if (path_.size() == kDeepest) walk_.refuse(fmt::format("arrays and objects within more than {} others", kDeepest));
    path_.push_back(std::move(step));
    return true;
  }

  const JsonWalk& walk_;
  const std::function<void(JsonPath, const JsonScalar&)>& value_;
  const std::function<void(JsonPath)>& array_end_;
  std::vector<std::string> path_;
};

}  // namespace

bool is_at(JsonPath path, std::initializer_list<std::string_view> keys) {
  return std::equal(path.begin(), path.end(), keys.begin(), keys.end());
}

void JsonWalk::run(const std::function<void(JsonPath, const JsonScalar&)>& value,
                   const std::function<void(JsonPath)>& array_end) {
  Events events(*this, value, array_end);
  const std::string_view text = file_.content();
  const ToldCharacter begin(text.data(), at_);
  const ToldCharacter end(text.data() + text.size(), at_);
  (void)nlohmann::json::sax_parse(begin, end, &events);
}

void JsonWalk::refuse(std::string_view complaint) const {
  // The parser is one character ahead, which may be the end of the line.
  const char* const begin = file_.content().data();
  const char* const reached = at_ > begin ? at_ - 1 : begin;
  file_.refuse_line(1 + static_cast<std::size_t>(std::count(begin, reached, '\n')), complaint);
}

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace lobe
