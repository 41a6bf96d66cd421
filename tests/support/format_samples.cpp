#include "support/format_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

#include "formats/npy.hpp"
#include "lobe/core/error.hpp"
#include "support/format_reading.hpp"
#include "support/unzipped.hpp"
#include "support/zipped.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHead = std::size_t{1} << 16;  // as load_measured() has it
constexpr std::size_t kFiles = 4;                    // of each format that are taken from the data
constexpr std::size_t kSlowness = 2000;              // of formats of scattered samples, whose interpolation takes long

bool is_recognised(const Format& format, const std::string& content) {
  return format_of(FileBytes::copy("head", std::string_view(content).substr(0, kHead))) == &format;
}

bool is_readable(const Format& format, const std::string& content) {
  try {
    (void)read_with_any_options(format, FileBytes::copy("sample", content));
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// The first lines alone, where these are a file, too: rows of measurements, whose interpolation takes long to set up.
std::string shortened(const Format& format, std::string content) {
  constexpr std::size_t kLines = 60;
  std::size_t end = 0;
  for (std::size_t line = 0; line < kLines && end != content.npos; ++line) end = content.find('\n', end + 1);
  if (end == content.npos) return content;
  std::string first = content.substr(0, end + 1);
  return is_readable(format, first) ? first : content;
}

/// Reading sets up the interpolation of samples.
bool is_scattered(const Format& format) {
  constexpr std::array<std::string_view, 9> kNames{"alta", "astm",      "bird",         "brf",  "cornell",
                                                   "fred", "nist-rows", "openmaterial", "zemax"};
  return std::ranges::find(kNames, format.name) != kNames.end();
}

std::vector<FormatSample> data_samples(const Format& format, std::size_t largest) {
  const char* data = std::getenv("LOBE_DATA_DIR");
  if (data == nullptr || !fs::is_directory(data)) return {};
  std::multimap<std::size_t, FormatSample> by_size;
  for (const auto& entry : fs::recursive_directory_iterator(data)) {
    if (!entry.is_regular_file() || !is_recognised(format, read_unzipped(entry.path(), kHead))) continue;
    std::string content = shortened(format, read_unzipped(entry.path(), largest + 1));
    const std::size_t size = content.size();
    if (size <= largest) by_size.emplace(size, FormatSample{entry.path().filename().string(), std::move(content)});
  }
  std::vector<FormatSample> samples;
  for (auto& [size, sample] : by_size) {
    if (samples.size() == (is_scattered(format) ? 1 : kFiles)) break;
    if (is_readable(format, sample.content)) samples.push_back(std::move(sample));
  }
  return samples;
}

/// A lobe on a diffuse ground, in red, green and blue.
BrdfFunction plain_function() {
  BrdfFunction brdf;
  brdf.name = "plain";
  brdf.channels = {"red", "green", "blue"};
  brdf.is_bilateral = true;
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 3);
    for (Eigen::Index i = 0; i < values.value.rows(); ++i) {
      const auto [in, out, delta_phi, phi_in] = pairs[static_cast<std::size_t>(i)];
      const double cosine = std::cos(in) * std::cos(out) - std::sin(in) * std::sin(out) * std::cos(delta_phi);
      for (Eigen::Index c = 0; c < 3; ++c) {
        values.value(i, c) = 0.1 * static_cast<double>(c + 1) + std::exp(4 * cosine - 4);
      }
    }
    return values;
  };
  return brdf;
}

template <typename Number>
void append(std::string& content, std::initializer_list<Number> numbers) {
  for (const Number number : numbers) {
    std::array<char, sizeof(Number)> bytes{};
    std::memcpy(bytes.data(), &number, sizeof(Number));
    content.append(bytes.data(), bytes.size());
  }
}

/// Six nodes, series of two cosines.
std::string scatfun(std::uint32_t channels) {
  constexpr std::uint32_t kNodes = 6;
  std::string content = "SCATFUN\1";
  append<std::uint32_t>(content, {1, kNodes, kNodes * kNodes * 2 * channels, 2, channels, 1, 5, 0, 0});
  append<float>(content, {1, 0, 0, 0, 0});
  append<float>(content, {-1, -0.5F, 0, 0, 0.5F, 1});
  for (std::uint32_t i = 0; i < kNodes * kNodes; ++i) append<float>(content, {static_cast<float>(i)});
  for (std::uint32_t i = 0; i < kNodes * kNodes; ++i) append<std::uint32_t>(content, {i * 2 * channels, 2});
  for (std::uint32_t i = 0; i < kNodes * kNodes * channels; ++i) {
    append<float>(content, {1.0F / static_cast<float>(i + 3), 0.01F});
  }
  return content + "words";
}

/// Of formats that are not written and have no small files.
std::vector<FormatSample> made_by_hand(const Format& format) {
  if (format.name == "csv") {
    return {{"isotropic",
             "# here\ntheta_in_deg,theta_out_deg,delta_phi_deg,500 nm,600 nm\n0,0,0,1,2\n0,60,0,1,2\n60,0,0,.5,2e-1\n"
             "60,60,0,1,2\n60,60,180,9,8\n60,0,180,.5,1\n0,0,180,1,1\n0,60,180,2,3\n"},
            {"general",
             "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,red\n10,0,20,0,1\n10,0,20,90,2\n10,180,20,0,3\n"
             "10,180,20,90,4\n"}};
  }
  if (format.name == "astm") {
    std::string content = "LAB_NAME here\nNUM_POINTS 12\nVARS theta_i,phi_i,theta_s,phi_s,532nm,633nm\n";
    for (const char* in : {"0.1", "0.7", "1.3"}) {
      for (const char* out : {"0.2,0.1", "0.6,1.5", "0.9,3.1", "1.2,2.3"}) {
        content += in + std::string(",0,") + out + ",0.3,0.25\n";
      }
    }
    return {{"small", content}};
  }
  if (format.name == "bird") {
    return {{"columns",
             "{\"metadata\":{\"type\":\"BRDF\",\"sample\":{\"properties_symmetry\":\"isotropic\"}},\"data\":{\n"
             "\"theta_i\":{\"unit\":\"deg\",\"values\":[10,10,10,10,40,40,40,40]},\n"
             "\"phi_i\":{\"unit\":\"deg\",\"values\":[0,0,0,0,0,0,0,0]},\n"
             "\"theta_r\":{\"unit\":\"rad\",\"values\":[0.1,0.4,0.8,1.2,0.1,0.4,0.8,1.2],"
             "\"uncertainty\":{\"value\":0.1,\"unit\":\"%\"}},\n"
             "\"phi_r\":{\"unit\":\"deg\",\"values\":[180,180,90,0,180,180,90,0]},\n"
             "\"polarization_i\":{\"notation\":\"sp\",\"values\":[\"u\",\"u\",\"u\",\"u\",\"u\",\"u\",\"u\",\"u\"]},\n"
             "\"BRDF\":{\"unit\":\"sr^-1\",\"values\":[0.3,0.3,0.25,0.2,0.3,0.4,0.3,0.2]},\n"
             "\"uBRDF\":{\"unit\":\"%\",\"values\":[1,1,1,1,2,2,2,2]}}}\n"},
            {"rows",
             "{\"metadata\":{\"type\":\"BRDF\"},\"data\":{\"variables\":[{\"name\":\"theta_i\",\"unit\":\"deg\"},"
             "{\"name\":\"phi_i\",\"unit\":\"deg\"},{\"name\":\"theta_r\",\"unit\":\"deg\"},"
             "{\"name\":\"phi_r\",\"unit\":\"deg\"},{\"name\":\"BRDF\",\"unit\":\"sr-1\"},"
             "{\"name\":\"uBRDF\",\"unit\":\"sr-1\"}],\n\"values\":[\n[0,0,10,0,0.3,0.01],\n[0,0,30,0,0.3,0.01],\n"
             "[0,0,50,0,0.3,0.01],\n[0,0,70,0,0.3,0.01],\n[30,0,10,0,0.3,0.01],\n[30,0,30,180,0.5,0.02],\n"
             "[30,90,50,0,0.2,0.01],\n[30,90,70,0,0.3,0.01]]}}\n"}};
  }
  if (format.name == "openmaterial") {
    std::string rows;
    for (const char* in : {"0.1", "0.7", "1.3"}) {
      for (const char* out : {"0.2,0", "0.6,1.5", "0.9,3.1", "1.2,2.3"}) {
        for (const char* wavelength : {"5.5e-07", "9.05e-7"}) {
          rows += (rows.empty() ? "[" : ",\n[") + std::string(wavelength) + "," + in + "," + out + ",0.25]";
        }
      }
    }
    return {{"small",
             "{\"metadata\":{\"openMaterial3dVersion\":\"1.1.0\"},\"brdf\":{\"wavelengths\":[5.5e-7,9.05e-7],\n"
             "\"lookupTable\":[" +
                 rows + ",[5.5e-07,0.1,0.1,0.1,null]]}}\n"}};
  }
  if (format.name == "nist-zernike") {
    return {{"two-terms", "1, 1, 0, 0, 0, 0, 0, 2.05\n1, 1, 2, 2, 0, 2, 0, 0.1\n"},
            {"spectral", "1, 1, 0, 0, 0, 0, 1, 2\n\n2, 2, 0, 0, 0, 0, 0, 5\n"}};
  }
  if (format.name == "fred") {
    std::string content = "type bsdf_data\nformat angles=deg bsdf=value scale=1\n10\t0\n";
    for (const char* row : {"0 0 .1", "20 0 .3", "20 90 .2", "20 180 .1", "40 0 .2", "40 90 .1", "40 180 .05"}) {
      content += std::string(row) + "\n";
    }
    return {{"small", content + "40 0\n0 0 .1\n40 0 2\n"}};
  }
  if (format.name == "brf") {
    std::string content = "BRF Values\nhere\nsrc_z\tsrc_a\tview_z\tview_a\t385.65nm\t550nm\n";
    for (const char* theta : {"0", "12", "25", "40", "55", "65", "75", "85"}) {
      content += std::string(theta) + "\t0\t30.5\t180\t1.01\t0.99\n";
    }
    return {{"small", content}};
  }
  if (format.name == "glsl") {
    return {{"microfacets",
             "#version 300 es\n#define PI 3.1416\n#define sqr(x) ((x) * (x))\nconst vec3 f0 = vec3(1., .7, .3);\n"
             "uniform float alpha = .3;\nfloat D(float c) { float a2 = sqr(alpha); return a2 / (PI * sqr(c * c * "
             "(a2 - 1.) + 1.)); }\nvec3 brdf(vec3 L, vec3 V) {\n  if (L.z <= 0. || V.z <= 0.) return vec3(0);\n"
             "  vec3 H = normalize(L + V);\n  return mix(f0, vec3(1), pow(1. - dot(L, H), 5.)) * D(H.z) / (4. * "
             "max(L.z, V.z));\n}\n"},
            {"statements",
             "precision highp float;\nstruct S { float c[3]; mat2 m; };\nfloat sum = 0.;\nvoid add(inout S s, int i) {"
             " s.c[i] += float(i); s.m[1].x = sum; }\nfloat f(vec3 L, vec3 V) {\n  S s = S(float[3](1., 2., 3.), "
             "mat2(1.));\n  for (int i = 0; i < 3; i++) { if (i == 1) continue; add(s, i); sum += s.c[i]; }\n"
             "  while (sum > 9.) { sum -= L.z > .5 ? 2. : 1.; break; }\n  return (s.m * V.xy).x + dot(L.zyx, V) + "
             "sum;\n}\n"}};
  }
  if (format.name == "zemax") {
    return {{"small",
             "# here\nSource Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n"
             "SampleRotation 1\n0\nAngleOfIncidence 2\n10 40\nScatterAzimuth 3\n0 90 180\nScatterRadial 4\n"
             "0 10 20 30\nMonochrome\nDataBegin\nTIS 0.1\n9 3 1 .5\n9 3 1 .5\n9 3 1 .4\nTIS 0.1\n8 3 1 .5\n8 3 1 .5\n"
             "8 2 1 .4\nDataEnd\n"}};
  }
  if (format.name == "speos") {
    return {
        {"brdf",
         "OPTIS - brdf surface file v9.0\n0\nhere\n4\ntext\n1\t0\n1\n2\t2\n0\t60\n450\t600\n20\n3\t3\n\t0\t90\t180\n"
         "0\t3\t3\t3\n40\t2\t1\t1\n90\t1\t0\t0\n30\n2\t2\n\t0\t180\n0\t3\t3\n90\t1\t1\n50\n2\t2\n\t0\t180\n0\t3\t3\n"
         "90\t1\t1\n0\n2\t2\n\t0\t180\n0\t3\t3\n90\t1\t1\nEnd of file\n"},
        {"anisotropic",
         "OPTIS - Anisotropic BSDF surface file "
         "v8.0\n0\nhere\n4\ntext\n0\t1\t0\n1\t0\n0\n2\n0\t90\n1\n10\n2\n10\t50\n10\t0\n"
         "\n2\n350\t5.3\n850\t6\n2 4\n\t0\t90\t180\t360\n0\t1\t1\t1\t1\n90\t.1\t.2\t.1\t.1\n2 2\n\t0\t180\n0\t1\t1\n"
         "80\t.1\t.2\n2 2\n\t0\t180\n0\t2\t2\n85\t.1\t.2\nEnd of file\n"}};
  }
  if (format.name == "npz") {
    const auto list = [](const char* name, const std::vector<double>& numbers) {
      return std::pair<std::string, std::string>(std::string(name) + ".npy", npy_content({{numbers.size()}}, numbers));
    };
    std::vector<double> values;
    for (int i = 0; i < 3 * 2 * 4; ++i) values.push_back(0.1 + 0.01 * i * i);
    const std::vector<std::size_t> shape{3, 2, 2, 2};
    const std::vector<std::pair<std::string, std::string>> members{list("theta_in_deg", {0, 40, 80}),
                                                                   list("theta_out_deg", {10, 50}),
                                                                   list("delta_phi_deg", {0, 180}),
                                                                   list("wavelengths_nm", {450, 600}),
                                                                   {"values.npy", npy_content(shape, values)}};
    return {{"stored", zipped(members)}, {"packed", zipped(members, true)}};
  }
  if (format.name == "scatfun") return {{"grey", scatfun(1)}, {"coloured", scatfun(3)}};
  return {};
}

}  // namespace

std::vector<FormatSample> samples_of(const Format& format, std::size_t largest) {
  auto samples = data_samples(format, largest);
  auto by_hand = made_by_hand(format);
  // What is written in formats of scattered samples takes long to read.
  const bool is_small_enough = by_hand.empty() || !is_scattered(format);
  for (auto& sample : by_hand) samples.push_back(std::move(sample));
  if (format.write != nullptr && is_small_enough) {
    std::string content = shortened(format, format.write(plain_function(), {}));
    if (content.size() <= largest) samples.push_back({"written", std::move(content)});
  }
  for (auto& sample : samples) sample.cost = sample.content.size() * (is_scattered(format) ? kSlowness : 1);
  return samples;
}

}  // namespace lobe::test
