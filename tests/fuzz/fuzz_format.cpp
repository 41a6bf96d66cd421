// Any bytes given to the reader of one format, named by LOBE_FUZZ_FORMAT: a reflectance or one clear complaint, and no
// more memory than four times the input where it is refused. Other names are other readers: "formula", the language of
// formulas, "study", "table" and so on, see kOthers.
#include <sanitizer/allocator_interface.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <span>
#include <string>
#include <string_view>

#include "formats/npy.hpp"
#include "fuzz/fuzz_checkpoint.hpp"
#include "fuzz/fuzz_formula.hpp"
#include "fuzz/fuzz_hdf5.hpp"
#include "fuzz/fuzz_shard.hpp"
#include "fuzz/fuzz_texts.hpp"
#include "support/format_reading.hpp"

namespace {

using namespace lobe;

constexpr std::size_t kHead = std::size_t{1} << 16;        // as load_measured() has it
constexpr std::int64_t kConstant = std::int64_t{1} << 20;  // bytes that may be taken beside four times the input
constexpr std::size_t kLongestComplaint = 600;

std::atomic<bool> watches{false};
std::atomic<std::int64_t> taken{0};  // bytes, since watching began
std::atomic<std::int64_t> peak{0};

[[noreturn]] void fail(std::string_view what, std::string_view detail) {
  std::fprintf(stderr, "lobe_fuzz: %.*s: %.*s\n", static_cast<int>(what.size()), what.data(),
               static_cast<int>(detail.size()), detail.data());
  std::abort();
}

void note_malloc(const volatile void*, std::size_t size) {
  if (!watches) return;
  const std::int64_t now = taken += static_cast<std::int64_t>(size);
  if (now > peak) peak = now;
}

void note_free(const volatile void* pointer) {
  if (watches && pointer != nullptr) {
    taken -= static_cast<std::int64_t>(__sanitizer_get_allocated_size(const_cast<const void*>(pointer)));
  }
}

/// Arrays of NumPy are members of archives, whose sums of checks no changed content has: they are fuzzed alone.
BrdfFunction read_array(const FileBytes& file, const ReadOptions&) {
  const NpyArray array = read_npy(file);
  BrdfFunction brdf;
  brdf.channels = {"value"};
  brdf.at = [sum = std::accumulate(array.values.begin(), array.values.end(), 0.0)](std::span<const Directions> pairs) {
    return BrdfValues{Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(pairs.size()), 1, sum), {}};
  };
  return brdf;
}
const Format kNpyArrays{"npy", "arrays of NumPy", [](const FileBytes&) { return true; }, read_array};

std::span<const std::uint8_t> bytes_of(std::string_view content) {
  return {reinterpret_cast<const std::uint8_t*>(content.data()), content.size()};
}

/// A bug behind five bytes, which has to be found.
void fuzz_planted(std::string_view content) {
  constexpr std::string_view kKey = "lobe!";
  std::size_t met = 0;
  while (met < kKey.size() && met < content.size() && content[met] == kKey[met]) ++met;
  if (met == kKey.size()) fail("the planted bug", "is found");
}

/// What is fuzzed beside formats of reflectances.
struct Other {
  std::string_view name;
  void (*fuzz)(std::string_view content);
};
constexpr std::array kOthers{
    Other{"formula", test::fuzz_formula}, Other{"study", test::fuzz_study},
    Other{"material-file", test::fuzz_material_file}, Other{"scene", test::fuzz_scene}, Other{"mesh", test::fuzz_mesh},
    Other{"specification", test::fuzz_specification}, Other{"judgements", test::fuzz_judgements},
    Other{"pairs", test::fuzz_pairs}, Other{"lut-axis", test::fuzz_lut_axis}, Other{"lut-image", test::fuzz_lut_image},
    Other{"lut-array", test::fuzz_lut_array}, Other{"lut-exr", test::fuzz_lut_exr},
    Other{"lut-ktx2", test::fuzz_lut_ktx2},
    Other{"table", [](std::string_view content) { test::fuzz_table(bytes_of(content)); }},
    Other{"results", [](std::string_view content) { test::fuzz_results(bytes_of(content)); }},
    Other{"modes", [](std::string_view content) { test::fuzz_modes(bytes_of(content)); }},
    Other{"checkpoint", [](std::string_view content) { test::fuzz_checkpoint(bytes_of(content)); }},
    Other{"shard", [](std::string_view content) { test::fuzz_shard(bytes_of(content)); }},
    // Not for the smoke: the first finds what the checksum finds, the second what HDF5 makes of any bytes.
    Other{"table-bytes", [](std::string_view content) { test::fuzz_table_bytes(bytes_of(content), false); }},
    Other{"table-bytes-sealed", [](std::string_view content) { test::fuzz_table_bytes(bytes_of(content), true); }},
    Other{"planted", fuzz_planted}};

/// The one that LOBE_FUZZ_FORMAT names, or nothing.
const Other* chosen_other() {
  const char* name = std::getenv("LOBE_FUZZ_FORMAT");
  const auto* found =
      std::ranges::find_if(kOthers, [&](const Other& one) { return name != nullptr && one.name == name; });
  return found == kOthers.end() ? nullptr : found;
}

const Format& chosen_format() {
  const char* name = std::getenv("LOBE_FUZZ_FORMAT");
  if (name != nullptr && name == kNpyArrays.name) return kNpyArrays;
  const auto all = formats();
  const auto found = std::ranges::find_if(all, [&](const Format* one) { return name != nullptr && one->name == name; });
  if (found == all.end()) {
    std::fputs("lobe_fuzz: LOBE_FUZZ_FORMAT is none of:", stderr);
    for (const Format* one : all) std::fprintf(stderr, " %s", std::string(one->name).c_str());
    for (const Other& one : kOthers) std::fprintf(stderr, " %s", std::string(one.name).c_str());
    std::fputs("\n", stderr);
    std::exit(2);
  }
  return **found;
}

void expect_one_clear_line(std::string_view complaint) {
  if (complaint.size() > kLongestComplaint) fail("a complaint is too long", complaint);
  if (complaint.find("input") == std::string_view::npos) fail("a complaint does not name the file", complaint);
  if (std::ranges::any_of(complaint, [](unsigned char c) { return std::iscntrl(c); })) {
    fail("a complaint is no plain line", complaint);
  }
}

void expect_values(const BrdfFunction& brdf) {
  const std::array<Directions, 6> pairs{{{0, 0, 0, 0},
                                         {0.7, 0.7, 3.14159265, 1},
                                         {1.5707, 0.1, 2, -3},
                                         {0.2, 1.57, -1, 40},
                                         {0.3, 1, 0, 0},
                                         {1, 0.3, 6, 6}}};
  const auto [value, error] = brdf.at(pairs);
  const auto channels = static_cast<Eigen::Index>(brdf.channels.size());
  if (channels == 0 || value.rows() != std::ssize(pairs) || value.cols() != channels) fail("values", "wrong shape");
  if (error.size() > 0 && (error.rows() != value.rows() || error.cols() != channels)) fail("errors", "wrong shape");
  if (!brdf.wavelengths.empty() && brdf.wavelengths.size() != brdf.channels.size()) fail("wavelengths", "wrong number");
}

/// The complaint where the content is refused, else nothing.
std::string complaint_about(const Format& format, const FileBytes& file) {
  try {
    expect_values(test::read_with_any_options(format, file));
    return {};
  } catch (const IoError& error) {
    return error.what();
  } catch (const ArgumentError& error) {
    return error.what();
  } catch (const NumericError& error) {  // values of programs that are none
    return error.what();
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  if (chosen_other() != nullptr) return 0;
  (void)chosen_format();
  __sanitizer_install_malloc_and_free_hooks(note_malloc, note_free);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  static const Other* const kOther = chosen_other();
  if (kOther != nullptr) {
    kOther->fuzz(content);
    return 0;
  }
  static const Format& format = chosen_format();
  if (!format.recognises(FileBytes::copy("input", content.substr(0, kHead)))) return 0;
  const FileBytes file = FileBytes::copy("input", content);
  taken = 0;
  peak = 0;
  watches = true;
  const std::string complaint = complaint_about(format, file);
  watches = false;
  if (complaint.empty()) return 0;
  expect_one_clear_line(complaint);
  // libzip takes two megabytes for any archive without members; operations and variables of shaders are more than their
  // text, which is short.
  const std::int64_t constant = format.name == "npz"    ? 4 * kConstant
                                : format.name == "glsl" ? 16 * kConstant
                                                        : kConstant;
  if (peak > 4 * static_cast<std::int64_t>(size) + constant) {
    fail("a refused file of " + std::to_string(size) + " bytes took " + std::to_string(peak), complaint);
  }
  return 0;
}
