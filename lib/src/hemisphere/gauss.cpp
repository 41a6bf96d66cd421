#include "hemisphere/gauss.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {

GaussRule gauss_rule(int count) {
  GaussRule rule;
  const auto n = static_cast<std::size_t>(count);
  rule.nodes.resize(n);
  rule.weights.resize(n);
  for (std::size_t i = 0; i < (n + 1) / 2; ++i) {
    // Newton's method on the Legendre polynomial from Tricomi's estimate of its root.
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (count + 0.5));
    double derivative = 1;
    for (int step = 0; step < 100; ++step) {
      double previous = 1;
      double value = x;
      for (int k = 2; k <= count; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * previous) / k;
        previous = value;
        value = next;
      }
      derivative = count * (x * value - previous) / (x * x - 1);
      const double change = value / derivative;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    const double weight = 1 / ((1 - x * x) * derivative * derivative);
    rule.nodes[i] = (1 - x) / 2;
    rule.nodes[n - 1 - i] = (1 + x) / 2;
    rule.weights[i] = rule.weights[n - 1 - i] = weight;
  }
  return rule;
}

const KronrodRule& kronrod_rule() {
  static const KronrodRule rule = [] {
    // Nodes and weights on [-1, 1] from the end to the centre (Piessens et al., QUADPACK, 1983: qk15).
    constexpr std::array<double, 8> kAt = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                           0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                           0.586087235467691130294144691693301, 0.405845151377397166906606412076961,
                                           0.207784955007898467600689403773245, 0};
    constexpr std::array<double, 8> kWeights = {
        0.022935322010529224963732008058970, 0.063092092629978553290700663189204, 0.104790010322250183839876322541518,
        0.140653259715525918745189590510238, 0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
        0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
    const GaussRule gauss = gauss_rule(7);
    KronrodRule made{};
    for (std::size_t i = 0; i < KronrodRule::kNodes; ++i) {
      const std::size_t mirrored = KronrodRule::kNodes - 1 - i;
      const std::size_t k = std::min(i, mirrored);
      made.nodes[i] = (i < mirrored ? 1 - kAt[k] : 1 + kAt[k]) / 2;
      made.weights[i] = kWeights[k] / 2;
      made.coarse_weights[i] = i % 2 == 1 ? gauss.weights[i / 2] : 0;
    }
    return made;
  }();
  return rule;
}

void tidy_edges(std::vector<PanelEdge>& edges) {
  std::sort(edges.begin(), edges.end(), [](const PanelEdge& a, const PanelEdge& b) { return a.at < b.at; });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].at - edges[kept].at <= 1e-13 * std::abs(edges[i].at)) {
      edges[kept].root = edges[kept].root || edges[i].root;
    } else {
      edges[++kept] = edges[i];
    }
  }
  edges.resize(kept + 1);
}

std::vector<PanelEdge> cut_below(double lowest, std::vector<PanelEdge> edges) {
  if (lowest <= 0) return edges;
  std::erase_if(edges, [&](const PanelEdge& edge) { return edge.at <= lowest; });
  edges.insert(edges.begin(), {lowest});
  tidy_edges(edges);
  return edges;
}

void grade_edges(std::vector<PanelEdge>& edges, double growth) {
  constexpr double kShortest = 1e-7;
  // Rising panels first, then falling ones.
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<PanelEdge> graded{edges.begin(), edges.begin() + 2};
    for (std::size_t i = 2; i < edges.size(); ++i) {
      for (;;) {
        const double last = graded.back().at;
        const double longest = growth * std::max(std::abs(last - graded[graded.size() - 2].at), kShortest);
        if (std::abs(edges[i].at - last) <= longest) break;
        graded.push_back({last + std::copysign(longest, edges[i].at - last)});
      }
      graded.push_back(edges[i]);
    }
    edges.assign(graded.rbegin(), graded.rend());
  }
}

}  // namespace lobe
