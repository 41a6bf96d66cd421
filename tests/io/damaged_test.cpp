// Damaged files of every format of other programs: one clear complaint, or a reflectance, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "io/measured_files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "support/format_reading.hpp"
#include "support/format_samples.hpp"
#include "support/gzipped.hpp"
#include "support/measured_data.hpp"
#include "support/scale.hpp"
#include "support/temporary_directory.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

constexpr std::size_t kLargest = std::size_t{64} << 20;  // bytes of a sample
const std::size_t kWork = swept(64, 12) << 20;           // bytes that one kind of damage to a sample may read

/// How often a file is damaged in one way.
std::size_t times(std::size_t size, std::size_t most) {
  return std::clamp<std::size_t>(kWork / std::max<std::size_t>(size, 1), 3, most);
}

const std::vector<Directions>& pairs() {
  static const std::vector<Directions> kPairs{{0, 0, 0, 0},        {0.7, 0.7, 3.1415, 1}, {1.5707, 0.1, 2, -3},
                                              {0.2, 1.57, -1, 40}, {0.3, 1, 0, 0},        {1, 0.3, 6, 6}};
  return kPairs;
}

/// Values that are not finite make no table; a damaged exponent makes them in formats that are formulas.
void expect_no_table(const BrdfFunction& brdf) {
  EXPECT_THROW((void)tabulate(brdf, HemisphereGrid::gauss(8, 16), {.allow_unresolved = true}), NumericError);
}

enum class Infinity { allowed, refused };

/// Reads content as load_measured() does.
void expect_complaint_or_function(const std::string& content, Infinity infinity) {
  const FileBytes file = FileBytes::copy("damaged-file", content);
  const Format* format = format_of(file);
  if (format == nullptr) return;
  try {
    const auto brdf = read_with_any_options(*format, file);
    const auto values = brdf.at(pairs()).value;
    EXPECT_EQ(values.cols(), std::ssize(brdf.channels));
    if (values.allFinite()) return;
    EXPECT_EQ(infinity, Infinity::allowed);
    expect_no_table(brdf);
  } catch (const IoError& error) {
    const std::string complaint = error.what();
    EXPECT_THAT(complaint, HasSubstr("cannot read damaged-file"));
    EXPECT_TRUE(std::ranges::none_of(complaint, [](unsigned char c) { return std::iscntrl(c); })) << complaint;
    EXPECT_THAT(complaint, ContainsRegex("byte|line"));
  } catch (const NumericError& error) {  // values of programs that are none
    EXPECT_THAT(error.what(), HasSubstr("damaged-file"));
    EXPECT_EQ(format->name, "glsl");
  }
}

class Damaged : public ::testing::TestWithParam<const Format*> {
 protected:
  void SetUp() override {
    samples_ = samples_of(*GetParam(), kLargest);
    if (samples_.empty() && measured_data("").empty()) GTEST_SKIP() << kNoData;
    ASSERT_FALSE(samples_.empty()) << "tests/support/format_samples.cpp needs a file of this format";
  }

  /// \param damage gets a sample and a number that counts from 0
  void expect(std::size_t most, const std::function<std::string(const std::string&, std::size_t)>& damage,
              Infinity infinity = Infinity::allowed) const {
    for (const auto& [name, content, cost] : samples_) {
      const std::size_t count = times(cost, most);
      for (std::size_t i = 0; i < count; ++i) {
        SCOPED_TRACE(name + ", damage " + std::to_string(i) + " of " + std::to_string(count));
        EXPECT_NO_THROW(expect_complaint_or_function(damage(content, i), infinity));
      }
    }
  }

  std::vector<FormatSample> samples_;
};

bool is_text(const std::string& content) {
  return std::ranges::all_of(content.substr(0, 4096), [](unsigned char c) { return c >= ' ' || std::isspace(c); });
}

/// Where numbers of a text begin and how long they are.
std::vector<std::pair<std::size_t, std::size_t>> numbers_of(const std::string& text) {
  constexpr std::string_view kOfNumbers = "+-.0123456789eE";
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t at = text.find_first_of("0123456789"); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_not_of(kOfNumbers, at), text.size());
    found.emplace_back(at, end - at);
    at = text.find_first_of("0123456789", end);
  }
  return found;
}

/// A text with one of its numbers replaced.
/// \param i which, spread over the text with more among the first
std::string with_number(std::string text, std::size_t i, std::string_view replacement) {
  const auto numbers = numbers_of(text);
  if (numbers.empty()) return text;
  const std::size_t which = i < 24 ? i : i * 7919;
  const auto [at, length] = numbers[which % numbers.size()];
  return text.replace(at, length, replacement);
}

/// Bytes with some of them replaced, where the content is long enough.
std::string with_bytes(std::string content, std::size_t at, std::string_view bytes) {
  if (at + bytes.size() <= content.size()) content.replace(at, bytes.size(), bytes);
  return content;
}

TEST_P(Damaged, SamplesAreReadWhereTheyAreNot) {
  for (const auto& [name, content, cost] : samples_) {
    const auto brdf = read_with_any_options(*GetParam(), FileBytes::copy(name, content));
    EXPECT_TRUE(brdf.at(pairs()).value.allFinite()) << name;
    EXPECT_EQ(format_of(FileBytes::copy(name, content)), GetParam()) << name;
  }
}

TEST_P(Damaged, FilesThatAreCutAreRefusedOrRead) {
  expect(40, [](const std::string& content, std::size_t i) {
    // Short ones, then all lengths.
    return content.substr(0, i < 12 ? std::size_t{1} << i : content.size() * (i - 11) / 29);
  });
  expect(4, [](const std::string& content, std::size_t i) { return content.substr(0, content.size() - 1 - i); });
}

TEST_P(Damaged, FilesThatAreTooLongAreRefusedOrRead) {
  expect(4, [](const std::string& content, std::size_t i) { return content + std::string(i * i * i + 1, '\0'); });
  expect(3, [](const std::string& content, std::size_t) { return content + content; });
}

TEST_P(Damaged, FilesWithAFlippedBitAreRefusedOrRead) {
  std::mt19937_64 engine(5);
  expect(120, [&](std::string content, std::size_t i) {
    const std::size_t within = i % 2 == 0 ? std::min<std::size_t>(content.size(), 512) : content.size();
    char& byte = content[engine() % within];
    byte = static_cast<char>(byte ^ (1 << engine() % 8));
    return content;
  });
}

TEST_P(Damaged, FilesWithNumbersThatAreNoneAreRefused) {
  using namespace std::string_view_literals;
  constexpr std::array kWords{"nan"sv, "1e999"sv, "-inf"sv, "NaN"sv, "0x1p9999"sv, "-1e-999"sv, "--1"sv};
  constexpr std::array kPatterns{"\x00\x00\xc0\x7f\x00\x00\xc0\x7f"sv, "\x00\x00\x00\x00\x00\x00\xf8\x7f"sv,
                                 "\x00\x00\x80\x7f\x00\x00\x80\xff"sv, "\xff\xff\xff\xff\xff\xff\xff\xff"sv,
                                 "\x00\x00\x00\x00\x00\x00\xf0\xff"sv};
  std::mt19937_64 engine(7);
  expect(
      90,
      [&](const std::string& content, std::size_t i) {
        if (is_text(content)) return with_number(content, i, kWords[i % kWords.size()]);
        return with_bytes(content, engine() % content.size() / 4 * 4, kPatterns[i % kPatterns.size()]);
      },
      Infinity::refused);
}

TEST_P(Damaged, FilesWithHugeSizesAreRefusedOrRead) {
  using namespace std::string_view_literals;
  constexpr std::array kWords{"4000000000"sv, "99999999999999999999"sv, "-1"sv, "65536"sv, "1e9"sv};
  constexpr std::array kPatterns{"\xff\xff\xff\xff"sv, "\xff\xff\xff\x7f"sv, "\x00\x00\x00\x80"sv, "\x00\x00\x01\x00"sv,
                                 "\xff\xff\xff\xff\xff\xff\xff\x7f"sv};
  expect(150, [&](const std::string& content, std::size_t i) {
    const std::size_t place = i / kWords.size();
    if (is_text(content)) return with_number(content, place, kWords[i % kWords.size()]);
    return with_bytes(content, place * 4, kPatterns[i % kPatterns.size()]);
  });
}

TEST_P(Damaged, FilesWithBytesInTheWrongOrderAreRefusedOrRead) {
  expect(8, [](std::string content, std::size_t i) {
    const std::size_t word = std::size_t{2} << i % 3;
    for (std::size_t at = i / 3 * 8; at + word <= content.size(); at += word) {
      std::reverse(content.begin() + static_cast<std::ptrdiff_t>(at),
                   content.begin() + static_cast<std::ptrdiff_t>(at + word));
    }
    return content;
  });
}

TEST_P(Damaged, FilesThatAreCompressedAreReadAsTheyAre) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.path() / "compressed.bsdf.gz";
  const auto& content = samples_.front().content;
  write_file(path, gzipped(content));
  EXPECT_TRUE(is_measured_file(path));
  const FileBytes file = FileBytes::read(path);
  ASSERT_EQ(file.content(), content);
  EXPECT_EQ(file.stem(), "compressed");
  const auto packed = read_with_any_options(*GetParam(), file).at(pairs()).value;
  EXPECT_TRUE(packed == read_with_any_options(*GetParam(), FileBytes::copy("plain", content)).at(pairs()).value);
}

/// Zeros, a great many of which take little room.
std::string zeros(std::size_t megabytes) {
  const std::string member = gzipped(std::string(std::size_t{1} << 20, '\0'));
  std::string content;
  for (std::size_t i = 0; i < megabytes; ++i) content += member;
  return content;
}

void expect_packed_refusal(const std::string& packed, const std::string& complaint) {
  expect_complaint([&] { (void)FileBytes::unpack(FileBytes::copy("packed.gz", packed)); },
                   "cannot read packed.gz: byte ");
  expect_complaint([&] { (void)FileBytes::unpack(FileBytes::copy("packed.gz", packed)); }, complaint);
}

TEST(CompressedFiles, OfSeveralMembersAreThePartsOneAfterTheOther) {
  const auto unpacked = [](const std::string& packed) {
    return std::string(FileBytes::unpack(FileBytes::copy("packed.gz", packed)).content());
  };
  const std::string all = gzipped("one, ") + gzipped("") + gzipped("two");
  EXPECT_EQ(unpacked(all), "one, two");
  EXPECT_EQ(unpacked(all + std::string(512, '\0')), "one, two");
  EXPECT_EQ(unpacked(zeros(3)), std::string(std::size_t{3} << 20, '\0'));
}

TEST(CompressedFiles, ThatAreDamagedAreRefused) {
  const std::string packed = gzipped("some words, and more of them, so that there is something to compress");
  for (std::size_t size = 2; size < packed.size(); ++size) {
    expect_packed_refusal(packed.substr(0, size), "the file ends within its compressed data");
  }
  expect_packed_refusal(packed + "x", "the file goes on after its compressed data");
  expect_packed_refusal(packed + packed.substr(0, 9), "the file ends within its compressed data");
  expect_packed_refusal("\x1f\x8b\x07 and so on, with something that is no deflate", "its compressed data is damaged");
  std::string flipped = packed;
  flipped[packed.size() - 6] ^= 1;  // of the sum of checks
  expect_packed_refusal(flipped, "its compressed data is damaged (incorrect data check)");
}

TEST(CompressedFiles, ThatWouldFillTheMemoryAreRefusedBeforeTheyDo) {
  const FileBytes packed = FileBytes::copy("packed.gz", zeros(9));
  EXPECT_LT(packed.size(), 12000U);
  EXPECT_EQ(FileBytes::unpack(packed, std::size_t{9} << 20).size(), std::size_t{9} << 20);
  expect_complaint([&] { (void)FileBytes::unpack(packed, (std::size_t{9} << 20) - 1); },
                   "it unpacks to more than 8 MiB, which is the limit");
}

TEST(StreamedFiles, AreReadOnceAndKept) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.path() / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  std::atomic<bool> is_open = false;
  std::thread writer([&] {
    std::ofstream pipe(path);  // waits for a reader
    is_open = true;
    pipe << "theta_in_deg,theta_out_deg,delta_phi_deg,value\n0,0,0,3\n";
  });
  // Asking for the kind must not open it, or the writer would be killed once the pipe is closed again.
  bool is_table = false;
  for (int i = 0; i < 50; ++i) {
    is_table = is_table || is_table_file(path);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_FALSE(is_table);
  EXPECT_FALSE(is_open);
  EXPECT_TRUE(is_measured_file(path));
  EXPECT_EQ(load_measured(path).at(std::vector<Directions>{{0, 0, 0, 0}}).value(0, 0), 3);
  writer.join();
}

TEST(DamagedFiles, AreQuotedWithoutControlCharacters) {
  try {
    FileBytes::copy("file", "").refuse_line(3, "'\x1b[31mred\r' is no number");
    FAIL() << "it did not throw";
  } catch (const IoError& error) {
    EXPECT_STREQ(error.what(), "cannot read file: line 3: '?[31mred?' is no number");
  }
}

std::string test_name(const ::testing::TestParamInfo<const Format*>& info) {
  std::string name(info.param->name);
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Formats, Damaged, ::testing::ValuesIn(formats().begin(), formats().end()), test_name);

}  // namespace
}  // namespace lobe::test
