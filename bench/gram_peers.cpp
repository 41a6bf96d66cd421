#include "gram_peers.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "device/node_block.hpp"
#include "measure.hpp"

namespace bench {

NodeRows collect_nodes(const lobe::HalfDifferenceRule& rule, int level) {
  std::vector<double> columns;
  lobe::NodeBlock block(4096);
  for (std::size_t slab = 0; slab < rule.slabs(); ++slab) {
    rule.place(slab, level, block, [&] {
      for (std::size_t node = 0; node < block.size(); ++node) {
        for (std::size_t row = 0; row < lobe::NodeBlock::kRows; ++row) {
          columns.push_back(block.data()[row * block.capacity() + node]);
        }
      }
      block.clear();
    });
  }
  const auto count = static_cast<Eigen::Index>(columns.size() / lobe::NodeBlock::kRows);
  return Eigen::Map<Eigen::Matrix<double, 8, Eigen::Dynamic>>(columns.data(), 8, count);
}

std::vector<peers::HostLobe> host_lobes(const lobe::LobeSet& lobes) {
  std::vector<peers::HostLobe> list;
  for (const auto& batch : lobes.batches) {
    for (const auto& c : batch.coefficients) list.push_back({batch.kernel.model, {c[0], c[1], c[2], c[3]}});
  }
  return list;
}

std::optional<NumpyStudy> run_numpy(const NodeRows& nodes, std::span<const peers::HostLobe> lobes) {
  const auto directory = std::filesystem::temp_directory_path() / fmt::format("bench_gram_{}", ::getpid());
  std::filesystem::create_directory(directory);
  const auto nodes_file = directory / "nodes";
  const auto lobes_file = directory / "lobes";
  std::ofstream(nodes_file, std::ios::binary)
      .write(reinterpret_cast<const char*>(nodes.data()),
             static_cast<std::streamsize>(static_cast<std::size_t>(nodes.size()) * sizeof(double)));
  {
    std::ofstream out(lobes_file);
    for (const auto& lobe : lobes) {
      const auto& c = lobe.constants;
      out << fmt::format("{} {} {} {} {}\n", lobe.model, c[0], c[1], c[2], c[3]);
    }
  }
  const std::string output =
      run_python(fmt::format("'{}' '{}' '{}'", LOBE_PEERS "/gram.py", nodes_file.string(), lobes_file.string()));
  std::filesystem::remove_all(directory);
  const auto json = nlohmann::json::parse(output, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return NumpyStudy{json["evaluate"], json["products"], json["distances"], json["trace"], json["sum"]};
}

}  // namespace bench
