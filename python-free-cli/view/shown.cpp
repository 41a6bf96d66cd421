#include "view/shown.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "lobe/core/error.hpp"
#include "lobe/model/specification.hpp"
#include "lobe/reflectance/adjusted.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFileMark = "file:";
/// Results of adjustments that are kept; a slider passes many.
constexpr std::size_t kKeptAdjusted = 64;

fs::path make_folder() {
  std::error_code code;
  const fs::path parent = fs::temp_directory_path(code);
  std::string path = ((code ? fs::path("/tmp") : parent) / "lobe-view-XXXXXX").string();
  if (::mkdtemp(path.data()) == nullptr) {
    const std::error_code reason(errno, std::generic_category());
    throw IoError(
        "no folder for dropped files can be made in " + fs::path(path).parent_path().string() + ": " + reason.message(),
        {.fault = fault_of(reason)});
  }
  return path;
}

/// The last part of a name, of letters that no reader takes for more than a name.
std::string plain_name(std::string_view name) {
  name.remove_prefix(std::min(name.size(), name.find_last_of("/\\") + 1));
  std::string plain;
  for (const char letter : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '.' || letter == '_' ||
                          (letter == '-' && !plain.empty());
    plain += is_plain ? letter : '_';
  }
  constexpr std::size_t kLongest = 100;
  if (plain.size() > kLongest) plain.erase(0, plain.size() - kLongest);
  if (plain.empty() || plain.front() == '.') plain.insert(0, 1, '_');
  return plain;
}

std::string offered_name(const Operand& operand) {
  return operand.shape().table() == nullptr ? operand.shape().name() : fs::path(operand.label()).stem().string();
}

}  // namespace

ShownMaterials::ShownMaterials(std::vector<Operand> given) : folder_(make_folder()) {
  for (Operand& operand : given) {
    std::string name = offered_name(operand);
    add(std::move(name), std::move(operand));
  }
}

ShownMaterials::~ShownMaterials() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

const Offer& ShownMaterials::add(std::string name, Operand operand) {
  std::string text = fmt::format("{}{}", kFileMark, offers_.size() + 1);
  if (const Material* material = operand.shape().formula()) text = specification(*material).value_or(text);
  return offers_.emplace_back(Offer{std::move(text), std::move(name), std::move(operand)});
}

const Offer& ShownMaterials::drop(const std::string& name, std::string_view content) {
  const fs::path folder = folder_ / std::to_string(offers_.size() + 1);
  fs::create_directories(folder);
  const fs::path path = folder / plain_name(name);
  {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (!file.flush()) throw IoError("'" + name + "' cannot be kept in " + folder.string(), {.fault = Fault::no_space});
  }
  if (names_study(path.string())) {
    throw ArgumentError("'" + plain_name(name) + "' is a study, which may name other files; expected a material, a " +
                        "table or a measured file, or the study in the command line of 'lobe view'");
  }
  Operand operand(path.string());
  return add(plain_name(name), std::move(operand));
}

const Offer* ShownMaterials::offer(const std::string& text) const {
  const auto found = std::ranges::find(offers_, text, &Offer::text);
  if (found != offers_.end()) return &*found;
  if (text.starts_with(kFileMark)) {
    throw ArgumentError("there is no '" + text + "' any more; expected a file that was given or dropped");
  }
  return nullptr;
}

std::optional<Material> ShownMaterials::formula(const std::string& text) const {
  const Offer* const found = offer(text);
  if (found == nullptr) return parse_material(text);
  const Material* const material = found->operand.shape().formula();
  return material == nullptr ? std::nullopt : std::optional(*material);
}

Reflectance ShownMaterials::reflectance(const Device& device, const std::string& text) {
  if (const auto kept = adjusted_.find(text); kept != adjusted_.end()) return kept->second;
  const Offer* const found = offer(text);
  Reflectance made =
      adjusted(device, found == nullptr ? Reflectance(parse_material(text)) : found->operand.reflectance());
  if (adjusted_.size() >= kKeptAdjusted) adjusted_.clear();
  adjusted_.emplace(text, made);
  return made;
}

std::string ShownMaterials::name(const std::string& text) const {
  const Offer* const found = offer(text);
  return found == nullptr ? text : found->name;
}

std::string ShownMaterials::word(const std::string& text) const {
  const Offer* const found = offer(text);
  if (found == nullptr || !text.starts_with(kFileMark)) return text;
  const std::string label = found->operand.is_formula() ? found->name : found->operand.label();
  return label.starts_with(folder_.string()) ? found->name : label;
}

std::string ShownMaterials::without_folder(std::string message) const {
  const std::string folder = folder_.string() + "/";
  for (auto at = message.find(folder); at != std::string::npos; at = message.find(folder, at)) {
    message.erase(at, message.find('/', at + folder.size()) + 1 - at);
  }
  return message;
}

}  // namespace lobe::cli
