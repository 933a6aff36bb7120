#include "filter_poissoncompletion/completion_by_refinement.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "common/core/edge_length_field.h"
#include "common/core/error.h"
#include "common/core/hole_targets.h"
#include "common/core/patch_pieces.h"
#include "common/core/piece_finishing.h"
#include "common/core/piece_results.h"
#include "common/core/rim.h"
#include "common/core/sheets.h"
#include "common/core/stage_clock.h"
#include "filter_poissoncompletion/coinciding_points.h"
#include "filter_poissoncompletion/cushion.h"
#include "filter_poissoncompletion/delaunay_refinement.h"
#include "filter_poissoncompletion/initial_points.h"
#include "filter_poissoncompletion/surface_gaps.h"

namespace meshcomplete {
namespace {

// How far from the rims all vertices of the mesh are in the triangulation, in target edge lengths: beyond the
// balls of the first facets at the rims, so that these see what is behind them.
constexpr double near_rims = 2.5;

// Which part of the cushion remains where the mesh faces another way, away from the rims: it may be the other
// side of a wall that is thinner than the cushion.
constexpr double thin_cushion = 0.15;

// Up to which distance from the rims, in radii, the cushion grows: beyond there may be other sheets that face
// the same way.
constexpr double most_growth = 2;

const char* const not_separated =
    "the reconstructed surface does not separate this hole from the rest of the mesh; where its "
    "boundary is noisy, try 1 or more for 'RemoveRings'";

class Run {
 public:
  Run(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<BoundaryLoop>& loops,
      const MergedRims* merged, const InputNeighbourhood& input, const ImplicitFunction& function,
      const RefinedCompletionOptions& options, CompletionReport& report)
      : mesh_(mesh),
        topology_(topology),
        loops_(loops),
        divided_(merged ? merged->mesh : mesh),
        divided_topology_(merged ? merged->topology : topology),
        input_(input),
        function_(function),
        options_(options),
        report_(report),
        targets_(loops_to_close(loops, report.holes)),
        field_(make_field()),
        cushion_(make_cushion()) {}

  std::vector<PatchPiece> pieces(RefinedCompletionFigures& figures, const Progress& progress);

 private:
  EdgeLengthField make_field() const;
  Cushion make_cushion() const;

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  const std::vector<BoundaryLoop>& loops_;
  const TriangleMesh& divided_;  // in which rim vertices at one position are one
  const MeshTopology& divided_topology_;
  const InputNeighbourhood& input_;
  const ImplicitFunction& function_;
  const RefinedCompletionOptions& options_;
  CompletionReport& report_;
  const std::vector<const BoundaryLoop*> targets_;
  const EdgeLengthField field_;
  const Cushion cushion_;
};

EdgeLengthField Run::make_field() const {
  std::vector<RimSample> samples;
  for (const BoundaryLoop* loop : targets_) {
    const Rim rim = collect_rim(mesh_, topology_, *loop);
    const std::vector<RimSample> more = smoothed_samples(rim.positions, rim.edge_length);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  // The field still has to know how far the rims are.
  if (options_.edge_length)
    for (RimSample& sample : samples) sample.edge_length = *options_.edge_length;
  return EdgeLengthField(std::move(samples));
}

Cushion Run::make_cushion() const {
  if (options_.cushion_radius) return Cushion(input_.blocks(), *options_.cushion_radius);
  const auto radius = [this](const Vector3& at, bool alike) {
    const double at_rims = options_.cushion * field_.at(at), away = field_.distance(at);
    if (alike) return at_rims + options_.cushion_growth * std::min(away, most_growth * at_rims);
    return away < at_rims ? at_rims : thin_cushion * at_rims;
  };
  return Cushion(input_.blocks(), radius,
                 options_.cushion * field_.longest() * (1 + options_.cushion_growth * most_growth));
}

std::vector<PatchPiece> Run::pieces(RefinedCompletionFigures& figures, const Progress& progress) {
  StageClock clock(report_);
  const InitialPoints points = choose_initial_points(
      mesh_, topology_, targets_, options_.rings,
      [this](const Vector3& at) { return near_rims * field_.at(at); }, input_.blocks(),
      options_.sample_share);
  std::vector<Vector3> positions;
  std::vector<Index> number(mesh_.vertices.size(), 0), names;
  for (Index v : points.vertices) {
    number[v] = static_cast<Index>(positions.size());
    positions.push_back(mesh_.vertices[v]);
    names.push_back(v);
  }
  for (Index h = 0; &divided_ != &mesh_ && h < 3 * mesh_.triangles.size(); ++h) {
    const Index v = mesh_.triangles[h / 3][h % 3], name = divided_.triangles[h / 3][h % 3];
    if (name != v && points.vertices[number[v]] == v) names[number[v]] = name;
  }
  RefinementOptions refinement;
  refinement.criteria.edge_length = [this](const Vector3& at) { return field_.at(at); };
  refinement.criteria.smallest_angle = options_.smallest_angle;
  refinement.around.emplace(ProtectedMesh{divided_, cushion_, names});
  refinement.seeds.assign(positions.size(), 0);
  std::fill_n(refinement.seeds.begin(), points.on_rims, 1);
  for (Index h : points.half_edges)
    refinement.protected_edges.emplace_back(number[mesh_.triangles[h / 3][h % 3]],
                                            number[mesh_.triangles[h / 3][(h % 3 + 1) % 3]]);
  clock.end_of("choosing the first points");
  const DelaunayComplex complex =
      refine_delaunay(function_, positions, refinement, progress.part(0, 0.6, "refining the surface"));
  clock.end_of("refining the surface");
  figures.initial_points = positions.size();
  figures.points = complex.vertices.size();
  figures.cells = complex.cells.size();
  figures.lost_edges = complex.lost_edges.size();
  SeparatingSurface surface =
      tailor({divided_, divided_topology_, complex, points.half_edges, points.rim_edges}, figures.tailoring,
             progress.part(0.6, 0.7, "tailoring the patches"));
  figures.gaps = close_gaps(
      surface, divided_,
      {points.half_edges.begin(), points.half_edges.begin() + static_cast<std::ptrdiff_t>(points.rim_edges)});
  std::vector<PatchPiece> pieces = make_pieces(split_into_sheets(divided_, divided_topology_, surface, mesh_),
                                               topology_, LoopNumbers(mesh_, loops_));
  clock.end_of("tailoring the patches");
  return pieces;
}

}  // namespace

RefinedCompletion complete_by_refinement(const TriangleMesh& mesh, const MeshTopology& topology,
                                         const std::vector<BoundaryLoop>& loops,
                                         const InputNeighbourhood& input, const ImplicitFunction& function,
                                         const RefinedCompletionOptions& options, CompletionReport report,
                                         const Progress& progress) {
  RefinedCompletion result;
  std::vector<PatchPiece> pieces;
  const std::unique_ptr<MergedRims> merged = merge_rims(mesh, topology);
  if (merged) refuse_sewn_rims(mesh, merged->topology, loops, report.holes);
  if (std::any_of(report.holes.begin(), report.holes.end(), is_targeted)) {
    Run run(mesh, topology, loops, merged.get(), input, function, options, report);
    pieces = run.pieces(result.figures, progress.part(0, 0.7, "refining the surface"));
    const std::string open = std::string(not_separated) +
                             (any_left_open(report.holes) ? ", or close the holes beside it, too" : "");
    choose_pieces(pieces, loops, report.holes, open);
    if (options.stretches) keep_pieces_at(*options.stretches, pieces, report.holes);
    StageClock clock(report);
    FinishingOptions finishing = options.finishing;
    if (!finishing.edge_length) finishing.edge_length = options.edge_length;
    const PieceFinisher finisher(mesh, topology, input, input, finishing);
    finisher.finish(pieces, 0, progress.part(0.7, 0.95, "joining the patches"));
    finisher.separate(pieces, progress.part(0.95, 0.98, "comparing the patches"));
    if (options.stretches)
      cut_strips(mesh, loops, *options.stretches, pieces, progress.part(0.98, 1, "cutting out strips"));
    clock.end_of("joining the patches");
  }
  progress.update(1);
  result.completion = gather_pieces(mesh, pieces, std::move(report));
  return result;
}

}  // namespace meshcomplete
