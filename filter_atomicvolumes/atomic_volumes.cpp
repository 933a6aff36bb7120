#include "filter_atomicvolumes/atomic_volumes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "common/core/completion_oracle.h"
#include "common/core/hole_targets.h"
#include "common/core/mesh_topology.h"
#include "common/core/parameter_checks.h"
#include "common/core/patch_check.h"
#include "common/core/patch_pieces.h"
#include "common/core/piece_finishing.h"
#include "common/core/piece_results.h"
#include "common/core/sheets.h"
#include "common/core/stage_clock.h"
#include "common/core/threads.h"
#include "filter_atomicvolumes/bubbles.h"
#include "filter_atomicvolumes/divisible_mesh.h"
#include "filter_atomicvolumes/solution_poll.h"
#include "filter_atomicvolumes/volume_solution.h"

namespace meshcomplete {
namespace {

// Octrees more that are tried for holes that the best one left open.
constexpr int most_retries = 2;

// Of meshes with longer boundaries several octrees take too much memory.
constexpr std::size_t most_edges_at_once = 10000;

const char* const undivided =
    "space round this rim could not be divided: faces touch or intersect each other there, or "
    "MaxDepth is too small";

double area(const LabelledSurface& surface) {
  double twice = 0;
  for (const Triangle& t : surface.triangles) {
    const Vector3& p = surface.vertices[t[0]].position;
    twice += (surface.vertices[t[1]].position - p).cross(surface.vertices[t[2]].position - p).norm();
  }
  return 0.5 * twice;
}

class Run {
 public:
  Run(const TriangleMesh& mesh, const OpenMesh& open, const AtomicVolumesOptions& options,
      CompletionReport& report)
      : mesh_(mesh),
        open_(open),
        topology_(open.topology),
        loops_(open.loops),
        loop_numbers_(mesh, open.loops),
        options_(options),
        input_(mesh),
        report_(report) {}

  bool anything_to_do() const { return std::any_of(report_.holes.begin(), report_.holes.end(), is_targeted); }
  AtomicVolumesFigures close(const Progress& progress);
  AtomicVolumesResult result(CompletionReport report);

 private:
  /// What space is divided by.
  const TriangleMesh& divided_mesh() const { return divisible_ ? divisible_->mesh : mesh_; }
  const MeshTopology& divided_topology() const { return divisible_ ? divisible_->topology : topology_; }
  const InputNeighbourhood& divided() const { return divisible_ ? divisible_->neighbourhood : input_; }
  const ImplicitFunction* oracle() const { return oracle_ ? &*oracle_ : nullptr; }
  VolumeSolution solve(int shift, const AtomicVolumesOptions& options, const PreparedConstraints& constraints,
                       const Progress& progress) const;
  std::vector<Sheet> sheets_of(const LabelledSurface& surface) const;
  std::vector<PatchPiece> pieces_of(const LabelledSurface& surface) const;
  SolutionVote vote(std::size_t shift, const VolumeSolution& solution) const;
  VolumeSolution best_solution(const PreparedConstraints& constraints, const Progress& progress) const;
  std::vector<char> left_open() const;
  std::size_t exchange(const std::vector<char>& gone, std::vector<PatchPiece> others);
  std::size_t replace(std::vector<PatchPiece> fresh, const std::vector<char>& open);
  bool close_with_triangles(const Progress& progress);
  bool try_others(const PreparedConstraints& constraints, const PieceFinisher& finisher,
                  const Progress& progress);

  const TriangleMesh& mesh_;
  const OpenMesh& open_;
  const MeshTopology& topology_;
  const std::vector<BoundaryLoop>& loops_;
  const LoopNumbers loop_numbers_;
  const AtomicVolumesOptions& options_;
  const InputNeighbourhood input_;
  std::unique_ptr<DivisibleMesh> divisible_;  // null: space is divided by the mesh itself
  std::optional<OctreeField> oracle_;         // for the weight that asks for one
  CompletionReport& report_;
  std::vector<PatchPiece> pieces_;
  std::vector<char> blocked_;  // loops whose patch has another one in it that is not to be closed
};

VolumeSolution Run::solve(int shift, const AtomicVolumesOptions& options,
                          const PreparedConstraints& constraints, const Progress& progress) const {
  return solve_volumes(divided_mesh(), divided_topology(), divided(), options, constraints,
                       seed_of_division(options, shift), oracle(), progress);
}

std::vector<Sheet> Run::sheets_of(const LabelledSurface& surface) const {
  return split_into_sheets(divided_mesh(), divided_topology(), separating(surface), mesh_);
}

std::vector<PatchPiece> Run::pieces_of(const LabelledSurface& surface) const {
  return make_pieces(sheets_of(surface), topology_, loop_numbers_);
}

SolutionVote Run::vote(std::size_t shift, const VolumeSolution& solution) const {
  SolutionVote vote;
  vote.number = shift;
  // With hints a smaller patch may cost more, and one that keeps to the oracle may be larger.
  const bool by_area = solution.ties.empty() && !oracle_;
  vote.cost = by_area ? area(solution.surface) : solution.labelling.weight;
  const std::vector<PatchPiece> pieces = pieces_of(solution.surface);
  for (const std::vector<std::size_t>& group : group_by_loops(pieces)) {
    std::vector<std::size_t> loops = loops_of(pieces, group);
    if (flaw_of(pieces, group, loops_) != Sheet::Flaw::none)
      for (std::size_t loop : loops)
        if (is_targeted(report_.holes[loop])) vote.flawed_edges += loops_[loop].faces.size();
    loops.push_back(group.size());
    vote.partition.push_back(std::move(loops));
  }
  std::sort(vote.partition.begin(), vote.partition.end());
  return vote;
}

// Makes the divisions in threads.
VolumeSolution Run::best_solution(const PreparedConstraints& constraints, const Progress& progress) const {
  const std::size_t shifts = static_cast<std::size_t>(options_.shifts);
  std::mutex mutex;
  SolutionPoll poll;
  // Large octrees one after the other, for the memory's sake: most of the work on each is in threads already.
  const std::size_t grain = topology_.boundary_half_edges.size() > most_edges_at_once ? shifts : 1;
  for_each(shifts, grain, progress, [&](std::size_t shift) {
    const double from = static_cast<double>(shift) / options_.shifts, to = (shift + 1.0) / options_.shifts;
    VolumeSolution one =
        solve(static_cast<int>(shift), options_, constraints, progress.part(from, to, "dividing space"));
    SolutionVote vote = shifts > 1 ? this->vote(shift, one) : SolutionVote();
    const std::lock_guard<std::mutex> lock(mutex);
    poll.hear(std::move(vote), std::move(one));
  });
  std::optional<VolumeSolution> best = poll.take();
  if (!best)
    best.emplace(
        solve(static_cast<int>(poll.winner()), options_, constraints, progress.part(1, 1, "dividing space")));
  smooth(*best, options_, constraints, oracle(), progress.part(1, 1, "smoothing the patches"));
  return std::move(*best);
}

// The loops that another octree, or a patch that joins less, may close. Where space could not be divided in
// one of several octrees, it could not in any of them, or another one would have been taken; but other rims
// that the same patch reaches may be closed without it.
std::vector<char> Run::left_open() const {
  const bool may_divide = options_.shifts == 1;
  std::vector<char> open(loops_.size(), 0), reached(loops_.size(), 0);
  for (const std::vector<std::size_t>& group : group_by_loops(pieces_)) {
    const bool defect =
        std::any_of(group.begin(), group.end(), [&](std::size_t i) { return !pieces_[i].defect.empty(); });
    const std::vector<std::size_t> loops = loops_of(pieces_, group);
    for (std::size_t loop : loops) {
      reached[loop] = 1;
      open[loop] = defect || blocked_[loop] ||
                   ((may_divide || loops.size() > 1) && report_.holes[loop].reason == undivided);
    }
  }
  for (std::size_t i = 0; i < loops_.size(); ++i) open[i] |= is_targeted(report_.holes[i]) && !reached[i];
  return open;
}

// Takes out the pieces that are marked and adds others. Returns the number of the first of these.
std::size_t Run::exchange(const std::vector<char>& gone, std::vector<PatchPiece> others) {
  std::vector<PatchPiece> all;
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    if (!gone[i]) all.push_back(std::move(pieces_[i]));
  const std::size_t first = all.size();
  std::move(others.begin(), others.end(), std::back_inserter(all));
  pieces_ = std::move(all);
  return first;
}

// Puts those of the fresh pieces that close open loops only in the place of the pieces there. Returns the
// number of the first of them: they are the last ones then.
std::size_t Run::replace(std::vector<PatchPiece> fresh, const std::vector<char>& open) {
  std::vector<char> taken(loops_.size(), 0);
  std::vector<PatchPiece> usable;
  for (const std::vector<std::size_t>& group : group_by_loops(fresh)) {
    const std::vector<std::size_t> loops = loops_of(fresh, group);
    if (flaw_of(fresh, group, loops_) != Sheet::Flaw::none) continue;
    const auto is_open = [&](std::size_t loop) { return open[loop] != 0; };
    if (std::none_of(loops.begin(), loops.end(), is_open) ||
        !std::all_of(loops.begin(), loops.end(), [&](std::size_t loop) {
          return is_open(loop) || may_join(loops_[loop], report_.holes[loop]);
        }))
      continue;
    for (std::size_t loop : loops) taken[loop] = 1;
    for (std::size_t i : group) {
      fresh[i].wanted = true;
      usable.push_back(std::move(fresh[i]));
    }
  }
  std::vector<char> gone(pieces_.size(), 0);
  for (const std::vector<std::size_t>& group : group_by_loops(pieces_)) {
    const std::vector<std::size_t> loops = loops_of(pieces_, group);
    if (std::none_of(loops.begin(), loops.end(), [&](std::size_t loop) { return taken[loop] != 0; }))
      continue;
    std::string defect;
    for (std::size_t i : group) {
      if (defect.empty()) defect = pieces_[i].defect;
      gone[i] = 1;
    }
    for (std::size_t loop : loops)
      if (!taken[loop] && is_targeted(report_.holes[loop])) report_.holes[loop].reason = defect;
  }
  const std::size_t first = exchange(gone, std::move(usable));
  for (std::size_t loop = 0; loop < loops_.size(); ++loop)
    if (taken[loop] && open[loop]) report_.holes[loop].reason.clear();
  return first;
}

// Closes what it can of the open loops with the pieces of other octrees. Whether it tried.
bool Run::try_others(const PreparedConstraints& constraints, const PieceFinisher& finisher,
                     const Progress& progress) {
  const char* const stage = "trying another octree";
  std::vector<char> open = left_open();
  // The least area joins the fewest rims.
  const bool any_blocked = std::find(blocked_.begin(), blocked_.end(), 1) != blocked_.end();
  int tries = 0;
  for (; tries < most_retries && std::find(open.begin(), open.end(), 1) != open.end(); ++tries) {
    const Progress part = progress.part(1.0 * tries / most_retries, (tries + 1.0) / most_retries, stage);
    std::vector<PatchPiece> fresh;
    {
      AtomicVolumesOptions options = options_;
      if (any_blocked || tries > 0) options.weight = CutWeight::area;
      VolumeSolution solution =
          solve(options_.shifts + tries, options, constraints, part.part(0, 0.5, stage));
      smooth(solution, options, constraints, oracle(), part.part(0.5, 0.5, stage));
      fresh = pieces_of(solution.surface);
    }
    const std::size_t first = replace(std::move(fresh), open);
    finisher.finish(pieces_, first, part.part(0.5, 1, stage));
    finisher.separate(pieces_, part.part(1, 1, stage));
    for (const std::vector<std::size_t>& group : group_by_loops(pieces_))
      if (group.front() >= first &&
          std::all_of(group.begin(), group.end(), [&](std::size_t i) { return pieces_[i].defect.empty(); }))
        for (std::size_t loop : loops_of(pieces_, group)) open[loop] = 0;
  }
  return tries > 0;
}

// A rim of three edges has but one patch without new vertices. Where the volumes gave none it is tried.
// Whether any was taken.
bool Run::close_with_triangles(const Progress& progress) {
  std::vector<char> closed(loops_.size(), 0), shared(loops_.size(), 0), gone(pieces_.size(), 0);
  std::vector<std::size_t> own(loops_.size(), pieces_.size());  // the piece that closes this loop only
  for (const std::vector<std::size_t>& group : group_by_loops(pieces_)) {
    const std::vector<std::size_t> loops = loops_of(pieces_, group);
    for (std::size_t loop : loops) {
      shared[loop] = loops.size() > 1 || group.size() > 1;
      own[loop] = group.front();
      closed[loop] = pieces_[group.front()].wanted && pieces_[group.front()].defect.empty();
    }
  }
  std::vector<PatchPiece> triangles;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    HoleReport& hole = report_.holes[i];
    const bool left = is_targeted(hole) || hole.reason == undivided;
    if (loops_[i].vertices.size() != 3 || !left || closed[i] || shared[i]) continue;
    PatchPiece piece;
    piece.loops = {i};
    piece.wanted = true;
    piece.route = "one triangle";
    piece.patch.input_vertices = static_cast<Index>(mesh_.vertices.size());
    piece.patch.triangles = {{loops_[i].vertices[0], loops_[i].vertices[1], loops_[i].vertices[2]}};
    if (!check_patch(input_, piece.patch, {&loops_[i]}, progress).passed()) continue;
    hole.reason.clear();
    if (own[i] < pieces_.size()) gone[own[i]] = 1;
    triangles.push_back(std::move(piece));
  }
  const bool any = !triangles.empty();
  exchange(gone, std::move(triangles));
  return any;
}

AtomicVolumesFigures Run::close(const Progress& progress) {
  StageClock clock(report_);
  divisible_ = make_divisible(mesh_, topology_, input_, progress);
  if (divisible_ && divisible_->merged) refuse_sewn_rims(mesh_, divisible_->topology, loops_, report_.holes);
  if (options_.weight == CutWeight::poisson) {
    oracle_ =
        make_completion_oracle(mesh_, open_, input_, {}, {}, progress.part(0, 0.1, "building the oracle"))
            .field;
    clock.end_of("building the oracle");
  }
  const PreparedConstraints constraints(divided_mesh(), divided_topology(), divided(), options_.constraints,
                                        progress.part(0, 0, ""));
  AtomicVolumesFigures figures;
  {
    const VolumeSolution solution = best_solution(constraints, progress.part(0.1, 0.4, "dividing space"));
    figures = solution.figures;
    std::vector<Sheet> sheets = sheets_of(solution.surface);
    for (const auto& notes :
         {constraints.notes(), solution.notes, describe_bubbles(sheets, options_.constraints)})
      report_.notes.insert(report_.notes.end(), notes.begin(), notes.end());
    pieces_ = make_pieces(std::move(sheets), topology_, loop_numbers_);
    blocked_ = choose_pieces(pieces_, loops_, report_.holes, undivided);
  }
  clock.end_of("dividing space and cutting");
  FinishingOptions finishing;
  finishing.remesh = options_.remesh;
  finishing.fairing = options_.fairing;
  finishing.edge_length = options_.edge_length;
  const PieceFinisher finisher(mesh_, topology_, input_, divided(), finishing);
  finisher.finish(pieces_, 0, progress.part(0.4, 0.8, "fairing the patches"));
  clock.end_of("fairing the patches");
  finisher.separate(pieces_, progress.part(0.8, 0.85, "comparing the patches"));
  clock.end_of("comparing the patches");
  if (try_others(constraints, finisher, progress.part(0.85, 1, "trying another octree")))
    clock.end_of("trying other octrees");
  if (close_with_triangles(progress))
    finisher.separate(pieces_, progress.part(1, 1, "comparing the patches"));
  return figures;
}

AtomicVolumesResult Run::result(CompletionReport report) {
  AtomicVolumesResult result;
  result.completion = gather_pieces(mesh_, pieces_, std::move(report));
  return result;
}

}  // namespace

void check_options(const AtomicVolumesOptions& o) {
  require(!o.max_depth || (*o.max_depth >= 3 && *o.max_depth <= 30),
          "MaxDepth must lie between 3 and 30, or be 0 for as deep as the mesh needs.");
  require(o.node_budget >= 1000, "NodeBudget must be at least 1000.");
  require(o.shifts >= 1 && o.shifts <= 100, "Shifts must lie between 1 and 100.");
  require(o.smoothing_iterations >= 0 && o.smoothing_iterations <= 1000,
          "SmoothingIterations must lie between 0 and 1000.");
  require(!o.edge_length || (std::isfinite(*o.edge_length) && *o.edge_length > 0),
          "The edge length must be positive, or 0 for that of the mesh round the hole.");
  require(std::isfinite(o.constraints.hint_price) && o.constraints.hint_price > 0,
          "HintPrice must be positive.");
  require(std::isfinite(o.constraints.symmetry_price) && o.constraints.symmetry_price > 0,
          "SymmetryPrice must be positive.");
}

AtomicVolumesResult fill_by_atomic_volumes(const TriangleMesh& mesh, const MeshSelection& selection,
                                           const AtomicVolumesOptions& options, const Progress& progress) {
  check_options(options);
  CompletionReport report;
  StageClock clock(report);
  const OpenMesh open =
      find_holes(mesh, selection, options.holes, progress.part(0, 0.1, "finding the holes"));
  report.holes = open.holes;
  Run run(mesh, open, options, report);
  clock.end_of("finding the holes");
  AtomicVolumesFigures figures;
  if (run.anything_to_do()) figures = run.close(progress.part(0.1, 1, "dividing space"));
  progress.update(1);
  AtomicVolumesResult result = run.result(std::move(report));
  result.completion.report.figures = named(figures);
  result.figures = figures;
  return result;
}

}  // namespace meshcomplete
