#include "table/cell_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "table/arc_cell.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Projected solid angle that two cells share, the second one turned.
double shared(const ArcCell& a, ArcCell b, double turn) {
  b.low.turn += turn;
  b.high.turn += turn;
  const double inner = std::max(a.inner, b.inner);
  const double outer = std::min(a.outer, b.outer);
  if (!(outer > inner)) return 0;
  // Between the radii where two of the four azimuths meet, the same two are the limits.
  std::vector<double> radii{inner, outer};
  const std::array ends{a.low, a.high, b.low, b.high};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double meeting = (ends[j].bend - ends[i].bend) / (ends[i].turn - ends[j].turn);
      if (meeting > inner && meeting < outer) radii.push_back(meeting);
    }
  }
  std::ranges::sort(radii);
  double sum = 0;
  for (std::size_t k = 0; k + 1 < radii.size(); ++k) {
    const double r0 = radii[k];
    const double r1 = radii[k + 1];
    const double middle = (r0 + r1) / 2;
    const ArcEnd& high = a.high.at(middle) < b.high.at(middle) ? a.high : b.high;
    const ArcEnd& low = a.low.at(middle) > b.low.at(middle) ? a.low : b.low;
    if (high.at(middle) <= low.at(middle)) continue;
    sum += ArcCell{.low = low, .high = high}.measure(r0, r1);
  }
  return sum;
}

}  // namespace

Eigen::SparseMatrix<double, Eigen::RowMajor> cell_overlaps(const HemisphereGrid& from, const HemisphereGrid& to) {
  constexpr double kNone = 1e-14;  // of a cell: two that touch
  std::vector<ArcCell> sources;
  for (std::size_t k = 0; k < from.nodes(); ++k) sources.push_back(arc_cell(from, k));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < to.nodes(); ++i) {
    const ArcCell target = arc_cell(to, i);
    for (std::size_t k = 0; k < sources.size(); ++k) {
      if (sources[k].outer <= target.inner || sources[k].inner >= target.outer) continue;
      const double nearest = target.centre + std::remainder(sources[k].centre - target.centre, 2 * pi);
      double sum = 0;
      for (const int turn : {-1, 0, 1}) {
        sum += shared(target, sources[k], nearest - sources[k].centre + 2 * pi * turn);
      }
      const double share = sum / to.weights()[i];
      if (share > kNone) entries.emplace_back(static_cast<int>(i), static_cast<int>(k), share);
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> shares(static_cast<Eigen::Index>(to.nodes()),
                                                      static_cast<Eigen::Index>(from.nodes()));
  shares.setFromTriplets(entries.begin(), entries.end());
  return shares;
}

}  // namespace lobe
