// Prints how hole filling by curve unfolding fares from the mesh to the patch: holes of the sizes of the
// paper's table 1, its model with eight holes, long holes, and large meshes. `unfolding_benchmark` looks at
// the unfolding alone.
//
//   curve_unfolding_benchmark [table|eight|long|large|beside]... [MESH...]     without a word: all
//
// With meshes, `table` takes their holes as they are, one by one and all together, and cuts winding holes
// into those that have none; `eight` cuts eight holes into the first; `long` refines each to a million faces
// and cuts long ones into it; `beside` closes their holes by turns with CGAL, those of whole meshes after
// they have been refined to a million faces and got six holes. Without, meshes are made in code.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/arguments.h"
#include "benchmarks/cgal_filling.h"
#include "benchmarks/cut_holes.h"
#include "benchmarks/measuring.h"
#include "benchmarks/mesh_file.h"
#include "common/core/error.h"
#include "filter_curveunfold/curve_unfolding.h"
#include "filter_curveunfold/loop_geometry.h"
#include "tests/support/meshes.h"

namespace {

using namespace meshcomplete;
using benchmarks::Clock;
using benchmarks::CutMesh;
using benchmarks::file_name;
using benchmarks::load_average;
using benchmarks::loops_of;
using benchmarks::median;
using benchmarks::Rim;
using benchmarks::seconds_since;

constexpr double pi = 3.14159265358979323846;
constexpr double patience = 120;       // seconds that a run may take before it is given up
constexpr double short_patience = 10;  // the same for each seed of table 1
constexpr double long_patience = 600;  // the same for the annealing of eight holes

// --- meshes
// --------------------------------------------------------------------------------------------------------

double uniform(std::mt19937& random) { return random() * 0x1p-32; }

std::vector<Vector3> points(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  std::vector<Vector3> list;
  for (Index v : loop.vertices) list.push_back(mesh.vertices[v]);
  return list;
}

/// A rough ball from which a band is cut that winds in waves half-way round it.
TriangleMesh ball_with_winding_hole(int subdivisions, std::uint32_t seed) {
  std::mt19937 random(seed);
  const double reach = 1.5 + 2 * uniform(random), phase = 2 * pi * uniform(random);
  const double climb = 0.15 + 0.35 * uniform(random), waves = 1.5 + 2 * uniform(random);
  const double half_width = (0.5 + 2 * uniform(random)) * std::pow(0.5, subdivisions);
  const TriangleMesh ball = test::rough_sphere(subdivisions, 0.05, seed);
  return test::without_faces(ball, [&](Index face) {
    Vector3 centre = Vector3::Zero();
    for (Index corner : ball.triangles[face]) centre += ball.vertices[corner];
    centre.normalize();
    const double around = std::atan2(centre.y(), centre.x());
    const double height = std::asin(centre.z()) - climb * std::sin(waves * around + phase);
    return std::abs(around) < reach / 2 && std::abs(height) < half_width;
  });
}

/// The first such ball with one hole, of that many vertices, that no fitted plane shows as a simple polygon:
/// in the finest ball in which one turns up. The paper's models are not to be had; their sizes are.
std::optional<TriangleMesh> strongly_curved(int subdivisions, std::size_t size) {
  for (std::uint32_t seed = 1; seed < 1500; ++seed) {
    TriangleMesh mesh = ball_with_winding_hole(subdivisions, seed);
    const std::vector<BoundaryLoop> loops = loops_of(mesh);
    if (loops.size() == 1 && loops[0].defect == LoopDefect::none && loops[0].vertices.size() == size &&
        !simple_projection(points(mesh, loops[0]), 0))
      return mesh;
  }
  if (subdivisions > 2) return strongly_curved(subdivisions - 1, size);
  return std::nullopt;
}

/// Five round holes with 79 vertices in all, as the low-resolution bunny has.
TriangleMesh five_holes() {
  const TriangleMesh ball = test::rough_sphere(4, 0.02, 1);
  for (std::uint32_t seed = 1;; ++seed) {
    std::mt19937 random(seed);
    TriangleMesh mesh = ball;
    for (int i = 0; i < 5; ++i) {
      const Vector3 centre(std::cos(2 * pi * i / 5), std::sin(2 * pi * i / 5), 0.2 * i - 0.4);
      mesh = test::without_ball(mesh, centre.normalized(), 0.1 + 0.25 * uniform(random));
    }
    std::size_t total = 0;
    const std::vector<BoundaryLoop> loops = loops_of(mesh);
    for (const BoundaryLoop& loop : loops) total += loop.vertices.size();
    if (loops.size() == 5 && total == 79) return mesh;
  }
}

/// A gap between two walls that runs nearly round a circle, `width` edges wide, in waves; `half_turns`: the
/// gap turns about its middle line that often. As many faces are needed to close it as its rim is long.
TriangleMesh long_gap(int size, int half_turns) {
  constexpr int width = 6;
  const int side = size / 2 - width;
  const double reach = 1.8 * pi, edge = reach / side;
  std::vector<Vector3> rim, outer;
  const auto add = [&](double t, double across) {
    const Vector3 radial(std::cos(t), std::sin(t), 0), up(0, 0, 1);
    const double turn = half_turns * pi * t / reach;
    const Vector3 sideways = std::cos(turn) * radial + std::sin(turn) * up;
    const Vector3 tangent(-std::sin(t), std::cos(t), 0);
    const Vector3 down = -tangent.cross(sideways).normalized();
    const Vector3 p = radial + 0.2 * std::sin(5 * t) * up + across * edge * sideways;
    rim.push_back(as_stored(p));
    outer.push_back(as_stored(p + edge * down));
  };
  for (int i = 0; i < side; ++i) add(edge * i, 0.5 * width);
  for (int i = 0; i < width; ++i) add(edge * side, 0.5 * width - i);
  for (int i = side; i > 0; --i) add(edge * i, -0.5 * width);
  for (int i = 0; i < width; ++i) add(0, i - 0.5 * width);
  return test::collar(rim, outer);
}

// --- measuring
// -----------------------------------------------------------------------------------------------------

struct Sample {
  bool closed = false;  ///< every hole
  bool gave_up = false;
  double restarts = 0, steps = 0, unfolding = 0, embedding = 0, checking = 0,
         wall = 0;  ///< of all holes together
  std::size_t faces = 0;
  std::set<std::string> routes;
};

/// Closes the selected holes, or all.
Sample run(const TriangleMesh& mesh, const CurveUnfoldingOptions& options,
           const MeshSelection& selection = MeshSelection(), double limit = patience) {
  Sample sample;
  const Clock::time_point start = Clock::now();
  try {
    const CurveUnfoldingResult result = fill_by_curve_unfolding(
        mesh, selection, options,
        Progress([&](double, const std::string&) { return seconds_since(start) < limit; }));
    for (const HoleTimes& times : result.times) {
      sample.restarts += times.restarts;
      sample.steps += static_cast<double>(times.steps);
      sample.unfolding += times.unfolding;
      sample.embedding += times.embedding;
      sample.checking += times.checking;
    }
    const CompletionReport& report = result.completion.report;
    sample.closed = report.count(HoleOutcome::failed) == 0 && report.count(HoleOutcome::closed) > 0;
    sample.faces = result.completion.patch.triangles.size();
    for (const HoleReport& hole : report.holes)
      if (hole.outcome != HoleOutcome::skipped)
        sample.routes.insert(hole.route.empty() ? hole.reason : hole.route);
  } catch (const Cancelled&) {
    sample.gave_up = true;
  }
  sample.wall = seconds_since(start);
  return sample;
}

std::string joined(const std::set<std::string>& texts) {
  std::string line;
  for (const std::string& text : texts) line += (line.empty() ? "" : "; ") + text;
  return line;
}

/// Mean, least and greatest of what ten seeds gave, for a table.
std::string spread(const std::vector<double>& values, int digits) {
  if (values.empty()) return "–";
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  char text[80];
  std::snprintf(text, sizeof text, "%.*f (%.*f–%.*f)", digits, mean, digits, *least, digits, *greatest);
  return text;
}

std::vector<double> values(const std::vector<Sample>& samples, double Sample::*value) {
  std::vector<double> list;
  for (const Sample& sample : samples)
    if (!sample.gave_up) list.push_back(sample.*value);
  return list;
}

// --- tables
// --------------------------------------------------------------------------------------------------------

struct Case {
  std::string model;
  TriangleMesh mesh;
  std::vector<std::vector<Vector3>> rims;  // that are to be closed
  MeshSelection selection;                 // of them, when there are others
};

Case all_loops(const std::string& model, const TriangleMesh& mesh) {
  Case all{model, mesh, {}, {}};
  for (const BoundaryLoop& loop : loops_of(mesh))
    if (loop.defect == LoopDefect::none) all.rims.push_back(points(mesh, loop));
  return all;
}

/// Ten seeds of the annealing as published: the unfolding alone, and where that succeeds the filter with both
/// of the paper's energies; and the default once.
void table_line(const Case& hole) {
  std::vector<double> restarts, steps, seconds;
  std::vector<Sample> samples[2];
  CurveUnfoldingOptions options;
  options.holes.selected_only = !hole.selection.vertices.empty();
  const Sample ours = run(hole.mesh, options, hole.selection);
  options.unfolding.method = UnfoldMethod::annealing;
  for (options.unfolding.seed = 1; options.unfolding.seed <= 10; ++options.unfolding.seed) {
    std::size_t unfolded = 0;
    restarts.push_back(0), steps.push_back(0), seconds.push_back(0);
    for (const std::vector<Vector3>& rim : hole.rims) {
      const Unfolding result = unfold(rim, options.unfolding);
      unfolded += result.outcome == UnfoldOutcome::annealed;
      restarts.back() += result.restarts / static_cast<double>(hole.rims.size());
      steps.back() += static_cast<double>(result.steps);
      seconds.back() += result.seconds;
    }
    if (unfolded < hole.rims.size()) continue;
    for (const int thin_plate : {0, 1}) {
      options.energy = thin_plate ? SurfaceEnergy::thin_plate : SurfaceEnergy::membrane;
      samples[thin_plate].push_back(run(hole.mesh, options, hole.selection, short_patience));
    }
  }
  std::size_t points = 0;
  for (const std::vector<Vector3>& rim : hole.rims) points += rim.size();
  const auto closed = [](const std::vector<Sample>& list) {
    return static_cast<long>(
        std::count_if(list.begin(), list.end(), [](const Sample& s) { return s.closed; }));
  };
  std::printf("| %s | %zu | %zu | %zu | %s | %s | %s | %ld | %s | %ld | %s | %.4f | %.4f | %s |\n",
              hole.model.c_str(), hole.mesh.vertices.size(), points, samples[0].size(),
              spread(restarts, 1).c_str(), spread(steps, 0).c_str(), spread(seconds, 3).c_str(),
              closed(samples[0]), spread(values(samples[0], &Sample::embedding), 3).c_str(),
              closed(samples[1]), spread(values(samples[1], &Sample::embedding), 3).c_str(), ours.unfolding,
              ours.embedding, joined(ours.routes).c_str());
}

/// Winding holes of the paper's sizes in a whole mesh, four edges wide: for each size the first three seeds
/// that give a strongly curved one. Which seeds those are does not depend on how hard the rims are to unfold.
void winding_lines(const std::string& model, const TriangleMesh& mesh) {
  for (const std::size_t size : {35, 33, 53, 63}) {
    std::uint32_t seed = 1;
    for (int i = 0; i < 3; ++i) {
      const std::optional<CutMesh> cut =
          benchmarks::cut_winding_hole(mesh, size, Rim::strongly_curved, seed, {}, 2);
      if (!cut) break;
      seed = cut->seed + 1;
      table_line({model + ", cut " + std::to_string(cut->seed), cut->mesh, {cut->rim}, {}});
    }
  }
}

/// The holes of a mesh, one by one and all together, without those that cannot be closed.
void hole_lines(const std::string& model, const TriangleMesh& mesh) {
  Case all{model + ", all these", mesh, {}, {}};
  all.selection.vertices.assign(mesh.vertices.size(), false);
  for (const BoundaryLoop& loop : loops_of(mesh)) {
    if (loop.defect != LoopDefect::none) {
      std::fprintf(stderr, "%s: left out a rim of %zu vertices: %s\n", model.c_str(), loop.vertices.size(),
                   describe(loop.defect).c_str());
      continue;
    }
    Case one{model + ", one hole", mesh, {points(mesh, loop)}, {}};
    one.selection.vertices.assign(mesh.vertices.size(), false);
    for (Index v : loop.vertices) one.selection.vertices[v] = all.selection.vertices[v] = true;
    all.rims.push_back(one.rims[0]);
    table_line(one);
  }
  table_line(all);
}

void table_one(const std::vector<std::string>& files) {
  std::printf(
      "\nTen seeds of the annealing, and the default; seconds; mean (least–greatest)\n\n"
      "| hole | n | m | unfolded of 10 | restarts | steps | annealing s | membrane: closed of 10 | embedding "
      "s "
      "| thin plate: closed of 10 | embedding s | default: unfolding s | embedding s | route |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n");
  for (const std::string& file : files) {
    const TriangleMesh mesh = benchmarks::read_mesh(file);
    if (loops_of(mesh).empty())
      winding_lines(file_name(file), mesh);
    else
      hole_lines(file_name(file), mesh);
  }
  if (!files.empty()) return;
  table_line(all_loops("ball, five holes", five_holes()));
  for (const std::size_t size : {35, 33, 53, 63}) {
    const std::optional<TriangleMesh> mesh = strongly_curved(3, size);
    if (mesh) table_line(all_loops("ball, winding hole", *mesh));
  }
}

/// As many rim vertices in eight holes as the paper's chicken has.
constexpr std::size_t eight_sizes[] = {30, 53, 53, 70, 84, 96, 120, 160};

/// Eight winding holes in one mesh.
TriangleMesh with_eight_holes(TriangleMesh mesh) {
  std::uint32_t seed = 1;
  for (const std::size_t size : eight_sizes) {
    const std::optional<CutMesh> cut =
        benchmarks::cut_winding_hole(mesh, size, Rim::strongly_curved, seed, {}, 2);
    if (!cut) continue;
    mesh = cut->mesh;
    seed = cut->seed + 1;
  }
  return mesh;
}

/// Eight winding holes in balls of their own.
TriangleMesh eight_balls() {
  TriangleMesh model;
  double place = 0;
  for (const std::size_t size : eight_sizes) {
    const std::optional<TriangleMesh> ball = strongly_curved(size < 80 ? 4 : 5, size);
    if (ball) model = test::join(model, test::translated(*ball, Vector3(3 * place++, 0, 0)));
  }
  return model;
}

void eight_holes(const std::vector<std::string>& files) {
  const Case model = files.empty()
                         ? all_loops("balls", eight_balls())
                         : all_loops(file_name(files[0]), with_eight_holes(benchmarks::read_mesh(files[0])));
  std::size_t rim = 0;
  for (const std::vector<Vector3>& loop : model.rims) rim += loop.size();
  std::printf(
      "\n%s: %zu strongly curved holes, %zu rim vertices, mesh of %zu vertices; seconds\n\n"
      "| energy | unfolding | embedding | checking | filter | faces | outcome |\n"
      "|---|---:|---:|---:|---:|---:|---|\n",
      model.model.c_str(), model.rims.size(), rim, model.mesh.vertices.size());
  for (const SurfaceEnergy energy : {SurfaceEnergy::thin_plate, SurfaceEnergy::membrane}) {
    CurveUnfoldingOptions options;
    options.energy = energy;
    const Sample sample = run(model.mesh, options);
    std::printf("| %s | %.3f | %.3f | %.3f | %.3f | %zu | %s: %s |\n",
                energy == SurfaceEnergy::membrane ? "membrane" : "thin plate", sample.unfolding,
                sample.embedding, sample.checking, sample.wall, sample.faces,
                sample.closed ? "all closed" : "not all closed", joined(sample.routes).c_str());
  }

  std::printf(
      "\nAnnealing, one seed, one hole after the other, %.0f s at most\n\n"
      "| m | runs | steps | s | unfolded |\n|---:|---:|---:|---:|---|\n",
      long_patience);
  const Clock::time_point start = Clock::now();
  std::size_t unfolded = 0;
  for (const std::vector<Vector3>& loop : model.rims) {
    UnfoldOptions options;
    options.method = UnfoldMethod::annealing;
    const Clock::time_point begin = Clock::now();
    try {
      const Unfolding result =
          unfold(loop, options,
                 Progress([&](double, const std::string&) { return seconds_since(start) < long_patience; }));
      unfolded += !result.polygon.empty();
      std::printf("| %zu | %d | %zu | %.2f | %s |\n", loop.size(), result.restarts, result.steps,
                  result.seconds, result.polygon.empty() ? "no" : "yes");
    } catch (const Cancelled&) {
      std::printf("| %zu | | | %.2f | given up |\n", loop.size(), seconds_since(begin));
    }
  }
  std::printf("| %zu | | | %.2f | %zu of %zu |\n", rim, seconds_since(start), unfolded, model.rims.size());
}

/// Prints the line of one hole; returns what the hole alone took, nothing when it was not closed.
std::optional<double> long_line(const std::string& title, std::size_t size, const TriangleMesh& mesh,
                                const CurveUnfoldingOptions& options, const MeshSelection& selection) {
  const Sample sample = run(mesh, options, selection);
  std::printf("| %s | %zu | %.3f | %.3f | %.3f | %.3f | %zu | %s |\n", title.c_str(), size, sample.unfolding,
              sample.embedding, sample.checking, sample.wall, sample.faces,
              sample.gave_up ? "given up" : joined(sample.routes).c_str());
  if (!sample.closed) return std::nullopt;
  return sample.unfolding + sample.embedding + sample.checking;
}

void print_growth(const std::vector<double>& sizes, const std::vector<double>& seconds) {
  if (sizes.size() > 1)
    std::printf("| exponent of growth, %.0f to %.0f | | | | | %.2f | | |\n", sizes.front(), sizes.back(),
                std::log(seconds.back() / seconds.front()) / std::log(sizes.back() / sizes.front()));
}

TriangleMesh refined_to_a_million(TriangleMesh mesh) {
  while (mesh.triangles.size() < 1000000) mesh = benchmarks::subdivided(mesh);
  return mesh;
}

void long_holes(const std::vector<std::string>& files) {
  std::printf(
      "\nLong holes, seconds\n\n"
      "| hole | m | unfolding | embedding | checking | filter | faces | route |\n"
      "|---|---:|---:|---:|---:|---:|---:|---|\n");
  for (const int half_turns : {0, 5}) {
    std::vector<double> sizes, seconds;
    for (const int size : {500, 2000, 10000}) {
      CurveUnfoldingOptions options;
      options.holes.selected_only = true;  // the other rim of the walls stays open
      const TriangleMesh mesh = long_gap(size, half_turns);
      MeshSelection selection;
      selection.vertices.assign(mesh.vertices.size(), false);
      std::fill_n(selection.vertices.begin(), size, true);
      const auto taken = long_line(half_turns == 0 ? "wavy gap" : "twisted gap",
                                   static_cast<std::size_t>(size), mesh, options, selection);
      if (taken) sizes.push_back(size), seconds.push_back(*taken);
    }
    print_growth(sizes, seconds);
  }
  for (const std::string& file : files) {
    const TriangleMesh mesh = refined_to_a_million(benchmarks::read_mesh(file));
    std::vector<double> sizes, seconds;
    for (const std::size_t size : {500, 1000, 2000}) {
      const std::optional<CutMesh> cut =
          benchmarks::cut_winding_hole(mesh, size, Rim::strongly_curved, 1, {}, 3);
      if (!cut) continue;
      const auto taken = long_line(file_name(file) + ", " + std::to_string(mesh.triangles.size()) + " faces",
                                   size, cut->mesh, CurveUnfoldingOptions(), MeshSelection());
      if (taken) sizes.push_back(static_cast<double>(size)), seconds.push_back(*taken);
    }
    print_growth(sizes, seconds);
  }
}

void large_mesh() {
  const TriangleMesh mesh = test::sphere_with_holes(6, 8, 0.05);
  const Sample sample = run(mesh, CurveUnfoldingOptions());
  std::printf("\nmesh of %zu faces with 6 holes: %.3f s, %zu faces added, %s\n", mesh.triangles.size(),
              sample.wall, sample.faces, sample.closed ? "all closed" : joined(sample.routes).c_str());
}

/// A whole mesh refined to a million faces or more, with six winding holes.
TriangleMesh large_with_holes(TriangleMesh mesh) {
  mesh = refined_to_a_million(std::move(mesh));
  for (const std::size_t size : {60, 100, 150, 200, 300, 400}) {
    const std::optional<CutMesh> cut = benchmarks::cut_winding_hole(mesh, size, Rim::any, 1, {}, 3);
    if (cut) mesh = cut->mesh;
  }
  return mesh;
}

/// The filter and CGAL by turns on the same mesh in memory.
void beside_cgal(const std::vector<std::string>& files) {
  std::printf(
      "\nBy turns, seven times; seconds; median (least–greatest)\n\n"
      "| mesh | faces | rims | filter | closed | faces added | CGAL filling | filled | faces added "
      "| CGAL with its own mesh made and read back | load |\n"
      "|---|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const std::string& file : files) {
    TriangleMesh mesh = benchmarks::read_mesh(file);
    if (loops_of(mesh).empty()) mesh = large_with_holes(mesh);
    std::string rims;
    for (const BoundaryLoop& loop : loops_of(mesh))
      rims += (rims.empty() ? "" : ", ") + std::to_string(loop.vertices.size());
    std::vector<double> ours, filling, whole;
    Sample sample;
    benchmarks::CgalFilling cgal;
    for (int i = 0; i < 7; ++i) {
      sample = run(mesh, CurveUnfoldingOptions());
      ours.push_back(sample.wall);
      const Clock::time_point start = Clock::now();
      cgal = benchmarks::fill_with_cgal(mesh);
      whole.push_back(seconds_since(start));
      filling.push_back(cgal.seconds);
    }
    const auto text = [](const std::vector<double>& list) {
      const auto [least, greatest] = std::minmax_element(list.begin(), list.end());
      char line[80];
      std::snprintf(line, sizeof line, "%.3f (%.3f–%.3f)", median(list), *least, *greatest);
      return std::string(line);
    };
    std::printf("| %s | %zu | %s | %s | %s | %zu | %s | %zu of %zu | %zu | %s | %s |\n",
                file_name(file).c_str(), mesh.triangles.size(), rims.c_str(), text(ours).c_str(),
                sample.closed ? "all" : "not all", sample.faces, text(filling).c_str(), cgal.filled,
                cgal.holes, cgal.mesh.triangles.size() - mesh.triangles.size(), text(whole).c_str(),
                load_average().c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a table that grows as it is measured
  const benchmarks::Arguments arguments(argc, argv, {"table", "eight", "long", "large", "beside"});
  try {
    if (arguments.wanted("table")) table_one(arguments.files);
    if (arguments.wanted("eight")) eight_holes(arguments.files);
    if (arguments.wanted("long")) long_holes(arguments.files);
    if (arguments.wanted("large")) large_mesh();
    if (arguments.wanted("beside")) beside_cgal(arguments.files);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
