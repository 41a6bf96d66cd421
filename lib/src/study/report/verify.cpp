#include "lobe/study/verify.hpp"

#include "hdf5/file_digest.hpp"
#include "hdf5/hdf5_input.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/study/study_results.hpp"
#include "study/run/shard_file.hpp"

namespace lobe {

VerifiedFile verify_file(const std::filesystem::path& path) {
  VerifiedFile verified;
  if (is_shard_file(path)) {
    const ShardFile file(path);
    return {.kind = FileKind::shard,
            .has_checksum = true,
            .datasets = file.records(),
            .bytes = std::filesystem::file_size(path)};
  }
  {
    const hdf5::InputFile file(path);
    verified.has_checksum = check_digest(path) == DigestState::sound;
    for (const auto& dataset : file.numeric_datasets()) {
      ++verified.datasets;
      verified.bytes += file.read_through(dataset);
    }
  }
  if (is_study_results(path)) {
    verified.kind = FileKind::study_results;
    static_cast<void>(load_study_summary(path));
  } else if (is_table_file(path)) {
    verified.kind = FileKind::table;
    static_cast<void>(load_table_header(path));
  }
  return verified;
}

}  // namespace lobe
