// Prints how hole filling by curve unfolding fares from the mesh to the patch: holes of the sizes of the
// paper's table 1, its model with eight holes, long holes, and a large mesh. `unfolding_benchmark` looks at
// the unfolding alone.
//
//   curve_unfolding_benchmark [table|eight|long|large]...      without arguments: all

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "filter_curveunfold/curve_unfolding.h"
#include "filter_curveunfold/loop_geometry.h"
#include "tests/support/meshes.h"

namespace {

using namespace meshcomplete;
using Clock = std::chrono::steady_clock;

constexpr double pi = 3.14159265358979323846;
constexpr double patience = 120;  // seconds that a hole may take before it is given up

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// --- meshes
// --------------------------------------------------------------------------------------------------------

double uniform(std::mt19937& random) { return random() * 0x1p-32; }

std::vector<BoundaryLoop> loops_of(const TriangleMesh& mesh) {
  return trace_boundary_loops(mesh, build_topology(mesh));
}

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
           const MeshSelection& selection = MeshSelection()) {
  Sample sample;
  const Clock::time_point start = Clock::now();
  try {
    const CurveUnfoldingResult result = fill_by_curve_unfolding(
        mesh, selection, options,
        Progress([&](double, const std::string&) { return seconds_since(start) < patience; }));
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

struct Spread {
  double mean = 0, deviation = 0;
};

Spread spread(const std::vector<Sample>& samples, double Sample::*value) {
  Spread s;
  const double n = static_cast<double>(samples.size());
  for (const Sample& sample : samples) s.mean += sample.*value / n;
  for (const Sample& sample : samples) s.deviation += (sample.*value - s.mean) * (sample.*value - s.mean) / n;
  s.deviation = std::sqrt(s.deviation);
  return s;
}

// --- tables
// --------------------------------------------------------------------------------------------------------

/// Ten seeds of the annealing as published with both of the paper's energies, and the default once.
void table_line(const char* model, const TriangleMesh& mesh) {
  std::vector<Sample> membrane, thin_plate;
  CurveUnfoldingOptions options;
  options.unfolding.method = UnfoldMethod::annealing;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    options.unfolding.seed = seed;
    options.energy = SurfaceEnergy::membrane;
    membrane.push_back(run(mesh, options));
    options.energy = SurfaceEnergy::thin_plate;
    thin_plate.push_back(run(mesh, options));
  }
  const Sample ours = run(mesh, CurveUnfoldingOptions());
  std::size_t rim = 0, holes = 0;
  for (const BoundaryLoop& loop : loops_of(mesh)) rim += loop.vertices.size(), ++holes;
  const double per_hole = 1.0 / static_cast<double>(holes);
  const Spread restarts = spread(membrane, &Sample::restarts), steps = spread(membrane, &Sample::steps);
  const Spread unfolding = spread(membrane, &Sample::unfolding);
  const auto closed = [](const std::vector<Sample>& samples) {
    return std::count_if(samples.begin(), samples.end(), [](const Sample& s) { return s.closed; });
  };
  std::printf(
      "| %s | %zu | %zu | %.1f ± %.1f | %.0f ± %.0f | %.3f ± %.3f | %ld | %.3f | %ld | %.3f | %.4f | %.3f | "
      "%s |\n",
      model, mesh.vertices.size(), rim, restarts.mean * per_hole, restarts.deviation * per_hole, steps.mean,
      steps.deviation, unfolding.mean, unfolding.deviation, static_cast<long>(closed(membrane)),
      spread(membrane, &Sample::embedding).mean, static_cast<long>(closed(thin_plate)),
      spread(thin_plate, &Sample::embedding).mean, ours.unfolding, ours.embedding,
      joined(ours.routes).c_str());
}

void table_one() {
  std::printf(
      "\nTen seeds of the annealing, and the default; seconds; the paper's d is the restarts per hole\n\n"
      "| model | n | m | restarts | steps | annealing | membrane closed | embedding | thin plate closed "
      "| embedding | default: unfolding | embedding | route |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n");
  table_line("five holes", five_holes());
  for (const std::size_t size : {35, 33, 53, 63}) {
    const std::optional<TriangleMesh> mesh = strongly_curved(3, size);
    if (mesh) table_line("winding hole", *mesh);
  }
}

void eight_holes() {
  TriangleMesh model;
  std::size_t rim = 0, holes = 0;
  for (const std::size_t size : {30, 53, 53, 70, 84, 96, 120, 160}) {
    std::optional<TriangleMesh> ball = strongly_curved(size < 80 ? 4 : 5, size);
    if (!ball) continue;
    model = test::join(model, test::translated(*ball, Vector3(3.0 * static_cast<double>(holes++), 0, 0)));
    rim += size;
  }
  std::printf(
      "\n%zu strongly curved holes, %zu rim vertices, mesh of %zu vertices\n\n"
      "| unfolding by | seconds unfolding | embedding | checking | filter | faces | all closed |\n"
      "|---|---:|---:|---:|---:|---:|---|\n",
      holes, rim, model.vertices.size());
  for (const UnfoldMethod method : {UnfoldMethod::automatic, UnfoldMethod::annealing}) {
    CurveUnfoldingOptions options;
    options.unfolding.method = method;
    const Sample sample = run(model, options);
    std::printf("| %s | %.3f | %.3f | %.3f | %.3f | %zu | %s |\n",
                method == UnfoldMethod::automatic ? "default" : "annealing", sample.unfolding,
                sample.embedding, sample.checking, sample.wall, sample.faces,
                sample.closed ? "yes" : joined(sample.routes).c_str());
  }
}

void long_holes() {
  std::printf(
      "\nLong holes, seconds\n\n"
      "| hole | m | unfolding | embedding | checking | filter | faces | route |\n"
      "|---|---:|---:|---:|---:|---:|---:|---|\n");
  for (const int half_turns : {0, 5}) {
    std::vector<double> sizes, seconds;
    for (const int size : {500, 2000, 10000}) {
      const TriangleMesh mesh = long_gap(size, half_turns);
      CurveUnfoldingOptions options;
      options.holes.selected_only = true;  // the other rim of the walls stays open
      MeshSelection selection;
      selection.vertices.assign(mesh.vertices.size(), false);
      std::fill_n(selection.vertices.begin(), size, true);
      const Sample sample = run(mesh, options, selection);
      std::printf("| %s | %d | %.3f | %.3f | %.3f | %.3f | %zu | %s |\n",
                  half_turns == 0 ? "wavy" : "twisted", size, sample.unfolding, sample.embedding,
                  sample.checking, sample.wall, sample.faces,
                  sample.gave_up ? "given up" : joined(sample.routes).c_str());
      if (!sample.gave_up) sizes.push_back(size), seconds.push_back(sample.wall);
    }
    if (sizes.size() > 1)
      std::printf("| exponent of growth | | | | | %.2f | | |\n",
                  std::log(seconds.back() / seconds.front()) / std::log(sizes.back() / sizes.front()));
  }
}

void large_mesh() {
  const TriangleMesh mesh = test::sphere_with_holes(6, 8, 0.05);
  const Sample sample = run(mesh, CurveUnfoldingOptions());
  std::printf("\nmesh of %zu faces with 6 holes: %.3f s, %zu faces added, %s\n", mesh.triangles.size(),
              sample.wall, sample.faces, sample.closed ? "all closed" : joined(sample.routes).c_str());
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a table that grows as it is measured
  const std::set<std::string> asked(argv + 1, argv + argc);
  const auto wanted = [&](const char* name) { return asked.empty() || asked.count(name) > 0; };
  if (wanted("table")) table_one();
  if (wanted("eight")) eight_holes();
  if (wanted("long")) long_holes();
  if (wanted("large")) large_mesh();
  return 0;
}
