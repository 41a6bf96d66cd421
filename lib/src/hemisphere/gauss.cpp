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

}  // namespace lobe
