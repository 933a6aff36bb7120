#include "filter_atomicvolumes/atomic_volumes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "common/core/error.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "common/core/triangle_intersection.h"
#include "filter_atomicvolumes/bubbles.h"
#include "filter_atomicvolumes/finishing.h"
#include "filter_atomicvolumes/hole_targets.h"
#include "filter_atomicvolumes/rim_patch.h"
#include "filter_atomicvolumes/sheets.h"
#include "filter_atomicvolumes/volume_solution.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

void require(bool condition, const char* message) {
  if (!condition) throw CompletionError("reading the parameters", message);
}

// Rounds in which patches that meet others are left as the faces of the volumes.
constexpr int most_separations = 3;

// Wall seconds between the ends of stages.
class StageClock {
 public:
  explicit StageClock(CompletionReport& report) : report_(report) {}
  void end_of(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    report_.stage_seconds.emplace_back(stage, std::chrono::duration<double>(now - start_).count());
    start_ = now;
  }

 private:
  CompletionReport& report_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A piece of the patch with the loops that it closes.
struct Piece {
  Sheet sheet;
  std::vector<std::size_t> loops;  // ascending
  bool wanted = false;
  std::optional<RimPatch> rough;  // faces of the volumes, joined to the mesh
  Patch patch;
  std::string route, defect;
};

class Run {
 public:
  Run(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<BoundaryLoop>& loops,
      const AtomicVolumesOptions& options, CompletionReport& report)
      : mesh_(mesh),
        topology_(topology),
        loops_(loops),
        options_(options),
        neighbourhood_(mesh),
        report_(report) {}

  bool anything_to_do() const { return std::any_of(report_.holes.begin(), report_.holes.end(), is_targeted); }
  VolumeSolution solve(const Progress& progress) const;
  void take_pieces(const LabelledSurface& surface);
  void finish_pieces(const Progress& progress);
  void separate(const Progress& progress);
  AtomicVolumesResult result(CompletionReport report);

 private:
  bool companion(std::size_t loop) const;
  std::vector<std::vector<std::size_t>> groups() const;
  void decide(const std::vector<std::size_t>& pieces, std::map<std::size_t, std::string>& reasons);
  FinishingOptions finishing() const { return {options_.remesh, options_.fairing, options_.edge_length}; }
  void prepare_piece(Piece& piece, const Progress& progress) const;
  void finish_piece(Piece& piece, const FinishingOptions& finishing, const std::vector<Corners>& obstacles,
                    const Progress& progress) const;
  std::vector<std::size_t> pieces_in_conflict(bool later_only) const;
  std::vector<Corners> obstacles_of(std::size_t piece) const;

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  const std::vector<BoundaryLoop>& loops_;
  const AtomicVolumesOptions& options_;
  const InputNeighbourhood neighbourhood_;
  CompletionReport& report_;
  std::vector<Piece> pieces_;
};

VolumeSolution Run::solve(const Progress& progress) const {
  const PreparedConstraints constraints(mesh_, topology_, neighbourhood_, options_.constraints,
                                        progress.part(0, 0, ""));
  std::optional<VolumeSolution> best;
  for (int shift = 0; shift < options_.shifts; ++shift) {
    const double from = static_cast<double>(shift) / options_.shifts, to = (shift + 1.0) / options_.shifts;
    VolumeSolution one =
        solve_volumes(mesh_, topology_, neighbourhood_, options_, constraints,
                      seed_of_division(options_, shift), progress.part(from, to, "dividing space"));
    if (!best || one.labelling.weight < best->labelling.weight) {
      best.reset();
      best.emplace(std::move(one));
    }
  }
  smooth(*best, options_, constraints, progress.part(1, 1, "smoothing the patches"));
  best->notes.insert(best->notes.begin(), constraints.notes().begin(), constraints.notes().end());
  return std::move(*best);
}

// A rim that no patch should close by itself, but that may be part of a larger hole: that of a single
// triangle.
bool Run::companion(std::size_t loop) const {
  return loops_[loop].defect == LoopDefect::isolated_triangle &&
         report_.holes[loop].reason == describe(LoopDefect::isolated_triangle);
}

void Run::take_pieces(const LabelledSurface& surface) {
  std::unordered_map<std::uint64_t, std::size_t> loop_of;  // by face and vertex where its edge begins
  for (std::size_t i = 0; i < loops_.size(); ++i)
    for (std::size_t k = 0; k < loops_[i].faces.size(); ++k)
      loop_of[static_cast<std::uint64_t>(loops_[i].faces[k]) << 32 |
              loops_[i].vertices[(k + 1) % loops_[i].vertices.size()]] = i;
  std::vector<Sheet> sheets = split_into_sheets(mesh_, topology_, surface);
  for (std::string& note : describe_bubbles(sheets, options_.constraints))
    report_.notes.push_back(std::move(note));
  for (Sheet& sheet : sheets) {
    Piece piece;
    for (Index h : sheet.closes) {
      const auto found =
          loop_of.find(static_cast<std::uint64_t>(h / 3) << 32 | mesh_.triangles[h / 3][h % 3]);
      if (found != loop_of.end()) piece.loops.push_back(found->second);
    }
    std::sort(piece.loops.begin(), piece.loops.end());
    piece.loops.erase(std::unique(piece.loops.begin(), piece.loops.end()), piece.loops.end());
    piece.sheet = std::move(sheet);
    // Pieces without a rim are bubbles.
    if (!piece.loops.empty()) pieces_.push_back(std::move(piece));
  }
  std::map<std::size_t, std::string> reasons;
  for (const std::vector<std::size_t>& group : groups()) decide(group, reasons);
  for (const auto& [loop, reason] : reasons)
    if (is_targeted(report_.holes[loop])) report_.holes[loop].reason = reason;
}

// Pieces that share a loop stand or fall together.
std::vector<std::vector<std::size_t>> Run::groups() const {
  std::vector<std::size_t> parent(pieces_.size());
  std::iota(parent.begin(), parent.end(), std::size_t(0));
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i];
    return i;
  };
  std::map<std::size_t, std::size_t> first;  // piece of each loop
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (std::size_t loop : pieces_[i].loops) {
      const auto [it, fresh] = first.try_emplace(loop, i);
      if (!fresh) parent[std::max(root(i), root(it->second))] = std::min(root(i), root(it->second));
    }
  std::map<std::size_t, std::vector<std::size_t>> by_root;
  for (std::size_t i = 0; i < pieces_.size(); ++i) by_root[root(i)].push_back(i);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [top, members] : by_root) groups.push_back(std::move(members));
  return groups;
}

void Run::decide(const std::vector<std::size_t>& group, std::map<std::size_t, std::string>& reasons) {
  std::vector<std::size_t> loops;
  bool whole = true, any_target = false;
  std::string reason;
  for (std::size_t i : group) {
    loops.insert(loops.end(), pieces_[i].loops.begin(), pieces_[i].loops.end());
    whole &= pieces_[i].sheet.whole;
  }
  for (std::size_t loop : loops) {
    const HoleReport& hole = report_.holes[loop];
    any_target |= is_targeted(hole);
    if (is_targeted(hole) || companion(loop) || !reason.empty()) continue;
    reason = hole.outcome == HoleOutcome::skipped
                 ? "one patch closes this hole and another that is to stay open (" + hole.reason + ")"
                 : "one patch closes this hole and another that cannot be closed (" + hole.reason + ")";
  }
  if (reason.empty() && !whole)
    reason =
        "space round this rim could not be divided: faces touch or intersect each other there, or MaxDepth "
        "is too small";
  if (any_target && reason.empty())
    for (std::size_t i : group) pieces_[i].wanted = true;
  else
    for (std::size_t loop : loops) reasons[loop] = reason;
}

// Makes the patch of volume faces, joined to the mesh.
void Run::prepare_piece(Piece& piece, const Progress& progress) const {
  RimPatch rough = make_rim_patch(mesh_, topology_, piece.sheet);
  remove_steiner_points(rough, neighbourhood_, {}, progress);
  if (rough.steiner_points > 0)
    piece.defect = "the patch could not be joined to " + std::to_string(rough.steiner_points) +
                   (rough.steiner_points == 1 ? " edge of the rim" : " edges of the rim");
  else
    piece.rough.emplace(std::move(rough));
}

void Run::finish_piece(Piece& piece, const FinishingOptions& finishing, const std::vector<Corners>& obstacles,
                       const Progress& progress) const {
  if (!piece.rough) return;
  const RimPatch& rough = *piece.rough;
  std::vector<const BoundaryLoop*> rim;
  for (const BoundaryLoop& loop : rough.loops) rim.push_back(&loop);
  const auto find = [&](const PatchMesh& now) {
    PatchFault fault;
    const Patch patch = as_patch(now, rough.rim_vertices, mesh_);
    PatchCheck check = check_patch(neighbourhood_, patch, rim, progress);
    if (!check.passed()) {
      fault.defect = describe(check.defect);
      if (can_be_mended(check.defect)) fault.triangles = std::move(check.patch_triangles);
    } else if (!obstacles.empty()) {
      std::vector<Corners> triangles;
      for (const Triangle& t : patch.triangles) triangles.push_back(corners(mesh_, patch, t));
      for (const auto& pair : improper_pairs_between(triangles, obstacles))
        fault.triangles.push_back(pair.first);
      fault.triangles.erase(std::unique(fault.triangles.begin(), fault.triangles.end()),
                            fault.triangles.end());
      if (!fault.triangles.empty()) fault.defect = "the patch meets the patch of another hole";
    }
    return fault;
  };
  const FinishedPatch finished =
      finish(rough.mesh, finishing, {rough.rim, neighbourhood_, obstacles, find}, progress);
  piece.route = finished.route;
  piece.defect = finished.defect;
  piece.patch = piece.defect.empty() ? as_patch(finished.mesh, rough.rim_vertices, mesh_) : Patch();
}

void Run::finish_pieces(const Progress& progress) {
  double total = 0;
  for (const Piece& piece : pieces_)
    total += piece.wanted ? static_cast<double>(piece.sheet.triangles.size()) : 0;
  const Progress within = progress.part(0, 0, "fairing the patches");
  std::mutex mutex;
  std::exception_ptr error;
  tbb::parallel_for(std::size_t(0), pieces_.size(), [&](std::size_t i) {
    if (!pieces_[i].wanted) return;
    try {
      prepare_piece(pieces_[i], within);
      finish_piece(pieces_[i], finishing(), {}, within);
      progress.advance(static_cast<double>(pieces_[i].sheet.triangles.size()) / total);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!error) error = std::current_exception();
    }
  });
  if (error) std::rethrow_exception(error);
}

// The other patches near a piece.
std::vector<Corners> Run::obstacles_of(std::size_t piece) const {
  Box box;
  for (const SheetVertex& v : pieces_[piece].sheet.vertices)
    box.include(bounding_box(v.position, v.position, v.position));
  // A fair surface bulges over the stairs by less than their extent.
  for (int k = 0; k < 3; ++k) {
    const double size = box.high[k] - box.low[k];
    box.low[k] -= size;
    box.high[k] += size;
  }
  std::vector<Corners> triangles;
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (const Triangle& t : pieces_[i].patch.triangles) {
      if (i == piece) break;
      const Corners c = corners(mesh_, pieces_[i].patch, t);
      if (box.meets(bounding_box(c[0], c[1], c[2]))) triangles.push_back(c);
    }
  return triangles;
}

// The pieces whose patches meet another's, ascending; of two that meet only the later one if asked.
std::vector<std::size_t> Run::pieces_in_conflict(bool later_only) const {
  std::vector<Corners> triangles;
  std::vector<std::size_t> owner, found;
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (const Triangle& t : pieces_[i].patch.triangles) {
      triangles.push_back(corners(mesh_, pieces_[i].patch, t));
      owner.push_back(i);
    }
  for (const auto& [a, b] : improper_pairs(triangles)) {
    if (owner[a] == owner[b]) continue;
    found.push_back(std::max(owner[a], owner[b]));
    if (!later_only) found.push_back(std::min(owner[a], owner[b]));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Patches that were finished each for itself may meet. The later one is finished again with the others in its
// way; where that is no help both stay as the faces of the volumes, which meet nothing; and should others
// meet these, they too.
void Run::separate(const Progress& progress) {
  std::vector<std::size_t> rough;
  for (std::size_t i : pieces_in_conflict(true)) {
    finish_piece(pieces_[i], finishing(), obstacles_of(i), progress);
    if (!pieces_[i].defect.empty()) rough.push_back(i);
  }
  const FinishingOptions none{false, std::nullopt, std::nullopt};
  for (int round = 0; round < most_separations && !rough.empty(); ++round) {
    for (std::size_t i : rough) finish_piece(pieces_[i], none, {}, progress);
    rough = pieces_in_conflict(false);
  }
  for (std::size_t i : pieces_in_conflict(true)) {
    pieces_[i].patch = Patch();
    pieces_[i].defect = "the patch meets the patch of another hole";
  }
  progress.update(1);
}

AtomicVolumesResult Run::result(CompletionReport report) {
  AtomicVolumesResult result;
  result.completion.patch.input_vertices = static_cast<Index>(mesh_.vertices.size());
  std::vector<HoleReport> holes;
  std::vector<char> merged(report.holes.size(), 0);
  for (const std::vector<std::size_t>& group : groups()) {
    if (!pieces_[group.front()].wanted) continue;
    std::vector<std::size_t> loops;
    bool closed = true;
    std::string defect;
    for (std::size_t i : group) {
      loops.insert(loops.end(), pieces_[i].loops.begin(), pieces_[i].loops.end());
      closed &= pieces_[i].defect.empty();
      if (defect.empty()) defect = pieces_[i].defect;
    }
    std::sort(loops.begin(), loops.end());
    loops.erase(std::unique(loops.begin(), loops.end()), loops.end());
    HoleReport& hole = report.holes[loops.front()];
    const double first_edges = static_cast<double>(hole.edges);
    Vector3 centre = hole.centre * first_edges;
    for (std::size_t k = 1; k < loops.size(); ++k) {
      const HoleReport& other = report.holes[loops[k]];
      hole.loops.push_back(loops[k]);
      hole.edges += other.edges;
      hole.perimeter += other.perimeter;
      centre += other.centre * static_cast<double>(other.edges);
      merged[loops[k]] = 1;
    }
    hole.centre = centre / static_cast<double>(hole.edges);
    hole.outcome = closed ? HoleOutcome::closed : HoleOutcome::failed;
    hole.reason = defect;
    for (std::size_t i : group) {
      if (!closed) break;
      hole.route = pieces_[i].route;
      hole.vertices_added += pieces_[i].patch.vertices.size();
      hole.faces_added += pieces_[i].patch.triangles.size();
      append(result.completion.patch, pieces_[i].patch);
    }
  }
  for (std::size_t i = 0; i < report.holes.size(); ++i) {
    HoleReport& hole = report.holes[i];
    if (hole.outcome == HoleOutcome::failed && hole.reason.empty()) hole.reason = "no patch reaches this rim";
    if (!merged[i]) holes.push_back(std::move(hole));
  }
  report.holes = std::move(holes);
  result.completion.report = std::move(report);
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
  const MeshTopology topology = build_topology(mesh, progress.part(0, 0.05, "finding the boundary"));
  const std::vector<BoundaryLoop> loops =
      trace_boundary_loops(mesh, topology, progress.part(0.05, 0.1, "tracing boundary loops"));
  report.holes = select_holes(mesh, loops, selection, options.holes);
  target_islands(loops, report.holes);
  Run run(mesh, topology, loops, options, report);
  clock.end_of("finding the holes");
  AtomicVolumesFigures figures;
  if (run.anything_to_do()) {
    const VolumeSolution solution = run.solve(progress.part(0.1, 0.5, "dividing space"));
    figures = solution.figures;
    report.notes.insert(report.notes.end(), solution.notes.begin(), solution.notes.end());
    clock.end_of("dividing space and cutting");
    run.take_pieces(solution.surface);
    run.finish_pieces(progress.part(0.5, 0.95, "fairing the patches"));
    clock.end_of("fairing the patches");
    run.separate(progress.part(0.95, 1, "comparing the patches"));
    clock.end_of("comparing the patches");
  }
  progress.update(1);
  AtomicVolumesResult result = run.result(std::move(report));
  result.completion.report.figures = named(figures);
  result.figures = figures;
  return result;
}

}  // namespace meshcomplete
