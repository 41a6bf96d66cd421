#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/study/study.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// One of the shards into which a study is dealt, for processes that know nothing of each other, such as those of a job
/// array. The units of a study are lightings, slabs of the quadrature under point light and daylight, comparison
/// metrics, tiles of the distances by these of more than 128 formulas, curves of materials, printed figures and curves
/// of charts. Each has the same bits in whatever shard it is.
struct Shard {
  std::size_t index = 1;  ///< from 1 on
  std::size_t count = 1;  ///< number of all shards
};

/// Largest number of shards.
inline constexpr std::size_t kMostShards = 1'000'000;

/// Reads "INDEX/COUNT", for example "3/64".
/// \throws ArgumentError for anything else, an index beyond the count, and more than kMostShards
[[nodiscard]] Shard parse_shard(std::string_view text);
/// Text of a shard: "3/64".
[[nodiscard]] std::string to_string(const Shard& shard);
/// Stem of the names of a shard's files: "NAME.3-of-64".
[[nodiscard]] std::string shard_stem(const Study& study, const Shard& shard);

/// A unit of a study, and who computes it.
struct DealtUnit {
  std::string name;       ///< for people: "slab 3 of lighting point"
  std::size_t shard = 1;  ///< index of its shard, from 1 on
  double share = 0;       ///< estimated share of the work of the study
};
/// Lists the units of a study, in the order of a run, dealt to so many shards by their estimated costs. The files of
/// the study are read.
/// \throws as run_study()
[[nodiscard]] std::vector<DealtUnit> deal_study(const Device& device, const Study& study, std::size_t shards,
                                                const ProgressCallback& progress = {});

/// Options for computing a shard.
struct ShardOptions {
  bool overwrite = false;          ///< compute the shard although its file exists, and replace that
  bool keeps_units = true;         ///< keep each unit as soon as it is known, for a run that continues
  std::string request = {};        ///< kept in the file, for whoever merges: how the study was asked for
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// File of a shard, and how it came to be.
struct ShardReport {
  std::filesystem::path file;  ///< DIRECTORY/NAME.3-of-64.shard
  bool was_complete = false;   ///< whether the file was there before
  std::size_t units = 0;       ///< units of the shard
  std::size_t kept = 0;        ///< units among them that an interrupted run had kept
  std::size_t all_units = 0;   ///< units of the study; 0 if the file was there before
};

/// Computes a shard into a file of its own in a directory that shards share. The file appears when it is complete, and
/// not before. NAME.3-of-64.checkpoint beside it keeps the units that are known until then; if the process is killed,
/// the next run of the shard continues from there. A complete shard of the same study, device and build is left as it
/// is.
/// \throws as run_study(); IoError if another process computes the shard, if the file cannot be written, and unless
///   `overwrite` if it is damaged or belongs to another study, device or build
ShardReport run_shard(const Device& device, const Study& study, const Shard& shard,
                      const std::filesystem::path& directory, const ShardOptions& options = {});

/// The complete shards of a study in a directory.
class ShardSet {
 public:
  /// Finds the shards, files `*.shard`, and reads each of them once.
  /// \param name the study's name, if the directory holds shards of several
  /// \throws IoError that names the file or the shard: there is none, a file is truncated or damaged, or written by
  ///   another version, files belong to several studies or to several numbers of shards, two are the same shard, or one
  ///   is missing
  [[nodiscard]] static ShardSet find(const std::filesystem::path& directory, std::string_view name = {});

  /// Name of the study.
  [[nodiscard]] const std::string& study() const;
  /// Number of the shards.
  [[nodiscard]] std::size_t count() const;
  /// Request of the first shard, as in ShardOptions.
  [[nodiscard]] const std::string& request() const;
  /// Files of the shards, in the order of their indices.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

  /// Checks that all shards are those of a study on this device, by this build.
  /// \throws IoError that names the first file which is not
  void require_same(const Device& device, const Study& study) const;

  struct Implementation;
  /// Access for merge_shards().
  [[nodiscard]] const Implementation& implementation() const { return *implementation_; }

 private:
  explicit ShardSet(std::shared_ptr<const Implementation> all) : implementation_(std::move(all)) {}
  std::shared_ptr<const Implementation> implementation_;
};

/// Completes a study from its shards: the result is that of run_study(), to the last bit, but for the times of its
/// stages. Trees, maps, approximations and rank agreement are made here, and so are distances between near-identical
/// materials, which need all products first.
/// \throws as run_study() and ShardSet::require_same()
[[nodiscard]] StudyResult merge_shards(const Device& device, const Study& study, const ShardSet& shards,
                                       const ProgressCallback& progress = {});

}  // namespace lobe
