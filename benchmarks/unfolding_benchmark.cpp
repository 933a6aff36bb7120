// Prints how the unfolding fares: the sizes of the paper's table 1, a model with eight holes, long loops,
// hard unknots.
//
//   unfolding_benchmark [loops.txt]
//
// A file of further loops holds, for each, a line "name count" and then a line "x y z" for each point.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

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

const char* name(UnfoldOutcome outcome) {
  switch (outcome) {
    case UnfoldOutcome::projected:
      return "projected";
    case UnfoldOutcome::annealed:
      return "annealed";
    case UnfoldOutcome::untangled:
      return "untangled";
    case UnfoldOutcome::knotted:
      return "knotted";
    case UnfoldOutcome::not_unfolded:
      return "not unfolded";
  }
  return "";
}

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

void hard_unknots() {
  std::printf("\n%-24s %5s %12s %10s %10s\n", "random tangles", "m", "unfolded", "mean s", "max s");
  for (const int points : {50, 100, 200, 350, 500}) {
    int unfolded = 0;
    double seconds = 0, slowest = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Unfolding result = meshcomplete::unfold(families::random_tangle(points, seed));
      unfolded += !result.polygon.empty();
      seconds += result.seconds / 20;
      slowest = std::max(slowest, result.seconds);
    }
    std::printf("%-24s %5d %6d of 20 %10.3f %10.3f\n", "", points, unfolded, seconds, slowest);
  }
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
  table_one();
  eight_holes();
  long_loops();
  hard_unknots();
  for (int i = 1; i < argc; ++i) loops_of_file(argv[i]);
  return 0;
}
