#include "tools/meshcomplete/suggest.h"

#include <algorithm>
#include <vector>

namespace meshcomplete {
namespace runner {

namespace {

/// Edit distance with swaps of neighbours (optimal string alignment).
int distance(const QString& a, const QString& b) {
  const int n = a.size(), m = b.size();
  std::vector<std::vector<int>> cost(std::size_t(n + 1), std::vector<int>(std::size_t(m + 1)));
  for (int i = 0; i <= n; ++i) cost[std::size_t(i)][0] = i;
  for (int j = 0; j <= m; ++j) cost[0][std::size_t(j)] = j;
  for (int i = 1; i <= n; ++i) {
    for (int j = 1; j <= m; ++j) {
      const std::size_t row = std::size_t(i), column = std::size_t(j);
      int best = std::min(cost[row - 1][column], cost[row][column - 1]) + 1;
      best = std::min(best, cost[row - 1][column - 1] + (a[i - 1] != b[j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        best = std::min(best, cost[row - 2][column - 2] + 1);
      cost[row][column] = best;
    }
  }
  return cost[std::size_t(n)][std::size_t(m)];
}

}  // namespace

QString nearest(const QString& word, const QStringList& candidates) {
  const QString given = word.toLower();
  QString best;
  int best_distance = std::max(2, int(given.size()) / 2) + 1;
  for (const QString& candidate : candidates) {
    const QString lower = candidate.toLower();
    // Part of a longer name ("curve unfolding") is what people type; it counts as nearly right.
    const bool part = given.size() >= 3 && lower.contains(given);
    const int d = part ? 1 : distance(given, lower);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

QString did_you_mean(const QString& word, const QStringList& candidates) {
  const QString best = nearest(word, candidates);
  return best.isEmpty() ? QString() : " Did you mean \"" + best + "\"?";
}

}  // namespace runner
}  // namespace meshcomplete
