#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "lobe/compare/literature_metric.hpp"
#include "lobe/metric/metric.hpp"

namespace lobe {

/// What the text of a checkpoint's file holds.
struct CheckpointRecords {
  bool is_checkpoint = false;   ///< it begins as one
  bool is_ours = false;         ///< of the identity that was asked for
  std::size_t sound_bytes = 0;  ///< of a file that is ours, without a damaged end
  std::map<std::string, std::string, std::less<>> contents;
};
[[nodiscard]] CheckpointRecords read_checkpoint(std::string_view text, std::string_view identity);

/// Of name and content, with which a record ends.
[[nodiscard]] std::uint64_t record_checksum(std::string_view name, std::string_view content);

/// With what a file begins, and what each result adds.
[[nodiscard]] std::string checkpoint_head(std::string_view identity);
[[nodiscard]] std::string checkpoint_record(std::string_view name, std::string_view content);

[[nodiscard]] std::string record_name(const Lighting& lighting);
[[nodiscard]] std::string record_name(LiteratureMetric comparison);

[[nodiscard]] std::string written_result(const MetricResult& result);
[[nodiscard]] std::string written_result(const LiteratureResult& result);

/// Fills a result with what was written of one.
/// \return whether that was the whole of it, of as many materials throughout as its first matrix has
[[nodiscard]] bool read_result(std::string_view content, MetricResult& result);
[[nodiscard]] bool read_result(std::string_view content, LiteratureResult& result);

/// Drops results of lightings and comparison metrics that read_result() would refuse, or with another number of
/// materials. Other records are read where they are used.
void keep_results_of(std::size_t materials, CheckpointRecords& records);

}  // namespace lobe
