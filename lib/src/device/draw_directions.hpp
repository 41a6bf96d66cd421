#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "device/lobe_batch.hpp"
#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// How a direction is drawn; numbered as in kernels/sampling/proposal.clh.
enum class Strategy : unsigned {
  cosine,
  power,
  beckmann,
  cosine_facets,
  visible_facets,
  patch,
  patch_mixture,
  cells,
  delta  ///< a single direction, with a probability and no density
};

/// Numbers that parts of many densities may share.
using NumberTable = std::shared_ptr<const std::vector<double>>;

/// A part of the density that directions are drawn from.
struct ProposalPart {
  static constexpr std::size_t kNumbers = 14;

  Strategy strategy = Strategy::cosine;
  double share = 1;                        ///< its probability; those of all parts sum to 1
  std::array<double, kNumbers> numbers{};  ///< the file of the strategy says what they are
  NumberTable table = nullptr;  ///< numbers that it looks up; the device finds their place in `place_of_table`
  std::size_t place_of_table = kNumbers;  ///< which number says where the table begins; kNumbers: no table
};

/// A vector of length 1.
using UnitVector = std::array<double, 3>;

/// A lobe's share in each channel.
struct MixedLobe {
  std::size_t batch = 0;
  std::size_t lobe = 0;  ///< within its batch
  std::vector<double> mix;
};

/// Draws directions for one direction L and weighs them, a block at a time (kernels/sampling/draw_directions.cl,
/// weigh_directions.cl).
class DirectionSampler {
 public:
  /// \param parts at least one
  /// \param lobes none: directions have no weights
  /// \param capacity the largest block, rounded up to whole packs
  /// \throws DeviceError
  DirectionSampler(const Device& device, const UnitVector& light, std::span<const ProposalPart> parts,
                   const std::vector<LobeBatch>& batches, std::span<const MixedLobe> lobes, std::size_t channels,
                   Precision precision, std::size_t capacity);

  /// Rows of what is drawn: V, its density (sr^-1; of delta parts minus their probability, 0 of what is lost), and the
  /// part that drew it.
  enum Row : std::size_t { x, y, z, density, part };
  static constexpr std::size_t kRows = 5;

  /// Draws and weighs the samples of numbers first, first + 1, ..., at most as many as the capacity.
  void draw(std::uint64_t seed, std::uint64_t first, std::size_t count);
  /// Results of the last block. Values beyond its count mean nothing.
  [[nodiscard]] std::span<const double> row(Row name) const { return {drawn_.data() + name * capacity_, capacity_}; }
  /// f(L, V) N.V / density by sample.
  [[nodiscard]] std::span<const double> weights(std::size_t channel) const {
    return {weights_.data() + channel * capacity_, capacity_};
  }

  /// The density at given directions, at most as many as the capacity; sr^-1.
  void find_densities(std::span<const UnitVector> directions, std::span<double> densities);

  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  [[nodiscard]] std::size_t channels() const { return channels_; }

 private:
  struct Model {
    cl::Kernel kernel;
    cl::Buffer numbers;
    std::size_t lobes = 0;
  };
  void launch(cl::Kernel& kernel);

  Device device_;
  UnitVector light_;
  std::size_t part_count_;
  std::size_t channels_;
  std::size_t capacity_;
  cl::Buffer parts_;
  cl::Buffer tables_;
  cl::Kernel draw_;
  cl::Kernel density_;
  std::vector<Model> models_;
  cl::Buffer drawn_buffer_;
  cl::Buffer weight_buffer_;
  std::vector<double> drawn_;
  std::vector<double> weights_;
};

}  // namespace lobe
