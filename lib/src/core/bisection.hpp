#pragma once

namespace lobe {

/// An interval at whose ends something differs.
struct Bracket {
  double low;
  double high;
};

/// Halves an interval about the place where `is_below` changes from true, as it is at `low`, to false.
/// \param halvings how often at most \param width the interval is narrow enough when it is no longer than that
/// \param middle of two ends
template <typename Predicate, typename Middle>
[[nodiscard]] Bracket bisect(Bracket within, int halvings, const Predicate& is_below, double width,
                             const Middle& middle) {
  for (int k = 0; k < halvings && within.high - within.low > width; ++k) {
    const double at = middle(within.low, within.high);
    (is_below(at) ? within.low : within.high) = at;
  }
  return within;
}

template <typename Predicate>
[[nodiscard]] Bracket bisect(Bracket within, int halvings, const Predicate& is_below, double width = 0) {
  return bisect(within, halvings, is_below, width, [](double low, double high) { return (low + high) / 2; });
}

}  // namespace lobe
