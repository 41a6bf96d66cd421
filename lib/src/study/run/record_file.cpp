#include "study/run/record_file.hpp"

#include <fstream>
#include <system_error>

#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "study/run/checkpoint_records.hpp"

namespace lobe {

namespace fs = std::filesystem;

void RecordFile::open(std::string identity, std::size_t materials) {
  identity_ = std::move(identity);
  records_.clear();
  is_ours_ = false;
  sound_bytes_.reset();
  std::error_code ignored;
  is_broken_ = fs::exists(path_, ignored) && !fs::is_regular_file(path_, ignored);
  if (!fs::is_regular_file(path_, ignored)) return;
  std::string text;
  try {
    text = read_text(path_);
  } catch (const IoError&) {
    is_broken_ = true;
    return;
  }
  CheckpointRecords found = read_checkpoint(text, identity_);
  is_broken_ = !found.is_checkpoint;
  is_ours_ = found.is_ours;
  if (!is_ours_) return;
  sound_bytes_ = found.sound_bytes;
  keep_results_of(materials, found);
  records_ = std::move(found.contents);
}

const std::string* RecordFile::find(std::string_view name) const {
  const auto record = records_.find(name);
  return record == records_.end() ? nullptr : &record->second;
}

void RecordFile::keep(const std::string& name, const std::string& content) {
  if (is_broken_) return;
  const bool is_new = !is_ours_;
  std::error_code ignored;
  if (sound_bytes_) fs::resize_file(path_, *std::exchange(sound_bytes_, {}), ignored);
  std::ofstream file(path_, std::ios::binary | (is_new ? std::ios::trunc : std::ios::app));
  is_ours_ = is_ours_ || file.is_open();
  if (is_new) file << checkpoint_head(identity_);
  file << checkpoint_record(name, content);
  if (!file.flush()) {
    file.close();
    remove();
    is_broken_ = true;
    return;
  }
  is_ours_ = true;
  records_.insert_or_assign(name, content);
}

void RecordFile::remove() {
  records_.clear();
  std::error_code ignored;
  if (std::exchange(is_ours_, false)) fs::remove(path_, ignored);
}

}  // namespace lobe
