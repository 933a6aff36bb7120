// Prints how mesh completion by atomic volumes fares: the paper's table, finer meshes with the same holes,
// smoothing, limits of depth, and many positions of the octree.
//
//   atomic_volumes_benchmark [volumes|subdivided|smoothed|depths|positions]... [MESH...]    without a word:
//   all
//
// With meshes, those that have holes are taken as they are; into the others holes are cut. `volumes` also
// divides closed meshes of 60,000 faces and more into four and cuts long and numerous holes into them.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/arguments.h"
#include "benchmarks/cut_holes.h"
#include "benchmarks/measuring.h"
#include "benchmarks/mesh_file.h"
#include "common/core/mesh_statistics.h"
#include "filter_atomicvolumes/atomic_volumes.h"
#include "filter_atomicvolumes/volume_smoothing.h"
#include "filter_atomicvolumes/volume_solution.h"
#include "tests/support/meshes.h"

namespace {

using namespace meshcomplete;
using benchmarks::Clock;
using benchmarks::completed;
using benchmarks::CutMesh;
using benchmarks::file_name;
using benchmarks::loops_of;
using benchmarks::Rim;
using benchmarks::seconds_since;
using benchmarks::soundness;
using benchmarks::text;

constexpr double pi = 3.14159265358979323846;

// --- meshes
// --------------------------------------------------------------------------------------------------------

struct Model {
  std::string name;
  TriangleMesh mesh;
};

std::size_t rim_edges(const TriangleMesh& mesh) { return build_topology(mesh).boundary_half_edges.size(); }

/// Cuts a round hole with a rim of about so many edges somewhere.
TriangleMesh with_round_hole(const TriangleMesh& mesh, int edges, std::mt19937& random) {
  const double edge =
      std::sqrt(benchmarks::area_of(mesh) / static_cast<double>(mesh.triangles.size()) * 4 / std::sqrt(3.0));
  const std::size_t before = loops_of(mesh).size();
  for (int attempt = 0; attempt < 100; ++attempt) {
    const Vector3& centre = mesh.vertices[random() % mesh.vertices.size()];
    const auto cut = benchmarks::cut_round_hole(mesh, {centre, edges * edge / (2 * pi)});
    if (cut && loops_of(cut->mesh).size() == before + 1) return cut->mesh;
  }
  return mesh;
}

TriangleMesh with_round_holes(TriangleMesh mesh, const std::vector<int>& sizes) {
  std::mt19937 random(1);
  for (int edges : sizes) mesh = with_round_hole(mesh, edges, random);
  return mesh;
}

TriangleMesh with_winding_holes(TriangleMesh mesh, int holes, std::size_t edges) {
  std::uint32_t seed = 1;
  for (int i = 0; i < holes; ++i) {
    const std::optional<CutMesh> cut = benchmarks::cut_winding_hole(mesh, edges, Rim::any, seed, {}, 3);
    if (!cut) break;
    mesh = cut->mesh;
    seed = cut->seed + 1;
  }
  return mesh;
}

/// As much of the surface missing as of the paper's skull: of a ball of 5120 faces a cap of 1250 is left,
/// with three holes.
TriangleMesh little_left() { return with_round_holes(test::sphere_with_hole(4, 2.05), {10, 10, 14}); }

/// As many rim edges in five holes as the Stanford bunny has.
TriangleMesh with_five_holes(const TriangleMesh& mesh) {
  return with_round_holes(mesh, {80, 42, 40, 39, 22});
}

/// The meshes of the files; those without holes get five.
std::vector<Model> models_of(const std::vector<std::string>& files) {
  std::vector<Model> models;
  for (const std::string& file : files) {
    TriangleMesh mesh = benchmarks::read_mesh(file);
    if (rim_edges(mesh) > 0)
      models.push_back({file_name(file), std::move(mesh)});
    else
      models.push_back({file_name(file) + ", five holes", with_five_holes(mesh)});
  }
  return models;
}

/// Every face split into four, but edges of the boundary are left as they are: faces there become three.
TriangleMesh subdivided_inside(const TriangleMesh& mesh) {
  const MeshTopology topology = build_topology(mesh);
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::map<std::pair<Index, Index>, Index> middles;
  for (Index f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    std::vector<Index> polygon;  // corners and midpoints in turn
    std::vector<std::size_t> corners;
    for (int k = 0; k < 3; ++k) {
      const Index from = t[k], to = t[(k + 1) % 3];
      corners.push_back(polygon.size());
      polygon.push_back(from);
      if (topology.opposite[3 * f + k] == MeshTopology::boundary) continue;
      const auto [place, is_new] =
          middles.emplace(std::minmax(from, to), static_cast<Index>(fine.vertices.size()));
      if (is_new) fine.vertices.push_back(as_stored((mesh.vertices[from] + mesh.vertices[to]) / 2));
      polygon.push_back(place->second);
    }
    // Cut off corners that lie between two midpoints; what is left is a polygon of three to five corners.
    const std::size_t n = polygon.size();
    std::vector<bool> cut_off(n, false);
    for (std::size_t i : corners) {
      const std::size_t last = (i + n - 1) % n, next = (i + 1) % n;
      const auto is_corner = [&](std::size_t j) {
        return std::find(corners.begin(), corners.end(), j) != corners.end();
      };
      if (is_corner(last) || is_corner(next)) continue;
      fine.triangles.push_back({polygon[last], polygon[i], polygon[next]});
      cut_off[i] = true;
    }
    std::vector<Index> rest;
    for (std::size_t i = 0; i < n; ++i)
      if (!cut_off[i]) rest.push_back(polygon[i]);
    // From a midpoint, so that no two corners of a straight side make a triangle.
    const auto middle =
        std::find_if(rest.begin(), rest.end(), [&](Index v) { return v >= mesh.vertices.size(); });
    if (middle != rest.end()) std::rotate(rest.begin(), middle, rest.end());
    for (std::size_t i = 1; i + 1 < rest.size(); ++i)
      fine.triangles.push_back({rest[0], rest[i], rest[i + 1]});
  }
  return fine;
}

// --- measuring
// -----------------------------------------------------------------------------------------------------

struct Sample {
  AtomicVolumesResult result;
  double seconds = 0, processor_seconds = 0;
  std::optional<double> megabytes;

  const AtomicVolumesFigures& figures() const { return result.figures; }
  const CompletionReport& report() const { return result.completion.report; }

  double stage(const std::string& name) const {
    for (const auto& [stage, taken] : report().stage_seconds)
      if (stage == name) return taken;
    return 0;
  }

  std::string holes() const {
    const std::size_t closed = report().count(HoleOutcome::closed);
    return std::to_string(closed) + "/" + std::to_string(closed + report().count(HoleOutcome::failed));
  }
};

Sample run(const TriangleMesh& mesh, const AtomicVolumesOptions& options = {}) {
  Sample sample;
  const benchmarks::PeakMemory memory;
  const double used = benchmarks::processor_seconds();
  const Clock::time_point start = Clock::now();
  sample.result = fill_by_atomic_volumes(mesh, MeshSelection(), options);
  sample.seconds = seconds_since(start);
  sample.processor_seconds = benchmarks::processor_seconds() - used;
  sample.megabytes = memory.megabytes();
  return sample;
}

AtomicVolumesOptions with_one_position() {
  AtomicVolumesOptions options;
  options.shifts = 1;
  return options;
}

// --- tables
// --------------------------------------------------------------------------------------------------------

struct PaperRow {
  Model model;
  std::string paper;  // what it was like
  std::string limit;  // seconds that we allow ourselves
};

bool like_the_bunny(const TriangleMesh& mesh) {
  return mesh.triangles.size() > 60000 && mesh.triangles.size() < 80000;
}

/// Numerous holes in the first of the large meshes, long ones in the last.
void add_large_rows(const std::vector<Model>& large, std::vector<PaperRow>& rows) {
  if (large.empty()) return;
  std::vector<int> sizes(30, 80);
  sizes.insert(sizes.end(), 12, 200);
  const Model& first = large.front();
  const Model& last = large.back();
  rows.push_back({{first.name + ", divided, numerous round holes",
                   with_round_holes(benchmarks::subdivided(first.mesh), sizes)},
                  "angel: 340,000 faces, 530,000 nodes, 17.5 min",
                  "10"});
  rows.push_back({{last.name + ", divided, long winding holes",
                   with_winding_holes(benchmarks::subdivided(last.mesh), 12, 400)},
                  "toes: 350,000 faces, 570,000 nodes, 19 min",
                  "10"});
}

std::vector<PaperRow> paper_rows(const std::vector<std::string>& files) {
  std::vector<PaperRow> rows;
  rows.push_back({{"ball of 5,120 faces, three quarters cut away", little_left()},
                  "skull: 1,250 faces, 10,481 nodes, 8 s",
                  "0.3"});
  std::vector<Model> large;
  for (const std::string& file : files) {
    const TriangleMesh mesh = benchmarks::read_mesh(file);
    const bool closed = rim_edges(mesh) == 0;
    if (closed && mesh.triangles.size() > 60000) large.push_back({file_name(file), mesh});
    if (like_the_bunny(mesh))
      rows.push_back(
          {{file_name(file) + (closed ? ", five holes" : ""), closed ? with_five_holes(mesh) : mesh},
           "bunny: 70,000 faces, 17,300 nodes, 78 s",
           "1"});
    else if (!closed)
      rows.push_back({{file_name(file), mesh}, "–", "–"});
  }
  add_large_rows(large, rows);
  return rows;
}

void volumes(const std::vector<std::string>& files) {
  std::string times =
      "\nSeconds by the clock, by stage, with three positions of the octree (the default), and all with "
      "one\n\n"
      "| model | holes closed | solid | finding | dividing and cutting | fairing | comparing | all | allowed "
      "| all, processor | all, one position | MB | KB per boundary edge |\n"
      "|---|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  std::printf(
      "\nSizes\n\n| model | the paper's | faces | area missing | boundary edges | leaves | nodes | nodes per "
      "boundary edge | depth | smallest leaf over smallest distance |\n"
      "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const PaperRow& row : paper_rows(files)) {
    const TriangleMesh& mesh = row.model.mesh;
    const char* name = row.model.name.c_str();
    const Sample one = run(mesh, with_one_position()), all = run(mesh);
    const AtomicVolumesFigures& figures = all.figures();
    const Patch& patch = all.result.completion.patch;
    const double edges = static_cast<double>(rim_edges(mesh));
    const double there = benchmarks::area_of(mesh), area = benchmarks::area_of(completed(mesh, patch));
    std::printf("| %s | %s | %zu | %.1f %% | %.0f | %zu | %zu | %.0f | %d | %.2g |\n", name,
                row.paper.c_str(), mesh.triangles.size(), 100 * (1 - there / area), edges, figures.leaves,
                figures.nodes, static_cast<double>(figures.nodes) / edges, figures.depth,
                figures.smallest_leaf / figures.smallest_distance);
    char line[400];
    std::snprintf(line, sizeof line,
                  "| %s | %s | %s | %.3f | %.2f | %.2f | %.2f | %.2f | %s | %.2f | %.2f | %s | %s |\n", name,
                  all.holes().c_str(), soundness(mesh, patch).c_str(), all.stage("finding the holes"),
                  all.stage("dividing space and cutting"), all.stage("fairing the patches"),
                  all.stage("comparing the patches"), all.seconds, row.limit.c_str(), all.processor_seconds,
                  one.seconds, all.megabytes ? text("%.0f", *all.megabytes).c_str() : "–",
                  all.megabytes ? text("%.0f", 1e3 * *all.megabytes / edges).c_str() : "–");
    times += line;
  }
  std::printf("%s", times.c_str());
}

void subdivided(const std::vector<std::string>& files) {
  std::printf(
      "\n| model | rims | faces | boundary edges | leaves | nodes | times as many | depth "
      "| dividing and cutting once, s | all, one position, s | all, three, s | holes closed |\n"
      "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const Model& model : models_of(files)) {
    for (const bool rims_too : {true, false}) {
      TriangleMesh mesh = model.mesh;
      std::size_t before = 0;
      for (int i = 0; i < 3; ++i) {
        if (i > 0) mesh = rims_too ? benchmarks::subdivided(mesh) : subdivided_inside(mesh);
        const Sample one = run(mesh, with_one_position());
        const Sample all = run(mesh);
        const AtomicVolumesFigures& figures = one.figures();
        std::printf("| %s | %s | %zu | %zu | %zu | %zu | %s | %d | %.2f | %.2f | %.2f | %s |\n",
                    model.name.c_str(), rims_too ? "divided" : "kept", mesh.triangles.size(), rim_edges(mesh),
                    figures.leaves, figures.nodes,
                    i == 0 ? "" : text("%.2f", static_cast<double>(figures.nodes) / before).c_str(),
                    figures.depth, one.stage("dividing space and cutting"), one.seconds, all.seconds,
                    all.holes().c_str());
        before = figures.nodes;
      }
    }
  }
}

/// The mean angle between the normals of neighbouring faces of the patch, degrees, by the edges' lengths.
double normal_jump(const TriangleMesh& mesh, const AtomicVolumesOptions& options) {
  const Patch patch = run(mesh, options).result.completion.patch;
  LabelledSurface surface;
  for (const Vector3& position : completed(mesh, patch).vertices) {
    surface.vertices.emplace_back();
    surface.vertices.back().position = position;
  }
  surface.triangles = patch.triangles;
  return mean_normal_jump(surface);
}

/// The same for the surface between the volumes, before it is joined to the rims.
double smoothed_jump(const TriangleMesh& mesh, const AtomicVolumesOptions& options) {
  const MeshTopology topology = build_topology(mesh);
  const InputNeighbourhood neighbourhood(mesh);
  const PreparedConstraints constraints(mesh, topology, neighbourhood, options.constraints);
  VolumeSolution solution = solve_volumes(mesh, topology, neighbourhood, options, constraints, options.seed);
  smooth(solution, options, constraints);
  return mean_normal_jump(solution.surface);
}

void smoothed(const std::vector<std::string>& files) {
  std::vector<Model> models = {{"ball, one round hole", test::sphere_with_hole(4, 0.6)},
                               {"ball, ring-shaped gap", test::sphere_with_island(5, 0.6, 0.3)}};
  for (Model& model : models_of(files)) models.push_back(std::move(model));
  struct Way {
    VolumeSmoothing smoothing;
    bool moving_centres;
    int iterations;
  };
  const Way ways[] = {{VolumeSmoothing::none, false, 20},
                      {VolumeSmoothing::constrained, false, 20},
                      {VolumeSmoothing::constrained, false, 100},
                      {VolumeSmoothing::two_pass, false, 20},
                      {VolumeSmoothing::two_pass, true, 20}};
  std::printf(
      "\n| model | the cubes' | constrained | 100 iterations | two passes | moving centres "
      "| constrained, joined to the rims | remeshed and faired "
      "|\n|---|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const Model& model : models) {
    std::string line = "| " + model.name + " |";
    AtomicVolumesOptions options = with_one_position();
    for (const Way& way : ways) {
      options.smoothing = way.smoothing;
      options.moving_centres = way.moving_centres;
      options.smoothing_iterations = way.iterations;
      line += text(" %.1f |", smoothed_jump(model.mesh, options));
    }
    options = with_one_position();
    options.remesh = false;
    options.fairing.reset();
    line += text(" %.1f |", normal_jump(model.mesh, options));
    line += text(" %.1f |", normal_jump(model.mesh, with_one_position()));
    std::printf("%s\n", line.c_str());
  }
}

void depths(const std::vector<std::string>& files) {
  std::vector<Model> models = {
      {"rough ball, three ragged holes", test::rough_sphere_with_ragged_holes(4, 3, 5)}};
  for (Model& model : models_of(files)) models.push_back(std::move(model));
  std::printf(
      "\n| model | greatest depth | leaves | nodes | depth | holes closed | solid | all, one position, s |\n"
      "|---|---:|---:|---:|---:|---:|---|---:|\n");
  for (const Model& model : models) {
    for (const int depth : {6, 8, 10, 0}) {
      AtomicVolumesOptions options = with_one_position();
      if (depth > 0) options.max_depth = depth;
      const Sample sample = run(model.mesh, options);
      std::printf("| %s | %s | %zu | %zu | %d | %s | %s | %.2f |\n", model.name.c_str(),
                  depth > 0 ? std::to_string(depth).c_str() : "none", sample.figures().leaves,
                  sample.figures().nodes, sample.figures().depth, sample.holes().c_str(),
                  soundness(model.mesh, sample.result.completion.patch).c_str(), sample.seconds);
    }
  }
}

std::string between(std::size_t least, std::size_t greatest) {
  return std::to_string(least) + "–" + std::to_string(greatest);
}

/// One mesh with 20 positions of the octree.
void positions_line(const Model& model) {
  constexpr int runs = 20;
  std::size_t closed = 0, solid = 0, restarts = 0;
  std::vector<std::size_t> nodes, depth;
  std::set<std::pair<std::size_t, long long>> topologies;
  double taken = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    AtomicVolumesOptions options = with_one_position();
    options.seed = static_cast<std::uint64_t>(seed);
    const Sample sample = run(model.mesh, options);
    const MeshStatistics after = measure(completed(model.mesh, sample.result.completion.patch), true);
    closed += after.boundary_edges == 0;
    solid += after.solid();
    restarts += static_cast<std::size_t>(sample.figures().restarts);
    nodes.push_back(sample.figures().nodes);
    depth.push_back(static_cast<std::size_t>(sample.figures().depth));
    topologies.emplace(after.components, after.genus.value_or(-1));
    taken += sample.seconds;
    for (const HoleReport& hole : sample.report().holes)
      if (hole.outcome == HoleOutcome::failed)
        std::fprintf(stderr, "%s, seed %d: %s\n", model.name.c_str(), seed, hole.reason.c_str());
  }
  const auto [least, greatest] = std::minmax_element(nodes.begin(), nodes.end());
  const auto [shallowest, deepest] = std::minmax_element(depth.begin(), depth.end());
  std::string shapes;
  for (const auto& [components, genus] : topologies)
    shapes += (shapes.empty() ? "" : "; ") + std::to_string(components) + ", " + std::to_string(genus);
  std::printf("| %s | %zu | %d | %zu | %zu | %zu | %s | %s | %s | %.2f |\n", model.name.c_str(),
              rim_edges(model.mesh), runs, closed, solid, restarts, between(*least, *greatest).c_str(),
              between(*shallowest, *deepest).c_str(), shapes.c_str(), taken / runs);
}

void positions(const std::vector<std::string>& files) {
  std::printf(
      "\n| model | boundary edges | runs | closed | solid | restarts | nodes | depth | components, genus "
      "| s each |\n|---|---:|---:|---:|---:|---:|---:|---:|---|---:|\n");
  positions_line({"ball, one round hole", test::sphere_with_hole(3, 0.5)});
  positions_line({"ball, six holes", test::sphere_with_holes(6, 4, 0.3)});
  positions_line({"ball, ring-shaped gap", test::sphere_with_island(4, 0.7, 0.5)});
  positions_line({"cylinder, open at both ends", test::open_cylinder()});
  positions_line({"torus, one round hole", test::without_ball(test::torus(48, 24), Vector3(1.4, 0, 0), 0.3)});
  positions_line(
      {"rough ball, one hole", test::without_ball(test::rough_sphere(4, 0.05, 1), Vector3(0, 0, 1), 0.5)});
  positions_line({"plate with two tunnels, open",
                  test::without_ball(test::plate_with_tunnels(2), Vector3(0, 0, 0), 1.2)});
  positions_line({"cap of a ball, three holes", little_left()});
  for (const Model& model : models_of(files)) positions_line(model);
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a table that grows as it is measured
  const benchmarks::Arguments arguments(argc, argv,
                                        {"volumes", "subdivided", "smoothed", "depths", "positions"});
  try {
    if (arguments.wanted("volumes")) volumes(arguments.files);
    if (arguments.wanted("subdivided")) subdivided(arguments.files);
    if (arguments.wanted("smoothed")) smoothed(arguments.files);
    if (arguments.wanted("depths")) depths(arguments.files);
    if (arguments.wanted("positions")) positions(arguments.files);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
