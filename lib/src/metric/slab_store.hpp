#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/stopwatch.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/work_done.hpp"

namespace lobe {

/// A slab of a quadrature rule, refined: all that it adds to the products of the whole.
struct RefinedSlab {
  std::vector<Eigen::MatrixXd> levels;  ///< of lobes, the last ones, coarse to fine; products, or factors of them
  int level = 0;                        ///< the finest level
  double difference = 0;                ///< of the last levels, relative
  std::uint64_t nodes = 0;              ///< visited for this slab, with those of the first pass
  std::uint64_t evaluations = 0;        ///< of lobes at these nodes
};

/// Slabs that have been refined before or elsewhere, and a choice of those to refine now. A slab depends on the whole
/// set of materials and on nothing else, so that it has the same bits whoever refines it.
struct SlabStore {
  std::function<bool(std::size_t slab)> has;         ///< it is known
  std::function<RefinedSlab(std::size_t slab)> get;  ///< a known one
  /// Whether a slab that is not known is to be refined here. It is asked slab after slab, when those before are done.
  /// None: all are, and make up the whole.
  std::function<bool(std::size_t slab)> is_wanted;
  std::function<void(std::size_t slab, const RefinedSlab& refined, double seconds)> keep;
};

/// Nodes and evaluations between two moments.
[[nodiscard]] inline WorkDone difference_of(const WorkDone& after, const WorkDone& before) {
  WorkDone difference;
  difference.nodes = after.nodes - before.nodes;
  difference.evaluations = after.evaluations - before.evaluations;
  return difference;
}

/// What there is to do of the slabs of a rule.
class SlabWork {
 public:
  /// \param store none: all slabs are refined here, and none is kept
  SlabWork(const SlabStore* store, std::size_t slabs) : store_(store) {
    for (std::size_t slab = 0; slab < slabs; ++slab) is_known_.push_back(store != nullptr && store->has(slab));
  }

  [[nodiscard]] bool is_known(std::size_t slab) const { return is_known_[slab]; }
  /// No slab is left to others.
  [[nodiscard]] bool is_complete() const { return store_ == nullptr || !store_->is_wanted; }
  /// Whether a slab is to be refined here, or to be added if it is known; asked once for each.
  [[nodiscard]] bool takes(std::size_t slab) const {
    return is_complete() || (!is_known_[slab] && store_->is_wanted(slab));
  }
  [[nodiscard]] bool has_unknown() const { return std::ranges::find(is_known_, false) != is_known_.end(); }
  [[nodiscard]] RefinedSlab known(std::size_t slab) const { return store_->get(slab); }
  /// Work of the first pass on a slab. Where the slab is known, that counts it already.
  [[nodiscard]] WorkDone first_pass(std::size_t slab, const WorkDone& before, WorkDone& work) const {
    const WorkDone done = difference_of(work, before);
    if (is_known_[slab]) {
      work.nodes = before.nodes;
      work.evaluations = before.evaluations;
    }
    return done;
  }
  void keep(std::size_t slab, const RefinedSlab& refined, double seconds) const {
    if (store_ != nullptr) store_->keep(slab, refined, seconds);
  }

 private:
  const SlabStore* store_;
  std::vector<bool> is_known_;
};

/// A slab that is known, whose work is added to what is done here, or one that `refine` makes, which is kept.
/// \throws IoError if a known one is of another number of lobes
template <typename Refine>
[[nodiscard]] RefinedSlab take_slab(const SlabWork& share, std::size_t slab, std::size_t lobes, WorkDone& work,
                                    const Refine& refine) {
  if (share.is_known(slab)) {
    RefinedSlab known = share.known(slab);
    for (const auto& level : known.levels) {
      if (level.rows() != static_cast<Eigen::Index>(lobes)) throw IoError("a slab that was kept has other lobes");
    }
    work.nodes += known.nodes;
    work.evaluations += known.evaluations;
    return known;
  }
  Stopwatch watch;
  RefinedSlab refined = refine(slab);
  share.keep(slab, refined, watch.lap());
  return refined;
}

}  // namespace lobe
