#include "filter_volmorph/loop_shortening.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace meshcomplete {
namespace {

// Vertices of a loop, evenly spread, through which a shorter one is looked for.
constexpr std::size_t places = 4;

// Of a loop's length: what has to be gained for another round. Rounding is far below it.
constexpr double least_gain = 1e-3;

// Of vertices that a search visits: all that a loop of about a hundred edges can be shortened by. Larger
// loops are no spurious handles, and searching all round them would take longer than all else.
constexpr std::size_t most_settled = 20000;

constexpr Index none = 0xffffffffu;
constexpr std::size_t between_checks = 1 << 12;

}  // namespace

LoopShortener::LoopShortener(const CappedSurface& surface, const std::vector<double>& lengths)
    : surface_(surface),
      lengths_(lengths),
      odd_(surface.opposite.size(), 0),
      stamp_(2 * surface.outgoing.size(), 0),
      distance_(stamp_.size()),
      entering_(stamp_.size()) {}

void LoopShortener::toggle(const std::vector<Index>& crossed) {
  for (const Index h : crossed)
    for (const Index half_edge : {h, surface_.opposite[h]}) odd_[half_edge] ^= 1;
}

void LoopShortener::begin(Node root) {
  ++round_;
  stamp_[root] = round_;
  distance_[root] = 0;
  entering_[root] = none;
}

std::vector<Index> LoopShortener::path_to(Node node) const {
  std::vector<Index> path;
  while (entering_[node] != none) {
    const Index h = entering_[node];
    path.push_back(h);
    node = 2 * surface_.origin[h] + ((node & 1) ^ Node(odd_[h]));
  }
  std::reverse(path.begin(), path.end());
  return path;
}

SurfaceLoop LoopShortener::loop_at(const Meeting& meeting) const {
  const std::vector<Index> there = path_to(meeting.from), back = path_to(meeting.to);
  std::size_t common = 0;  // of the two ways
  while (common < there.size() && common < back.size() && there[common] == back[common]) ++common;
  SurfaceLoop loop;
  loop.half_edges.assign(there.begin() + common, there.end());
  loop.half_edges.push_back(meeting.half_edge);
  for (std::size_t i = back.size(); i-- > common;) loop.half_edges.push_back(surface_.opposite[back[i]]);
  for (const Index h : loop.half_edges) loop.length += lengths_[h];
  return loop;
}

bool LoopShortener::shorten_through(Index vertex, SurfaceLoop& loop, const Progress& progress) {
  using Arrival = std::pair<double, Node>;
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<Arrival>> queue;
  begin(2 * vertex);
  queue.push({0, 2 * vertex});
  Meeting best{loop.length};
  std::size_t settled = 0;
  // Two halves of a loop shorter than the best meet before either is half as long.
  while (!queue.empty() && 2 * queue.top().first < best.length && settled < most_settled) {
    const auto [distance, node] = queue.top();
    queue.pop();
    if (distance > distance_[node]) continue;
    if (settled++ % between_checks == 0) progress.check();
    const Index first = surface_.outgoing[node / 2];
    Index h = first;
    do {
      const double there = distance + lengths_[h];
      const Node same = 2 * surface_.target(h) + ((node & 1) ^ Node(odd_[h])), other = same ^ 1;
      if (reached(other) && there + distance_[other] < best.length)
        best = {there + distance_[other], node, h, other};
      if (2 * there < best.length && (!reached(same) || there < distance_[same])) {
        stamp_[same] = round_;
        distance_[same] = there;
        entering_[same] = h;
        queue.push({there, same});
      }
      h = surface_.turned(h);
    } while (h != first);
  }
  if (!(best.length < loop.length)) return false;
  loop = loop_at(best);
  return true;
}

SurfaceLoop LoopShortener::shortened(SurfaceLoop loop, const std::vector<Index>& crossed,
                                     const Progress& progress) {
  toggle(crossed);
  for (double before = 2 * loop.length; loop.length < (1 - least_gain) * before;) {
    before = loop.length;
    const std::vector<Index> path = loop.half_edges;
    for (std::size_t i = 0; i < std::min(places, path.size()); ++i)
      shorten_through(surface_.origin[path[i * path.size() / std::min(places, path.size())]], loop, progress);
  }
  toggle(crossed);
  return loop;
}

}  // namespace meshcomplete
