#include "filter_atomicvolumes/filter_atomicvolumes.h"

#include <limits>
#include <utility>

#include "common/core/error.h"
#include "common/host/close_holes.h"
#include "common/host/other_layers.h"
#include "common/host/parameter_blocks.h"
#include "filter_atomicvolumes/atomic_volumes.h"
#include "filter_atomicvolumes/offending_faces.h"

using namespace meshcomplete;
using namespace meshcomplete::host;

namespace {

constexpr int any = std::numeric_limits<int>::max();
const char* const stage = "reading the parameters";

const char* const description =
    "Closes all holes at once, also gaps between separate parts and holes with islands or several "
    "boundaries. Space around the mesh is divided into volumes that the mesh does not cross, a minimum cut "
    "decides which of them are inside, so that the new surface is as small as possible, and that surface is "
    "smoothed. Points, cameras and symmetries can say what is inside or outside. The mesh itself is not "
    "changed: faces and vertices are only added, and they intersect nothing."
    "<br>See: <br/><i>Joshua Podolak, Szymon Rusinkiewicz</i><br/>"
    "<b>\"Atomic Volumes for Mesh Completion\"</b><br/>Symposium on Geometry Processing (SGP), 2005.";

std::vector<ParameterDeclaration> cut_parameters() {
  return {
      integer_parameter("MaxDepth", "Maximum depth",
                        "How often the cube around the mesh may be halved, 3 to 30. 0: as often as needed.",
                        "levels", 0, 0, 30),
      choice_parameter(
          "DepthLimit", "At the depth limit",
          "What is done where the faces at a hole are still too many for one cube. Removing them "
          "makes the result a new layer without them, and the log names them.",
          {"Cut cubes into convex cells", "Remove the faces there, in a new layer"}),
      integer_parameter("NodeBudget", "Most volumes",
                        "The filter stops with a message when it would need more volumes than this.",
                        "volumes", 5000000, 1000, any),
      choice_parameter("Weight", "Make small",
                       "What there is little of in the end. Area: rather caps. Number of faces: rather "
                       "bridges. Balanced: in between. Poisson: area, near a Poisson reconstruction.",
                       {"Balanced", "Area", "Number of faces", "Poisson"}),
      integer_parameter("Shifts", "Divisions tried", "So many randomly placed divisions of space are tried.",
                        "divisions", 3, 1, 100),
      integer_parameter("Seed", "Seed", "Start of the random numbers.", "", 1, 0, any)};
}

std::vector<ParameterDeclaration> constraint_parameters() {
  return {
      layer_parameter("InsideLayer", "Inside", "Its vertices end up inside the solid."),
      layer_parameter("OutsideLayer", "Outside", "Its vertices end up outside the solid."),
      layer_parameter("HintInsideLayer", "Probably inside",
                      "Its vertices end up inside, unless that costs too much."),
      layer_parameter("HintOutsideLayer", "Probably outside",
                      "Its vertices end up outside, unless that costs too much."),
      positive_parameter("HintPrice", "Price of a hint",
                         "The area to be saved by going against one hint vertex.",
                         "squared diagonals of the bounding box", 0.01),
      switch_parameter(
          "CarveLayers", "Carve with cameras",
          "What the cameras of other visible layers saw through, up to their vertices, is outside.", false),
      choice_parameter("Symmetry", "Symmetry",
                       "What is missing should look like its image under a symmetry, unless the price is too "
                       "high. Detect: one that the mesh itself has. Given: by the next three parameters.",
                       {"None", "Detect reflection", "Detect rotation", "Detect translation",
                        "Given reflection plane", "Given rotation", "Given translation"}),
      centre_parameter("SymmetryPoint", "Symmetry: point", "On the plane or axis, in layer coordinates."),
      point_parameter("SymmetryDirection", "Symmetry: direction",
                      "The normal of the plane, the direction of the axis, or the translation.", {1, 0, 0}),
      integer_parameter("SymmetryFold", "Symmetry: fold", "A rotation turns by 360 degrees divided by this.",
                        "", 2, 2, 1000),
      positive_parameter("SymmetryPrice", "Symmetry: price",
                         "What is to be saved where a volume and its image differ.",
                         "areas of the volume's faces", 0.5)};
}

std::vector<ParameterDeclaration> smoothing_parameters() {
  return {
      choice_parameter("Smoothing", "Smoothing",
                       "How the steps between volumes are smoothed. Constrained: no volume's centre changes "
                       "sides. Two passes: freely, then cut anew near the result, then constrained.",
                       {"None", "Constrained", "Two passes"}, 1),
      integer_parameter("SmoothingIterations", "Smoothing steps", "How often each new vertex is moved.",
                        "steps", 5, 0, 1000),
      switch_parameter("MovingCentres", "Moving centres", "Centres move with their volumes while smoothing.",
                       false),
      switch_parameter("Remesh", "Remesh", "Makes the new faces as large as those around.", true),
      choice_parameter("Fairing", "Fairing",
                       "What the new surface minimises in the end. Thin plate: bending, continues the mesh "
                       "smoothly. Membrane: area. Normal variation: the change of the normals.",
                       {"Thin plate", "Membrane", "Normal variation", "None"}, 2),
      length_parameter("EdgeLength", "Edge length",
                       "Length of the new edges. 0: as in the mesh around. A percentage is of the bounding "
                       "box's diagonal.")};
}

AtomicVolumesOptions options_from(const ParameterValues& values) {
  constexpr VolumeSmoothing smoothings[] = {VolumeSmoothing::none, VolumeSmoothing::constrained,
                                            VolumeSmoothing::two_pass};
  constexpr std::optional<SurfaceEnergy> energies[] = {SurfaceEnergy::thin_plate, SurfaceEnergy::membrane,
                                                       SurfaceEnergy::normal_variation, std::nullopt};
  AtomicVolumesOptions options;
  if (const int depth = values.integer("MaxDepth"); depth > 0) options.max_depth = depth;
  if (options.max_depth.value_or(3) < 3)
    throw CompletionError(stage, "Parameter \"MaxDepth\" must be 0, for any depth, or at least 3.");
  options.node_budget = static_cast<std::size_t>(values.integer("NodeBudget"));
  constexpr CutWeight weights[] = {CutWeight::balanced, CutWeight::area, CutWeight::unit, CutWeight::poisson};
  options.weight = weights[values.choice("Weight")];
  options.shifts = values.integer("Shifts");
  options.seed = static_cast<std::uint64_t>(values.integer("Seed"));
  options.constraints.hint_price = values.real("HintPrice");
  options.constraints.symmetry_price = values.real("SymmetryPrice");
  options.smoothing = smoothings[values.choice("Smoothing")];
  options.smoothing_iterations = values.integer("SmoothingIterations");
  options.moving_centres = values.boolean("MovingCentres");
  options.remesh = values.boolean("Remesh");
  options.fairing = energies[values.choice("Fairing")];
  if (values.real("EdgeLength") > 0) options.edge_length = values.real("EdgeLength");
  return options;
}

/// What other layers say about inside and outside; `notes` are for the log.
void read_layers(const FilterRun& run, VolumeConstraints& constraints, std::vector<std::string>& notes) {
  refuse_shared_layers(run, {"InsideLayer", "OutsideLayer", "HintInsideLayer", "HintOutsideLayer"});
  constraints.inside = other_layer_points(run, "InsideLayer");
  constraints.outside = other_layer_points(run, "OutsideLayer");
  constraints.hinted_inside = other_layer_points(run, "HintInsideLayer");
  constraints.hinted_outside = other_layer_points(run, "HintOutsideLayer");
  if (!run.parameters.boolean("CarveLayers")) return;
  for (LayerView& view : layer_views(run)) {
    notes.push_back("Carved with the view of the layer \"" + view.layer.toStdString() + "\"");
    constraints.views.push_back({view.from, std::move(view.seen)});
  }
  if (constraints.views.empty())
    throw CompletionError(stage,
                          "Parameter \"CarveLayers\" is on, but no other visible layer has a camera. Give it "
                          "one with \"Set Mesh Camera\".");
}

std::optional<Symmetry> symmetry_from(const ParameterValues& values, const TriangleMesh& mesh,
                                      const Progress& progress) {
  const Vector3 point = values.point("SymmetryPoint"), direction = values.point("SymmetryDirection");
  constexpr SymmetryKind kinds[] = {SymmetryKind::reflection, SymmetryKind::rotation,
                                    SymmetryKind::translation};
  SymmetryDetectionOptions detection;
  const int choice = values.choice("Symmetry");
  if (choice == 4) return reflection(point, direction);
  if (choice == 5) return rotation(point, direction, values.integer("SymmetryFold"));
  if (choice == 6) return translation(direction);
  detection.kind = kinds[choice - 1];
  return detect_symmetry(mesh, detection, progress);
}

void apply(FilterRun& run) {
  AtomicVolumesOptions options = options_from(run.parameters);
  std::vector<std::string> notes;
  read_layers(run, options.constraints, notes);
  close_holes(run, [&](const TriangleMesh& mesh, const MeshSelection& selection,
                       const HoleSelectionOptions& holes, const Progress& progress) {
    options.holes = holes;
    if (run.parameters.choice("Symmetry") > 0) {
      const auto symmetry =
          symmetry_from(run.parameters, mesh, progress.part(0, 0.1, "finding the symmetry"));
      if (symmetry) options.constraints.symmetries.push_back(*symmetry);
      notes.push_back(symmetry ? "Symmetry: " + describe(*symmetry)
                               : "Symmetry: the mesh has none of this kind, so it was completed without");
    }
    const Progress rest = progress.part(0.1, 1, "closing holes");
    const bool removes = run.parameters.choice("DepthLimit") == 1;
    ReducedCompletion done =
        removes ? fill_without_offending_faces(mesh, selection, options, rest)
                : ReducedCompletion{fill_by_atomic_volumes(mesh, selection, options, rest), {}};
    ClosedHoles closed{std::move(done.result.completion), {}};
    std::vector<std::string>& all_notes = closed.completion.report.notes;
    all_notes.insert(all_notes.begin(), notes.begin(), notes.end());
    if (removes) closed.removed = std::move(done.removed);
    return closed;
  });
}

FilterDeclaration atomic_volumes_filter() {
  FilterDeclaration filter;
  filter.name = "Close Holes: Atomic Volumes";
  filter.python_name = "close_holes_atomic_volumes";
  filter.description = description;
  filter.place = MenuPlace::remeshing;
  filter.parameters = close_holes_parameters();
  for (const auto& more : {cut_parameters(), constraint_parameters(), smoothing_parameters()})
    filter.parameters.insert(filter.parameters.end(), more.begin(), more.end());
  filter.apply = apply;
  return filter;
}

}  // namespace

FilterAtomicVolumes::FilterAtomicVolumes() { declare({atomic_volumes_filter()}, this); }
