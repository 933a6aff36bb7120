#include "filter_volmorph/handle_loops.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "filter_volmorph/loop_shortening.h"

namespace meshcomplete {
namespace {

// Numbers of loops, ascending: their sum, where what is named twice is gone.
using Sum = std::vector<Index>;

void add(Sum& sum, const Sum& other) {
  Sum result;
  result.reserve(sum.size() + other.size());
  std::set_symmetric_difference(sum.begin(), sum.end(), other.begin(), other.end(),
                                std::back_inserter(result));
  sum.swap(result);
}

// A sum of loops that is compared with many others.
class MarkedSum {
 public:
  MarkedSum(std::vector<char>& marks, const Sum& sum) : marks_(marks), sum_(sum) {
    for (const Index loop : sum_) marks_[loop] = 1;
  }
  MarkedSum(const MarkedSum&) = delete;
  MarkedSum& operator=(const MarkedSum&) = delete;
  ~MarkedSum() {
    for (const Index loop : sum_) marks_[loop] = 0;
  }

  // Whether it has an odd number of loops in common with the other.
  bool odd_overlap(const Sum& other) const {
    char odd = 0;
    for (const Index loop : other) odd ^= marks_[loop];
    return odd != 0;
  }

 private:
  std::vector<char>& marks_;  // of all loops
  const Sum& sum_;
};

class HandleFinder {
 public:
  HandleFinder(const CappedSurface& surface, const std::vector<double>& lengths,
               const std::vector<SurfaceLoop>& basis)
      : surface_(surface), shortener_(surface, lengths), basis_(basis.size()), sums_(basis.size()) {
    for (const SurfaceLoop& loop : basis) insert(loop);
    for (Index i = 0; i < basis_; ++i) sums_[i] = {i};
  }

  std::vector<SurfaceLoop> find(const Progress& progress) {
    for (Index i = 0; i < basis_; ++i) {
      progress.update(0.1 * double(i) / double(basis_));
      crossings_.push_back(crossed_by(beside_[i]));
    }
    std::vector<SurfaceLoop> found;
    for (Index first = 0; first < basis_; ++first) {
      // What is zero when led round the handles that were found is theirs.
      while (!crossings_[first].empty()) {
        progress.update(0.1 + 0.9 * 2 * double(found.size()) / double(basis_));
        found.push_back(take_handle(first, crossings_[first].front(), progress));
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const SurfaceLoop& a, const SurfaceLoop& b) { return a.length < b.length; });
    return found;
  }

 private:
  struct Pair {
    Sum loop, partner;
  };

  Index edge_of(Index h) const { return std::min(h, surface_.opposite[h]); }

  void insert(const SurfaceLoop& loop) {
    for (const Index h : loop.half_edges) at_edge_[edge_of(h)].push_back(Index(loops_.size()));
    loops_.push_back(loop);
    beside_.push_back(edges_beside(surface_, loop));
    marks_.push_back(0);
  }

  // The loops that a loop, given by what is beside it, crosses an odd number of times, as they were at first.
  Sum crossed_by(const std::vector<Index>& beside) const {
    Sum met;
    for (const Index h : beside) {
      const auto at = at_edge_.find(edge_of(h));
      if (at != at_edge_.end()) met.insert(met.end(), at->second.begin(), at->second.end());
    }
    std::sort(met.begin(), met.end());
    Sum odd;
    for (std::size_t from = 0, to = 0; from < met.size(); from = to) {
      while (to < met.size() && met[to] == met[from]) ++to;
      if ((to - from) % 2 == 1) odd.push_back(met[from]);
    }
    return odd;
  }

  std::vector<Index> edges_beside_all(const Sum& sum) const {
    std::vector<Index> edges;
    for (const Index loop : sum) edges.insert(edges.end(), beside_[loop].begin(), beside_[loop].end());
    return edges;
  }

  SurfaceLoop shortened(Index loop, const Sum& across, const Progress& progress) {
    return shortener_.shortened(loops_[loop], edges_beside_all(across), progress);
  }

  // Inserts a loop that crosses others, as they were, and returns it led round the handles found.
  Sum led_round_others(const SurfaceLoop& loop, const Sum& crossed) {
    Sum sum = {Index(loops_.size())};
    {
      const MarkedSum marked(marks_, crossed);
      for (const Pair& before : pairs_) {
        const bool with_loop = marked.odd_overlap(before.loop);
        if (marked.odd_overlap(before.partner)) add(sum, before.loop);
        if (with_loop) add(sum, before.partner);
      }
    }
    insert(loop);
    return sum;
  }

  // The shorter one of two loops that cross; its partner is the shortest that can be found across it, so that
  // the next handles' loops are led round both by the shortest way.
  SurfaceLoop take_handle(Index first, Index second, const Progress& progress) {
    const SurfaceLoop a = shortened(first, sums_[second], progress);
    const SurfaceLoop b = shortened(second, sums_[first], progress);
    const bool a_is_short = a.length <= b.length;
    const SurfaceLoop loop = a_is_short ? a : b;
    Pair pair;
    pair.loop = led_round_others(loop, crossed_by(edges_beside(surface_, loop)));
    const SurfaceLoop partner = shortened(a_is_short ? second : first, pair.loop, progress);
    const Sum crossed_by_partner = crossed_by(edges_beside(surface_, partner));
    const Sum across_loop = basis_across(crossed_by(beside_.back())),
              across_partner = basis_across(crossed_by_partner);
    pair.partner = led_round_others(partner, crossed_by_partner);
    for (const Index i : across_loop) {
      add(crossings_[i], across_partner);
      add(sums_[i], pair.partner);
    }
    for (const Index i : across_partner) {
      add(crossings_[i], across_loop);
      add(sums_[i], pair.loop);
    }
    pairs_.push_back(std::move(pair));
    return loop;
  }

  // Those of the basis, as they are now, that a loop crosses; `crossed`: those that it crosses as they were.
  Sum basis_across(const Sum& crossed) {
    Sum across;
    const MarkedSum marked(marks_, crossed);
    for (Index i = 0; i < basis_; ++i)
      if (marked.odd_overlap(sums_[i])) across.push_back(i);
    return across;
  }

  const CappedSurface& surface_;
  LoopShortener shortener_;
  std::size_t basis_;                       // loops at first
  std::vector<SurfaceLoop> loops_;          // the basis, then those of the handles found
  std::vector<std::vector<Index>> beside_;  // each of them: `edges_beside`
  std::vector<char> marks_;                 // each of them: for `MarkedSum`, else 0
  std::unordered_map<Index, Sum> at_edge_;
  std::vector<Sum> sums_;       // what each loop of the basis is now, led round the handles found
  std::vector<Sum> crossings_;  // with which others of the basis, as they are now, each crosses
  std::vector<Pair> pairs_;     // of the handles found
};

}  // namespace

std::vector<SurfaceLoop> loops_of_handles(const CappedSurface& surface, const std::vector<double>& lengths,
                                          const std::vector<SurfaceLoop>& basis, const Progress& progress) {
  return HandleFinder(surface, lengths, basis).find(progress);
}

}  // namespace meshcomplete
