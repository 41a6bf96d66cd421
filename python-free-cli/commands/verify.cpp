#include "lobe/study/verify.hpp"

#include <fmt/core.h>

#include "interface/command.hpp"
#include "interface/memory.hpp"
#include "interface/options.hpp"
#include "interface/session.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

std::string_view to_string(FileKind kind) {
  switch (kind) {
    case FileKind::table:
      return "table";
    case FileKind::study_results:
      return "results of a study";
    case FileKind::shard:
      return "shard of a study";
    case FileKind::hdf5:
      break;
  }
  return "HDF5 file";
}

/// Whether a file was read at all.
bool tells_of_content(const IoError& error) {
  const Fault fault = error.fault();
  return fault != Fault::missing_file && fault != Fault::directory && fault != Fault::not_permitted;
}

ExitCode execute_verify(Session& session) {
  Json files = Json::array();
  std::string text;
  ExitCode code = ExitCode::success;
  for (const auto& path : session.arguments().texts(argument::files)) {
    try {
      const VerifiedFile file = verify_file(path);
      const std::string_view checksum = file.has_checksum ? "right" : "none";
      text +=
          fmt::format("{}: sound; {}, {} {}, {} of numbers; checksum: {}\n", path, to_string(file.kind), file.datasets,
                      file.kind == FileKind::shard ? "units" : "datasets", bytes_text(file.bytes), checksum);
      files.push_back({{"file", path},
                       {"is_sound", true},
                       {"kind", to_string(file.kind)},
                       {"datasets", file.datasets},
                       {"bytes", file.bytes},
                       {"has_checksum", file.has_checksum}});
    } catch (const IoError& error) {
      text += fmt::format("{}: {}; {}\n", path, tells_of_content(error) ? "damaged" : "not read", error.what());
      files.push_back({{"file", path}, {"is_sound", false}, {"error", error.what()}});
      code = ExitCode::file;
    }
  }
  if (session.wants_json()) {
    Json answer = json_answer("verify");
    answer["files"] = std::move(files);
    session.print_json(answer);
  } else {
    session.print(text);
  }
  return code;
}

}  // namespace

Command verify_command() {
  return {
      .name = "verify",
      .group = "Tables",
      .summary = "check files for damage",
      .description =
          "Reads tables, results and shards of studies to their end. Checks the checksum that lobe appends to its "
          "files, the checksum of "
          "every chunk of numbers, and what the kind of file has to state. Names what is damaged, and the exit status "
          "is then 3. Other commands check what they read of a file anyway; this one reads all of it. Files that other "
          "programs wrote or changed have no checksum, which is reported.",
      .positionals = {{.handle = argument::files,
                       .help = "a table, or a result or shard of 'lobe run'",
                       .is_repeated = true}},
      .options = {json_option()},
      .examples = {{"a table", "lobe tabulate ward:m=0.3 -o w.h5"},
                   {"a check of the whole file", "lobe verify w.h5"},
                   {"the same as JSON", "lobe verify w.h5 --json"}},
      .execute = execute_verify};
}

}  // namespace lobe::cli
