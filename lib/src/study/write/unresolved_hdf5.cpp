#include "study/write/unresolved_hdf5.hpp"

#include <cstdint>
#include <vector>

namespace lobe {

void write_unresolved(hid_t group, std::span<const Unresolved> unresolved, std::span<const MaterialLabel> materials,
                      const std::string& quantity) {
  hdf5::write_attribute(group, "unresolved_pairs", static_cast<std::int64_t>(unresolved.size()));
  if (unresolved.empty()) return;
  std::vector<std::string> first;
  std::vector<std::string> second;
  std::vector<double> errors;
  for (const auto& pair : unresolved) {
    first.push_back(materials[pair.first].name);
    second.push_back(materials[pair.second].name);
    errors.push_back(pair.relative_error);
  }
  const auto axis = hdf5::create_index_axis(group, "unresolved", unresolved.size());
  hdf5::write_attribute(axis.id(), "long_name",
                        "pairs of materials whose " + quantity + " did not reach the tolerance");
  hdf5::write_attribute(hdf5::create_text_dataset(group, "unresolved_first", first, axis).id(), "long_name",
                        "first material of the pair");
  hdf5::write_attribute(hdf5::create_text_dataset(group, "unresolved_second", second, axis).id(), "long_name",
                        "second material of the pair");
  const hdf5::Dataset* const along[] = {&axis};
  const auto dataset = hdf5::create_dataset(group, "unresolved_error", errors, along);
  hdf5::write_attributes(dataset.id(), {{"long_name", "error estimate relative to the " + quantity}, {"units", "1"}});
}

}  // namespace lobe
