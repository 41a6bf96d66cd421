#include "interface/failure.hpp"

#include <algorithm>
#include <filesystem>
#include <new>
#include <string_view>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

bool takes(const Command* command, std::string_view option) {
  return command != nullptr && std::ranges::find(command->options, option, &Option::name) != command->options.end();
}

std::string on_one_line(std::string text) {
  const auto ends = [&](std::string_view end) { return text.ends_with(end) && !text.ends_with(",..."); };
  while (ends("\n") || ends(".") || ends(" ")) text.pop_back();
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  return printable(text);
}

std::string joined(std::string_view problem, std::string_view advice) {
  return on_one_line(std::string(problem)) + "; " + std::string(advice);
}

/// The file in the same folder whose name is nearest to that of a missing one; empty where none is near.
std::string nearest_file(const fs::path& missing) {
  std::error_code code;
  const auto folder = missing.has_parent_path() ? missing.parent_path() : fs::path(".");
  std::vector<std::string> names;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    names.push_back(at->path().filename().string());
  }
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  const std::string near = nearest_word(missing.filename().string(), candidates);
  return near.empty() ? near : (missing.parent_path() / near).string();
}

/// What to do about a file where the message does not say.
std::string file_advice(Fault fault, const fs::path& path) {
  switch (fault) {
    case Fault::missing_file: {
      const std::string near = path.empty() ? "" : nearest_file(path);
      return near.empty() ? "check the spelling of the path" : "did you mean '" + near + "'?";
    }
    case Fault::content:
      return "mend the file, or take another one";
    case Fault::unknown_format:
      return "'lobe import --help' names those that are read";
    case Fault::hdf5_content:
      return "give a file that lobe has written";
    case Fault::directory:
      return "give the path of a file";
    case Fault::not_permitted:
      return "check the permissions";
    case Fault::read_only_place:
      return "choose another place";
    case Fault::no_space:
      return "free some space on the disk";
    case Fault::too_large:
      return "raise the limit on file sizes (ulimit -f)";
    default:
      return "check the path and its permissions";
  }
}

/// Where to read on about a mistake that is explained no further.
std::string usage_advice(lobe::Topic topic, const Command* command) {
  switch (topic) {
    case lobe::Topic::studies:
      return "see 'lobe help studies'";
    case lobe::Topic::materials:
      return "see 'lobe help materials'";
    case lobe::Topic::models:
      return "'lobe models' lists those that there are";
    case lobe::Topic::other:
      break;
  }
  return command == nullptr ? "see 'lobe --help'" : "see 'lobe " + std::string(command->name) + " --help'";
}

/// What an error says to a user of the command.
/// \param otherwise the advice where it gives none itself
std::string line_of(const Error& error, const Command* command, std::string_view otherwise) {
  const std::string line = on_one_line(error.what());
  switch (error.fault()) {
    case Fault::existing_file:
      if (!takes(command, "force")) break;
      return joined(error.problem(), "use --force to replace it, or another output name");
    case Fault::other_grid:
      if (!takes(command, "exact-grid")) break;
      return joined(error.problem(), "expected the same grid, or leave out --exact-grid to have it interpolated");
    case Fault::infinite_norm:
      return line + " (--domain-theta-max 80, domain_theta_max in studies)";
    case Fault::not_reciprocal:
      return line + " ('lobe symmetrise')";
    case Fault::wrong_results:
      return line + "; 'lobe devices --self-test' tests all";
    default:
      break;
  }
  return error.advice().empty() ? line + "; " + std::string(otherwise) : line;
}

}  // namespace

Failure describe_current_exception(const Command* command) {
  try {
    throw;
  } catch (const ArgumentError& error) {
    return {ExitCode::usage, line_of(error, command, usage_advice(error.topic(), command))};
  } catch (const IoError& error) {
    return {ExitCode::file, line_of(error, command, file_advice(error.fault(), error.path()))};
  } catch (const DeviceError& error) {
    return {ExitCode::device, line_of(error, command, "'lobe devices' lists what there is"), error.build_log()};
  } catch (const UnresolvedError& error) {
    const std::string line = line_of(error, command, "take a finer grid");
    if (!takes(command, "allow-unresolved")) return {ExitCode::numeric, line};
    return {ExitCode::numeric, line + " (--grid); --allow-unresolved keeps the table as it is"};
  } catch (const NumericError& error) {
    return {ExitCode::numeric, line_of(error, command, "check the parameters of the material")};
  } catch (const fs::filesystem_error& error) {
    const Fault fault = fault_of(error.code());
    return {ExitCode::file, joined(error.path1().string() + ": " + error.code().message(), file_advice(fault, {}))};
  } catch (const std::bad_alloc&) {
    return {ExitCode::numeric, "out of memory; use a smaller grid, fewer materials or a larger --tolerance"};
  } catch (const std::exception& error) {
    return {ExitCode::numeric, joined(std::string("internal error: ") + error.what(), "please report this")};
  }
}

}  // namespace lobe::cli
