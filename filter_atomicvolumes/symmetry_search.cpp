#include "filter_atomicvolumes/symmetry_search.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "common/core/threads.h"
#include "filter_atomicvolumes/symmetry_starts.h"

namespace meshcomplete {
namespace {

// The best first, once sorted.
using Candidates = std::vector<FoundPose>;

// How many candidates a stage hands on. Small turns must not crowd out large ones, which take more to the
// wrong place; hence a limit for rotations of one fold.
struct Limits {
  std::size_t all = 0;
  std::size_t of_a_fold = 0;
  double apart = 0;  // in diagonals; of candidates that are nearer to each other only the best stays
};

// Efforts, chosen such that a search takes about half a second. Strides are those of 4096 samples.
constexpr std::size_t starts_looked_at_twice = 4000;
constexpr Limits starts_kept{300, 40, 0.05};
constexpr Limits roughly_registered_kept{24, 4, 0.01};
constexpr Limits finalists{6, 2, 0.003};
constexpr std::size_t stride_of_64 = 64, stride_of_256 = 16, stride_of_1024 = 4, stride_of_all = 1;
constexpr int finishing_steps = 15;

// How far an image may be off, in diagonals: a start, whose neighbours are 0.06 away, and what has been
// registered by the table, which is good to a hundredth or so.
constexpr double radius_of_starts = 0.03;
constexpr double radius_of_registered = 0.015;
// Powers of one rotation differ in closeness by the sampling, and by less than this.
constexpr double as_close = 0.99;
// A row agrees less with its shift by one part than with that by two, whose images leave it; by less than
// this.
constexpr double as_good_for_a_row = 0.9;
constexpr int most_parts = 4;

// Calls body(i) for 0 to count - 1, in threads.
template <class Body>
void for_each(std::size_t count, const Progress& progress, const Body& body) {
  constexpr std::size_t tasks = 256;  // enough to share evenly, few enough to cost nothing
  for_ranges(count, std::max<std::size_t>(1, count / tasks), progress,
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i) body(i);
               progress.advance(static_cast<double>(end - begin) / static_cast<double>(count));
             });
}

// Equal ones stay in the order of the starts, so that threads make no difference.
void sort_by_score(Candidates& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const FoundPose& a, const FoundPose& b) { return a.fit.score > b.fit.score; });
}

// Images of the corners of the bounding box: two motions are as far apart as these are.
using Corners = Eigen::Matrix<double, 3, 8>;

Corners corners_under(const SymmetryPose& pose, const Vector3& half_size) {
  const SymmetryMotion motion(pose);
  Corners corners;
  for (int i = 0; i < 8; ++i) {
    const Vector3 signs((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, (i & 4) ? 1 : -1);
    corners.col(i) = motion(signs.cwiseProduct(half_size));
  }
  return corners;
}

class Search {
 public:
  Search(const SampledSurface& surface, const SymmetryDetectionOptions& options)
      : surface_(surface), options_(options) {}
  std::optional<FoundPose> best(const Progress& progress) const;

 private:
  std::vector<SymmetryPose> starts() const;
  Candidates promising_starts(const Progress& progress) const;
  void register_roughly(Candidates& candidates, const Progress& progress) const;
  void register_exactly(Candidates& candidates, const Progress& progress) const;
  FoundPose finished(const SymmetryPose& pose) const;
  bool is_acceptable(const FoundPose& candidate) const;
  void keep_distinct(Candidates& candidates, const Limits& limits) const;
  FoundPose fundamental(const FoundPose& best) const;

  const SampledSurface& surface_;
  const SymmetryDetectionOptions& options_;
};

std::vector<SymmetryPose> Search::starts() const {
  switch (options_.kind) {
    case SymmetryKind::reflection:
      return reflection_starts(surface_);
    case SymmetryKind::rotation:
      return rotation_starts(surface_, options_.highest_fold);
    case SymmetryKind::translation:
      return translation_starts(surface_, options_.least_shift);
  }
  return {};
}

// Also drops the short translations, which registration may have taken to the identity.
void Search::keep_distinct(Candidates& candidates, const Limits& limits) const {
  sort_by_score(candidates);
  Candidates kept;
  std::vector<Corners> images;
  std::map<int, std::size_t> of_fold;
  for (const FoundPose& candidate : candidates) {
    if (kept.size() == limits.all) break;
    const SymmetryPose& pose = candidate.pose;
    if (pose.kind == SymmetryKind::translation && !(pose.point.norm() > options_.least_shift)) continue;
    if (pose.kind == SymmetryKind::rotation && of_fold[pose.fold] == limits.of_a_fold) continue;
    const Corners corners = corners_under(pose, surface_.half_size());
    const bool is_new = std::all_of(images.begin(), images.end(), [&](const Corners& other) {
      return (corners - other).colwise().squaredNorm().maxCoeff() > limits.apart * limits.apart;
    });
    if (!is_new) continue;
    ++of_fold[pose.fold];
    kept.push_back(candidate);
    images.push_back(corners);
  }
  candidates = std::move(kept);
}

Candidates Search::promising_starts(const Progress& progress) const {
  const std::vector<SymmetryPose> poses = starts();
  Candidates candidates(poses.size());
  const auto look = [&](std::size_t i, std::size_t stride) {
    candidates[i].fit = fit_of(surface_, candidates[i].pose, Neighbours::rough, radius_of_starts, stride);
  };
  for (std::size_t i = 0; i < poses.size(); ++i) candidates[i].pose = poses[i];
  for_each(candidates.size(), progress.part(0, 0.8, "looking for symmetries"),
           [&](std::size_t i) { look(i, stride_of_64); });
  sort_by_score(candidates);
  if (candidates.size() > starts_looked_at_twice) candidates.resize(starts_looked_at_twice);
  for_each(candidates.size(), progress.part(0.8, 1, "looking for symmetries"),
           [&](std::size_t i) { look(i, stride_of_256); });
  keep_distinct(candidates, starts_kept);
  return candidates;
}

void Search::register_roughly(Candidates& candidates, const Progress& progress) const {
  const std::vector<double> radii = {0.12, 0.12, 0.1, 0.1, 0.08, 0.08, 0.06, 0.06, 0.04, 0.04, 0.03, 0.03};
  for_each(candidates.size(), progress, [&](std::size_t i) {
    SymmetryPose& pose = candidates[i].pose;
    pose = registered(surface_, pose, Neighbours::rough, radii, stride_of_256);
    candidates[i].fit = fit_of(surface_, pose, Neighbours::rough, radius_of_registered, stride_of_1024);
  });
  keep_distinct(candidates, roughly_registered_kept);
}

void Search::register_exactly(Candidates& candidates, const Progress& progress) const {
  const double t = options_.tolerance;
  const std::vector<double> radii = {4 * t, 3 * t, 3 * t, 2 * t, 2 * t, 2 * t};
  for_each(candidates.size(), progress.part(0, 0.4, "registering"), [&](std::size_t i) {
    SymmetryPose& pose = candidates[i].pose;
    pose = registered(surface_, pose, Neighbours::exact, radii, stride_of_256);
    candidates[i].fit = fit_of(surface_, pose, Neighbours::exact, t, stride_of_1024);
  });
  keep_distinct(candidates, finalists);
  for_each(candidates.size(), progress.part(0.4, 1, "registering"),
           [&](std::size_t i) { candidates[i] = finished(candidates[i].pose); });
  keep_distinct(candidates, finalists);
}

// Registered until it settles, and judged by all samples.
FoundPose Search::finished(const SymmetryPose& pose) const {
  const std::vector<double> radii(finishing_steps, 2 * options_.tolerance);
  FoundPose done;
  done.pose = registered(surface_, pose, Neighbours::exact, radii, stride_of_1024);
  done.fit = fit_of(surface_, done.pose, Neighbours::exact, options_.tolerance, stride_of_all);
  return done;
}

bool Search::is_acceptable(const FoundPose& candidate) const {
  return candidate.fit.support >= options_.least_support &&
         candidate.fit.agreement >= options_.least_agreement;
}

// The shift by one part of a row, when `best` is the shift by several.
FoundPose Search::fundamental(const FoundPose& best) const {
  for (int parts = most_parts; parts > 1; --parts) {
    SymmetryPose pose = best.pose;
    pose.point /= parts;
    if (!(pose.point.norm() > options_.least_shift)) continue;
    const FoundPose shorter = finished(pose);
    // Still the same part of the way, not what it has slid to.
    if ((shorter.pose.point - pose.point).norm() < 2 * options_.tolerance && is_acceptable(shorter) &&
        shorter.fit.score >= as_good_for_a_row * best.fit.score)
      return shorter;
  }
  return best;
}

std::optional<FoundPose> Search::best(const Progress& progress) const {
  Candidates candidates = promising_starts(progress.part(0, 0.5, "looking for symmetries"));
  register_roughly(candidates, progress.part(0.5, 0.7, "registering"));
  register_exactly(candidates, progress.part(0.7, 1, "registering"));
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [&](const FoundPose& candidate) { return !is_acceptable(candidate); }),
                   candidates.end());
  if (candidates.empty()) return std::nullopt;
  FoundPose best = candidates.front();
  if (options_.kind == SymmetryKind::translation) return fundamental(best);
  for (const FoundPose& other : candidates)
    if (other.pose.fold > best.pose.fold &&
        other.fit.closeness >= as_close * candidates.front().fit.closeness)
      best = other;
  return best;
}

}  // namespace

std::optional<FoundPose> search_symmetry(const SampledSurface& surface,
                                         const SymmetryDetectionOptions& options, const Progress& progress) {
  return Search(surface, options).best(progress);
}

}  // namespace meshcomplete
