// Prints how the unfolding fares: the sizes of the paper's table 1, a model with eight holes, long loops,
// hard unknots, knots.
//
//   unfolding_benchmark [table|eight|long|families]... [loops.txt]      without a word: all
//
// A file of further loops holds, for each, a line "name count" and then a line "x y z" for each point.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/arguments.h"
#include "filter_curveunfold/loop_geometry.h"
#include "filter_curveunfold/unfold.h"
#include "tests/support/loop_families.h"

namespace {

using meshcomplete::Unfolding;
using meshcomplete::UnfoldMethod;
using meshcomplete::UnfoldOptions;
using meshcomplete::UnfoldOutcome;
using meshcomplete::Vector3;
using Loop = std::vector<Vector3>;
namespace families = meshcomplete::testing;

bool has_fitted_projection(const Loop& loop) { return meshcomplete::simple_projection(loop, 0).has_value(); }

/// The annealing over ten seeds and the default method once, as one line.
void print_line(const std::string& title, const Loop& loop) {
  int unfolded = 0;
  double runs = 0, seconds = 0, slowest = 0;
  std::size_t steps = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    UnfoldOptions options;
    options.method = UnfoldMethod::annealing;
    options.seed = seed;
    const Unfolding result = unfold(loop, options);
    unfolded += result.outcome == UnfoldOutcome::annealed;
    runs += result.restarts / 10.0;
    steps += result.steps / 10;
    seconds += result.seconds / 10;
    slowest = std::max(slowest, result.seconds);
  }
  const Unfolding ours = meshcomplete::unfold(loop);
  std::printf("%-24s %5zu | %2d of 10 %6.1f %8zu %8.3f %8.3f | %-12s %5zu %8.4f\n", title.c_str(),
              loop.size(), unfolded, runs, steps, seconds, slowest, name(ours.outcome), ours.steps,
              ours.seconds);
}

void table_one() {
  std::printf("%-24s %5s | %8s %6s %8s %8s %8s | %-12s %5s %8s\n", "rim", "m", "annealed", "runs", "steps",
              "mean s", "max s", "by default", "steps", "s");
  for (const int points : {33, 35, 53, 63}) {
    int shown = 0;
    for (std::uint64_t seed = 1; seed < 2000 && shown < 1; ++seed) {
      const Loop rim = families::rough_rim(points, seed);
      if (has_fitted_projection(rim)) continue;
      ++shown;
      print_line("rough rim, seed " + std::to_string(seed), rim);
    }
  }
}

void eight_holes() {
  double seconds = 0;
  std::size_t points = 0;
  int unfolded = 0;
  std::uint64_t seed = 0;
  for (const int size : {30, 45, 60, 70, 85, 96, 120, 160}) {
    Loop rim;
    do {
      rim = families::rough_rim(size, ++seed);
    } while (has_fitted_projection(rim));
    const Unfolding result = meshcomplete::unfold(rim);
    seconds += result.seconds;
    points += rim.size();
    unfolded += !result.polygon.empty();
  }
  std::printf("\neight rims that no fitted plane shows simple, %zu points: %d unfolded in %.3f s\n", points,
              unfolded, seconds);
}

void long_loops() {
  std::printf("\n%-24s %10s %10s %10s %10s\n", "long loops, seconds", "500", "2000", "10000", "exponent");
  const auto family = [](const char* title, const std::function<Loop(int)>& make) {
    std::vector<double> seconds;
    for (const int points : {500, 2000, 10000}) seconds.push_back(meshcomplete::unfold(make(points)).seconds);
    std::printf("%-24s %10.4f %10.4f %10.4f %10.2f\n", title, seconds[0], seconds[1], seconds[2],
                std::log(seconds[2] / seconds[0]) / std::log(20.0));
  };
  family("saddle", [](int points) { return families::saddle(points, 5, 1); });
  family("wound rim, 4 turns", [](int points) { return families::wound_rim(points, 4, 0.5); });
  family("round a cylinder", [](int points) { return families::wound_round_cylinder(points + 1, 4); });
  family("closed helix, 8 turns", [](int points) { return families::closed_helix(points, 8); });
}

/// One line: how many of the loops were unfolded, and how. The seconds are of the default method.
void family_line(const std::string& title, const std::string& sizes, const std::vector<Loop>& loops) {
  int projected = 0, untangled = 0, knotted = 0;
  double seconds = 0, slowest = 0;
  for (const Loop& loop : loops) {
    const Unfolding result = meshcomplete::unfold(loop);
    projected += result.outcome == UnfoldOutcome::projected;
    untangled += result.outcome == UnfoldOutcome::untangled;
    knotted += result.outcome == UnfoldOutcome::knotted;
    seconds += result.seconds / static_cast<double>(loops.size());
    slowest = std::max(slowest, result.seconds);
  }
  const int all = static_cast<int>(loops.size());
  std::printf("| %s | %s | %d | %d | %d | %d | %d | %.3f | %.3f |\n", title.c_str(), sizes.c_str(), all,
              projected, untangled, knotted, all - projected - untangled - knotted, seconds, slowest);
}

/// Unknots of every kind at hand, and knots.
void all_families() {
  std::printf(
      "\n| loops | points | how many | projected | untangled | refused as knots | not unfolded | mean s | "
      "most s |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const int points : {50, 100, 200, 350, 500}) {
    std::vector<Loop> loops;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) loops.push_back(families::random_tangle(points, seed));
    family_line("random tangles, 20 seeds", std::to_string(points), loops);
  }
  constexpr int sizes[] = {50, 100, 200, 350, 500};
  const auto family = [&](const char* title, const std::function<Loop(int, int)>& make, int least, int most) {
    std::vector<Loop> loops;
    for (const int points : sizes)
      for (int i = least; i <= most; ++i) loops.push_back(make(points, i));
    family_line(title, "50–500", loops);
  };
  family(
      "rims wound twice, 4 heights", [](int n, int i) { return families::wound_rim(n, 2, 0.15 * i); }, 1, 4);
  family(
      "rims wound 3 to 6 times", [](int n, int i) { return families::wound_rim(n, i, 0.3); }, 3, 6);
  family(
      "saddles of 2 to 7 waves", [](int n, int i) { return families::saddle(n, i, 1); }, 2, 7);
  family(
      "saddles, three times as high", [](int n, int i) { return families::saddle(n, i, 3); }, 2, 7);
  family(
      "helices of 2 to 8 turns, closed", [](int n, int i) { return families::closed_helix(n, i); }, 2, 8);
  family(
      "wound round a cylinder 1 to 6 times",
      [](int n, int i) { return families::wound_round_cylinder(n % 2 ? n : n + 1, i); }, 1, 6);
  const auto knots = [&](const char* title, const std::function<Loop(int)>& make) {
    std::vector<Loop> loops;
    for (const int points : sizes) loops.push_back(make(points));
    family_line(title, "50–500", loops);
  };
  knots("trefoils", [](int points) { return families::torus_knot(points, 2, 3); });
  knots("figure eights", [](int points) { return families::figure_eight_knot(points); });
  knots("torus knots (2, 5)", [](int points) { return families::torus_knot(points, 2, 5); });
}

void loops_of_file(const char* path) {
  std::ifstream file(path);
  std::string title;
  std::size_t points = 0;
  std::printf("\n%s\n", path);
  while (file >> title >> points) {
    Loop loop(points);
    for (Vector3& p : loop) file >> p.x() >> p.y() >> p.z();
    print_line(title, loop);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a table that grows as it is measured
  const meshcomplete::benchmarks::Arguments arguments(argc, argv, {"table", "eight", "long", "families"});
  if (arguments.wanted("table")) table_one();
  if (arguments.wanted("eight")) eight_holes();
  if (arguments.wanted("long")) long_loops();
  if (arguments.wanted("families")) all_families();
  for (const std::string& file : arguments.files) loops_of_file(file.c_str());
  return 0;
}
