#include "lobe/core/error.hpp"

#include <algorithm>
#include <array>

namespace lobe {
namespace {

constexpr std::string_view kBeforeAdvice = "; ";

}  // namespace

Error::Error(const std::string& message, ErrorFields fields)
    : std::runtime_error(message), fields_(std::make_shared<const ErrorFields>(std::move(fields))) {}

std::string_view Error::problem() const {
  const std::string_view message = what();
  return message.substr(0, message.find(kBeforeAdvice));
}

std::string_view Error::advice() const {
  const std::string_view message = what();
  const auto at = message.find(kBeforeAdvice);
  return at == std::string_view::npos ? std::string_view() : message.substr(at + kBeforeAdvice.size());
}

Fault fault_of(const std::error_code& code) {
  constexpr std::array kFaults{std::pair(std::errc::no_such_file_or_directory, Fault::missing_file),
                               std::pair(std::errc::file_exists, Fault::existing_file),
                               std::pair(std::errc::is_a_directory, Fault::directory),
                               std::pair(std::errc::not_a_directory, Fault::directory),
                               std::pair(std::errc::permission_denied, Fault::not_permitted),
                               std::pair(std::errc::read_only_file_system, Fault::read_only_place),
                               std::pair(std::errc::no_space_on_device, Fault::no_space),
                               std::pair(std::errc::file_too_large, Fault::too_large)};
  const auto* const found = std::ranges::find_if(kFaults, [&](const auto& pair) { return code == pair.first; });
  return found == kFaults.end() ? Fault::unspecified : found->second;
}

}  // namespace lobe
