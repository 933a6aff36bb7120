#include "filter_atomicvolumes/lines_of_sight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "common/core/counted.h"
#include "common/core/threads.h"
#include "filter_atomicvolumes/volume_locator.h"

namespace meshcomplete {
namespace {

// A line that passes beside a triangle by less than this share of its size meets it: lines do not slip
// through between two triangles, also when they come from a thousand mesh sizes away.
constexpr double beside_share = 1e-6;

// The part of the mean chord for which a line must pass through a volume.
constexpr double least_chord = 0.5;

// Lines per task.
constexpr std::size_t grain = 64;

struct Hit {
  double share;  // of the way
  bool from_behind;
};

// Where a segment enters and leaves a convex body, as distances along it; empty when `enter` > `leave`.
struct Interval {
  double enter, leave;

  // Leaves the part where outside + t * slope <= 0.
  void clip(double outside, double slope) {
    if (slope > 0)
      leave = std::min(leave, -outside / slope);
    else if (slope < 0)
      enter = std::max(enter, -outside / slope);
    else if (outside > 0)
      leave = -std::numeric_limits<double>::infinity();
  }
  bool empty() const { return !(enter < leave); }
};

// The direction and length of a line, worked out once.
struct Path {
  Vector3 from, direction;
  double length;

  Path(const Vector3& a, const Vector3& b) : from(a), direction(b - a), length(direction.norm()) {
    direction /= length;
  }
  Interval through(const Vector3& low, const Vector3& high) const {
    Interval interval{0, length};
    for (int k = 0; k < 3; ++k) {
      interval.clip(low[k] - from[k], -direction[k]);
      interval.clip(from[k] - high[k], direction[k]);
    }
    return interval;
  }
};

std::optional<Hit> first_hit(const TriangleBlocks& blocks, const Vector3& from, const Vector3& to) {
  const TriangleMesh& mesh = blocks.mesh();
  const Path path(from, to);
  double nearest = path.length;
  std::optional<Hit> hit;
  const auto try_triangle = [&](Index t) {
    const Triangle& corners = mesh.triangles[t];
    const Vector3& a = mesh.vertices[corners[0]];
    const Vector3 u = mesh.vertices[corners[1]] - a, v = mesh.vertices[corners[2]] - a, normal = u.cross(v);
    const double slope = normal.dot(path.direction);
    if (slope == 0 || !std::isfinite(slope)) return;
    const double at = normal.dot(a - from) / slope;
    if (!(at >= 0 && at < nearest)) return;
    const Vector3 p = from + at * path.direction - a;
    const double area = normal.squaredNorm(), beta = p.cross(v).dot(normal) / area,
                 gamma = u.cross(p).dot(normal) / area;
    if (beta < -beside_share || gamma < -beside_share || beta + gamma > 1 + beside_share) return;
    nearest = at;
    hit = Hit{at / path.length, slope > 0};
  };
  const auto enter = [&](const Box& box) {
    const Interval through = path.through(Vector3(box.low[0], box.low[1], box.low[2]),
                                          Vector3(box.high[0], box.high[1], box.high[2]));
    return through.enter <= through.leave && through.enter <= nearest;
  };
  blocks.tree().descend(enter, [&](std::size_t block) {
    return blocks.visit_block(block, [&](Index t) {
      try_triangle(t);
      return true;
    });
  });
  return hit;
}

// Walks the octree along a line and marks the volumes that it sees through.
class Carver {
 public:
  Carver(const Lattice& lattice, const Decomposition& decomposition, const VolumeComplex* complex,
         std::vector<std::atomic<char>>& seen)
      : lattice_(lattice), decomposition_(decomposition), complex_(complex), seen_(seen) {
    if (!complex) return;
    first_tetrahedron_ = first_of_cubes(complex->free_tetrahedra);
    first_cell_ = first_of_cubes(complex->convex_cells);
  }

  void carve(const LineOfSight& line) const { walk(Path(line.from, line.to), 0); }

 private:
  void walk(const Path& path, Index cube) const;
  void carve_tetrahedron(const Path& path, std::size_t number) const;
  void carve_cell(const Path& path, const VolumeComplex::ConvexCell& cell) const;
  void mark(Cell node) const { seen_[static_cast<std::size_t>(node)].store(1, std::memory_order_relaxed); }
  static bool sees_through(const Path& path, const Interval& inside, double mean_chord);
  // Where the parts of each cube begin, in a list that goes cube by cube.
  template <class Parts>
  std::vector<std::size_t> first_of_cubes(const Parts& parts) const {
    std::vector<std::size_t> first(decomposition_.octree.size() + 1, 0);
    for (const auto& part : parts) ++first[part.cube + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    return first;
  }

  const Lattice& lattice_;
  const Decomposition& decomposition_;
  const VolumeComplex* complex_;          // absent: leaves are marked
  std::vector<std::atomic<char>>& seen_;  // set from many threads, always to the same value
  std::vector<std::size_t> first_tetrahedron_, first_cell_;  // of each cube
};

bool Carver::sees_through(const Path& path, const Interval& inside, double mean_chord) {
  if (inside.empty() || inside.leave >= path.length) return false;  // missed, or the line ends in it
  return inside.leave - inside.enter >= least_chord * mean_chord;
}

void Carver::carve_tetrahedron(const Path& path, std::size_t number) const {
  const std::array<Vector3, 4> p = corners_of(*complex_, complex_->free_tetrahedra[number]);
  // Seen from outside counter-clockwise.
  constexpr int sides[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  Interval inside{0, path.length};
  double surface = 0;
  for (const auto& [i, j, k] : sides) {
    const Vector3 normal = (p[j] - p[i]).cross(p[k] - p[i]);
    surface += 0.5 * normal.norm();
    inside.clip(normal.dot(path.from - p[i]), normal.dot(path.direction));
  }
  const double volume = std::abs((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0])) / 6;
  if (!(volume > 0)) return;
  if (sees_through(path, inside, 4 * volume / surface))
    mark(static_cast<Cell>(complex_->blank_nodes + number));
}

void Carver::carve_cell(const Path& path, const VolumeComplex::ConvexCell& cell) const {
  if (cell.cell < 0) return;
  Interval inside{0, path.length};
  double radius = std::numeric_limits<double>::infinity();  // of the ball round the centre
  for (const auto& side : cell.sides) {
    inside.clip(-side.normal.dot(path.from) - side.offset, -side.normal.dot(path.direction));
    radius = std::min(radius, side.normal.dot(cell.centre) + side.offset);
  }
  // The mean chord of a ball is 4/3 of its radius.
  if (sees_through(path, inside, 4 * std::max(radius, 0.0) / 3)) mark(cell.cell);
}

void Carver::walk(const Path& path, Index cube) const {
  const Octree& octree = decomposition_.octree;
  const LatticeBox box = octree.box(cube);
  const Vector3 low = lattice_.position(box.low), high = lattice_.position(box.high);
  const Interval inside = path.through(low, high);
  if (inside.empty()) return;
  if (!octree.is_leaf(cube)) {
    for (Index place = 0; place < 8; ++place) walk(path, octree[cube].children + place);
    return;
  }
  if (decomposition_.volumes[cube].kind == VolumeKind::blank) {
    const double side = high[0] - low[0];
    if (sees_through(path, inside, 2 * side / 3))
      mark(complex_ ? complex_->cube_cells[cube] : static_cast<Cell>(cube));
  } else if (complex_) {
    for (std::size_t t = first_tetrahedron_[cube]; t < first_tetrahedron_[cube + 1]; ++t)
      carve_tetrahedron(path, t);
    for (std::size_t c = first_cell_[cube]; c < first_cell_[cube + 1]; ++c)
      carve_cell(path, complex_->convex_cells[c]);
  }
}

std::vector<char> seen_through(const Lattice& lattice, const Decomposition& decomposition,
                               const VolumeComplex* complex, std::size_t count,
                               const std::vector<LineOfSight>& lines, const Progress& progress) {
  std::vector<std::atomic<char>> seen(count);
  for (auto& mark : seen) mark.store(0, std::memory_order_relaxed);
  const Carver carver(lattice, decomposition, complex, seen);
  for_ranges(lines.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) carver.carve(lines[i]);
  });
  std::vector<char> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = seen[i].load(std::memory_order_relaxed);
  return result;
}

// What became of a line.
enum class Fate : char { whole, cut, from_behind, empty };

Fate cut_line(const TriangleBlocks& blocks, double spacing, LineOfSight& line) {
  const double length = (line.to - line.from).norm();
  if (!(length > spacing) || !std::isfinite(length)) return Fate::empty;
  const std::optional<Hit> hit = first_hit(blocks, line.from, line.to);
  if (hit && hit->from_behind) return Fate::from_behind;
  const double end = (hit ? hit->share : 1.0) * length - spacing;
  if (!(end > 0)) return Fate::empty;
  const bool cut = hit && end < length - 2 * spacing;
  line.to = line.from + (line.to - line.from) * (end / length);
  return cut ? Fate::cut : Fate::whole;
}

}  // namespace

LinesOfSight lines_of_sight(const TriangleBlocks& blocks, const std::vector<VolumeConstraints::View>& views,
                            double spacing, const Progress& progress) {
  LinesOfSight result;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const VolumeConstraints::View& view = views[v];
    std::vector<LineOfSight> lines(view.seen.size());
    std::vector<Fate> fates(view.seen.size());
    for_ranges(lines.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        lines[i].from = view.from;
        lines[i].to = view.seen[i];
        fates[i] = cut_line(blocks, spacing, lines[i]);
      }
    });
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (fates[i] == Fate::whole || fates[i] == Fate::cut) result.lines.push_back(lines[i]);
    const auto note = [&](Fate fate, const char* one, const char* many) {
      const auto count = static_cast<std::size_t>(std::count(fates.begin(), fates.end(), fate));
      const std::string view_number = " of sight of view " + std::to_string(v + 1);
      if (count > 0)
        result.notes.push_back(
            counted_of(count, lines.size(), "line" + view_number, "lines" + view_number, one, many));
    };
    note(Fate::cut, "meets the mesh on the way and was ended there.",
         "meet the mesh on the way and were ended there.");
    note(Fate::from_behind, "meets the mesh from behind and was left out.",
         "meet the mesh from behind and were left out.");
  }
  return result;
}

std::vector<char> leaves_seen_through(const Lattice& lattice, const Decomposition& decomposition,
                                      const std::vector<LineOfSight>& lines, const Progress& progress) {
  return seen_through(lattice, decomposition, nullptr, decomposition.octree.size(), lines, progress);
}

std::vector<char> nodes_seen_through(const Lattice& lattice, const Decomposition& decomposition,
                                     const VolumeComplex& complex, const std::vector<LineOfSight>& lines,
                                     const Progress& progress) {
  return seen_through(lattice, decomposition, &complex, complex.nodes, lines, progress);
}

}  // namespace meshcomplete
