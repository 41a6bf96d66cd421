#include "energy/elevation_integral.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "hemisphere/cubature.hpp"
#include "hemisphere/kronrod.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::RowVectorXd;
using std::numbers::pi;

/// A panel and its part of the means.
struct ElevationPanel {
  PanelPart part;
  RowVectorXd value = {};
  RowVectorXd difference = {};  ///< of the rules, and of what both do not see at the ends
  RowVectorXd square = {};      ///< sum of the squared errors of the terms
  RowVectorXd own = {};
  std::array<RowVectorXd, 3> terms = {};  ///< at both ends and in the middle; empty at the horizon
};

PanelPoint point_of(const PanelPart& part, double x) {
  PanelPoint point = panel_point(part.low, part.high, part.from + (part.to - part.from) * x);
  point.stretch *= part.to - part.from;
  return point;
}

class ElevationIntegral {
 public:
  ElevationIntegral(const ElevationIntegrands& integrands, const ElevationGoal& goal)
      : integrands_(integrands), goal_(goal) {}

  [[nodiscard]] ElevationSums mean() {
    constexpr double kBeside = 0.01;  // of the integrand's own error: good enough
    std::vector<ElevationPanel> waiting = first_panels();
    std::vector<ElevationPanel> done;
    for (;;) {
      integrate(waiting);
      done.insert(done.end(), waiting.begin(), waiting.end());
      ElevationSums sums = summed(done);
      RowVectorXd enough = goal_.relative * sums.value.head(goal_.steering).cwiseAbs();
      if (goal_.has_errors) {
        const auto own = sums.own.head(goal_.steering).array();
        enough = (own > 0).select(enough.array().max(kBeside * own), enough.array());
      }
      if ((sums.error.head(goal_.steering).array() <= enough.array()).all()) return sums;
      if (done.size() >= goal_.most_panels) return sums;
      waiting = halves_of_worst(done, sums.value.head(goal_.steering).cwiseAbs());
      if (waiting.empty()) return sums;
    }
  }

 private:
  [[nodiscard]] std::vector<ElevationPanel> first_panels() const {
    std::vector<PanelEdge> edges{{goal_.lowest, goal_.lowest == 0}};
    for (const double at : {0.16, pi / 6, pi / 4, pi / 2}) {
      if (at > goal_.lowest) edges.push_back({at});
    }
    tidy_edges(edges);
    std::vector<ElevationPlace> ends;
    for (std::size_t k = goal_.lowest == 0 ? 1 : 0; k < edges.size(); ++k) ends.push_back({edges[k].at, 0});
    const auto at_ends = integrands_(ends);
    const std::size_t without = edges.size() - ends.size();
    std::vector<ElevationPanel> panels;
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
      panels.push_back({.part = {edges[k], edges[k + 1]}});
      if (k >= without) panels.back().terms[0] = at_ends[k - without].value;
      panels.back().terms[1] = at_ends[k + 1 - without].value;
    }
    return panels;
  }

  static ElevationSums summed(const std::vector<ElevationPanel>& panels) {
    constexpr double kDeviations = 2;
    const RowVectorXd zero = RowVectorXd::Zero(panels.front().value.size());
    ElevationSums sums{zero, zero, RowVectorXd::Zero(panels.front().own.size())};
    RowVectorXd square = zero;
    for (const ElevationPanel& panel : panels) {
      sums.value += panel.value;
      sums.error += panel.difference;
      sums.own += panel.own;
      square += panel.square;
    }
    sums.error += kDeviations * square.cwiseSqrt();
    return sums;
  }

  /// Takes panels with the larger half of the differences from the list.
  [[nodiscard]] static std::vector<ElevationPanel> halves_of_worst(std::vector<ElevationPanel>& panels,
                                                                   const RowVectorXd& scale) {
    const auto error = [&scale](const ElevationPanel& panel) {
      const auto difference = panel.difference.head(scale.size()).array();
      return (scale.array() > 0).select(difference / scale.array(), 0.0).maxCoeff();
    };
    std::ranges::sort(panels, std::greater<>(), error);
    double total = 0;
    for (const ElevationPanel& panel : panels) total += error(panel);
    std::vector<ElevationPanel> halves;
    double taken = 0;
    std::size_t count = 0;
    for (; count < panels.size() && taken < total / 2; ++count) {
      const ElevationPanel& whole = panels[count];
      const PanelPart& part = whole.part;
      taken += error(whole);
      const double middle = (part.from + part.to) / 2;
      halves.push_back({.part = {part.low, part.high, part.from, middle}});
      halves.back().terms = {whole.terms[0], whole.terms[2], {}};
      halves.push_back({.part = {part.low, part.high, middle, part.to}});
      halves.back().terms = {whole.terms[2], whole.terms[1], {}};
    }
    panels.erase(panels.begin(), panels.begin() + static_cast<std::ptrdiff_t>(count));
    return halves;
  }

  void integrate(std::vector<ElevationPanel>& panels) {
    constexpr double kGolden = 0.6180339887498949;
    const EmbeddedPair& rule = short_pair();
    std::vector<ElevationPlace> places;
    for (const ElevationPanel& panel : panels) {
      for (const double x : rule.nodes) {
        const double start = kGolden * static_cast<double>(nodes_++);
        places.push_back({point_of(panel.part, x).at, start - std::floor(start)});
      }
    }
    const auto terms = integrands_(places);
    const std::size_t n = rule.nodes.size();
    for (std::size_t p = 0; p < panels.size(); ++p) sum(panels[p], std::span(terms).subspan(p * n, n));
  }

  /// A kink between the end of a panel and its first node is seen by no rule: the term at the end is not that to which
  /// the polynomial through the nodes leads.
  static void sum(ElevationPanel& panel, std::span<const ElevationTerms> terms) {
    constexpr double kUnsure = 4;  // of the sum of the term at an end and those of the nodes with their weights
    const EmbeddedPair& rule = short_pair();
    const std::size_t n = rule.nodes.size();
    const RowVectorXd zero = RowVectorXd::Zero(terms.front().value.size());
    panel.value = panel.square = zero;
    panel.own = RowVectorXd::Zero(terms.front().own.size());
    RowVectorXd coarse = zero;
    RowVectorXd null = zero;
    RowVectorXd by_azimuth = zero;  // what the terms there are unsure by
    std::array<RowVectorXd, 2> beyond{panel.terms[0], panel.terms[1]};
    std::array<double, 2> measure_at_end{};
    for (std::size_t i = 0; i < n; ++i) {
      const PanelPoint at = point_of(panel.part, rule.nodes[i]);
      const double measure = 2 * at.stretch * std::sin(at.at) * std::cos(at.at);  // over pi: of the mean
      const double weight = measure * rule.weights[i];
      const ElevationTerms& here = terms[i];
      for (std::size_t end = 0; end < 2; ++end) {
        if (i == (end == 0 ? 0 : n - 1)) measure_at_end.at(end) = measure;
        if (beyond.at(end).size() > 0) beyond.at(end) -= rule.end_weights[end == 0 ? i : n - 1 - i] * here.value;
      }
      if (2 * i + 1 == n) panel.terms[2] = here.value;
      panel.value += weight * here.value;
      coarse += measure * rule.coarse_weights[i] * here.value;
      null += measure * rule.null_weights[i] * here.value;
      panel.square += weight * weight * here.square;
      panel.own += weight * here.own;
      if (here.odd.size() == 0) continue;
      by_azimuth = by_azimuth.cwiseMax(here.odd.cwiseAbs());
      panel.square += (weight * here.odd).cwiseAbs2();
    }
    RowVectorXd square = (panel.value - coarse).cwiseAbs2() + null.cwiseAbs2();
    for (std::size_t end = 0; end < 2; ++end) {
      if (beyond.at(end).size() == 0) continue;
      const RowVectorXd sure = (beyond.at(end).cwiseAbs() - kUnsure * by_azimuth).cwiseMax(0);
      square += (rule.nodes.front() * measure_at_end.at(end) * sure).cwiseAbs2();
    }
    panel.difference = square.cwiseSqrt();
  }

  const ElevationIntegrands& integrands_;
  const ElevationGoal& goal_;
  std::size_t nodes_ = 0;  ///< so far
};

}  // namespace

ElevationSums integrate_elevations(const ElevationIntegrands& integrands, const ElevationGoal& goal) {
  return ElevationIntegral(integrands, goal).mean();
}

}  // namespace lobe
