#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "interface/command.hpp"
#include "interface/options.hpp"
#include "interface/session.hpp"
#include "interface/study_running.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/shard.hpp"
#include "lobe/study/study.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

constexpr Text kShardFolder{"DIR"};
constexpr Text kMergedName{"name"};
constexpr Text kStudyFile{"study"};

/// The request of the shards, with the study file where it is now.
/// \throws IoError when that is not there.
StudyRequest request_for(const Session& session, const ShardSet& shards) {
  StudyRequest request = study_request(shards.request());
  if (session.arguments().has(kStudyFile)) {
    request.path = session.arguments().text(kStudyFile);
  } else if (std::error_code ignored; !fs::exists(request.path, ignored)) {
    throw IoError("the study of these shards, " + request.path + ", is not there; say by --study where it is",
                  {.path = request.path});
  }
  return request;
}

ExitCode execute_merge(Session& session) {
  const auto& arguments = session.arguments();
  const ShardSet shards = ShardSet::find(arguments.text(kShardFolder), arguments.text(kMergedName));
  const StudyRequest request = request_for(session, shards);
  if (request.is_strict) session.be_strict();
  const auto [study, is_allowed] = requested_study(request);
  const auto device = session.choose_device();
  shards.require_same(device, study);
  const std::string output = arguments.text(option::output);
  const StudyPlace place(session, study, output.empty() ? fs::path(".") : fs::path(output),
                         arguments.has(option::force), "--output");
  StudyResult result = merge_shards(device, study, shards, session.progress());
  return finish_study(session, result, place,
                      {.command = "merge",
                       .command_line = plain_command_line(request, output),
                       .wants_errors = request.tolerance.has_value(),
                       .allows_unresolved = is_allowed,
                       .add = [&](Json& answer) { answer["shards"] = shards.count(); }});
}

}  // namespace

Command merge_command() {
  return {
      .name = "merge",
      .group = "Studies",
      .summary = "complete a study from the shards of a job array",
      .description =
          "Completes a study from the shards that 'lobe run STUDY --shard I/N -o DIR' has written, and writes the "
          "files of 'lobe run STUDY -o RESULTS', the same to the last byte. It first checks that all shards are there, "
          "each once and as it was written, and that study, files, options, device and build of lobe are still those "
          "of the shards; otherwise it says which file is wrong, and writes nothing. The shards stay. They remember "
          "the study file and the options of 'lobe run', so that none of these are given again.",
      .positionals = {{.handle = kShardFolder, .help = "folder of the shards"}},
      .options = {{.handle = option::output,
                   .letter = 'o',
                   .value = "DIR",
                   .help = "directory for the results, created if missing (default: the current one)"},
                  {.handle = option::force, .letter = 'f', .help = "replace existing files"},
                  {.handle = kMergedName,
                   .value = "NAME",
                   .help = "name of the study, if the folder holds shards of several"},
                  {.handle = kStudyFile,
                   .value = "FILE.toml",
                   .help = "the study file, if it lies elsewhere than when the shards were computed"},
                  json_option()},
      .examples = {{"what the first job of an array does", "lobe run studies/metals.toml --shard 1/2 -o shards"},
                   {"and the second one", "lobe run studies/metals.toml --shard 2/2 -o shards"},
                   {"the results of both", "lobe merge shards -o out"}},
      .execute = execute_merge};
}

}  // namespace lobe::cli
