#include "filter_atomicvolumes/volume_complex.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

#include "common/core/threads.h"
#include "filter_atomicvolumes/cell_cubes.h"
#include "filter_atomicvolumes/cell_faces.h"
#include "filter_atomicvolumes/crossed_cube.h"
#include "filter_atomicvolumes/hole_cube.h"

namespace meshcomplete {
namespace {

// Squares and cubes per task: most are done in microseconds. A cube with convex cells is a task of its own.
constexpr std::size_t grain = 32;

class ComplexBuilder {
 public:
  ComplexBuilder(const LatticeMesh& mesh, Decomposition& decomposition)
      : mesh_(mesh),
        decomposition_(decomposition),
        octree_(decomposition.octree),
        cell_cubes_(mesh, decomposition, complex_.squares) {
    complex_.squares = leaf_squares(octree_);
    list_squares();
  }

  /// Absent when hole cubes turned out to be unresolved, and were marked so.
  std::optional<VolumeComplex> build(const Progress& progress);

 private:
  struct SquareData {
    SquareTriangulation triangulation;
    std::vector<Index> vertex;  // number of each point in the complex
    std::vector<std::array<Cell, 2>>
        cells;          // below and above each triangle; of the whole square when not triangulated
    CellSquare convex;  // where convex cells end on it; its triangulation is the one above
  };

  bool is_hole(Index cube) const {
    return cube != Octree::none && (decomposition_.volumes[cube].kind == VolumeKind::vertex ||
                                    decomposition_.volumes[cube].kind == VolumeKind::edge);
  }
  bool has_kind(Index cube, VolumeKind kind) const {
    return cube != Octree::none && decomposition_.volumes[cube].kind == kind;
  }
  bool is_triangulated(Index square) const {
    return is_hole(complex_.squares[square].below) || is_hole(complex_.squares[square].above) ||
           cell_cubes_.touch(square);
  }
  std::vector<Index> squares_of(Index cube) const {
    const auto at = [&](std::size_t i) { return squares_of_.begin() + static_cast<std::ptrdiff_t>(i); };
    return {at(first_square_[cube]), at(first_square_[cube + 1])};
  }
  void fill_with_cells();
  void list_squares();
  void triangulate(const Progress& progress);
  void number_vertices();
  Index number_of(const VolumeVertex& vertex);
  void number_blank_leaves();
  void fill_hole_cubes(const Progress& progress);
  HoleCubeSurface surface_of(Index cube) const;
  void add_tetrahedra(Index cube, const HoleCubeSurface& surface);
  Index apex_of(Index cube, const HoleCubeSurface& surface);
  void label_crossed_cubes(const Progress& progress);
  void label_crossed_cube(Index cube);
  bool is_crossed(Index square) const;
  std::vector<Side> flood_square(const SquareData& data) const;
  void add_square_faces();
  Cell& cell(Index square, Index triangle, Index cube) {
    return data_[square].cells[triangle][complex_.squares[square].above == cube ? 1 : 0];
  }

  const LatticeMesh& mesh_;
  Decomposition& decomposition_;
  const Octree& octree_;
  VolumeComplex complex_;
  std::vector<SquareData> data_;           // per square
  std::vector<std::size_t> first_square_;  // of each cube, in `squares_of_`
  std::vector<Index> squares_of_;
  std::unordered_map<VertexKey, Index, VertexKeyHash> number_;
  CellCubes cell_cubes_;
  bool unresolved_ = false;  // more cubes than there were
};

// The squares of every cube, one after the other.
void ComplexBuilder::list_squares() {
  data_.resize(complex_.squares.size());
  first_square_.assign(octree_.size() + 1, 0);
  for (const LeafSquare& s : complex_.squares)
    for (Index cube : {s.below, s.above})
      if (cube != Octree::none) ++first_square_[cube + 1];
  for (std::size_t i = 1; i < first_square_.size(); ++i) first_square_[i] += first_square_[i - 1];
  squares_of_.resize(first_square_.back());
  std::vector<std::size_t> next(first_square_.begin(), first_square_.end() - 1);
  for (Index square = 0; square < complex_.squares.size(); ++square)
    for (Index cube : {complex_.squares[square].below, complex_.squares[square].above})
      if (cube != Octree::none) squares_of_[next[cube]++] = square;
}

void ComplexBuilder::triangulate(const Progress& progress) {
  std::vector<char> tangled(octree_.size(), 0);
  std::mutex mutex;
  for_each(complex_.squares.size(), grain, progress, [&](std::size_t i) {
    const LeafSquare& s = complex_.squares[i];
    if (!is_triangulated(static_cast<Index>(i))) return;
    // All cubes at a square know the triangles that meet it.
    const Index cube = s.below != Octree::none ? s.below : s.above;
    const std::vector<Index>& candidates = decomposition_.volumes[cube].triangles;
    if (cell_cubes_.touch(static_cast<Index>(i))) {
      data_[i].convex = cell_cubes_.triangulate(static_cast<Index>(i), candidates);
      data_[i].triangulation = std::move(data_[i].convex.triangulation);
      return;
    }
    try {
      data_[i].triangulation = triangulate_square(mesh_, octree_, s, candidates);
    } catch (const TangledCube&) {
      const std::lock_guard<std::mutex> lock(mutex);
      for (Index side : {s.below, s.above})
        if (is_hole(side)) tangled[side] = 1;
    }
  });
  for (Index cube = 0; cube < tangled.size(); ++cube)
    if (tangled[cube]) {
      decomposition_.volumes[cube].kind = VolumeKind::unresolved;
      unresolved_ = true;
    }
}

Index ComplexBuilder::number_of(const VolumeVertex& vertex) {
  const auto [it, fresh] = number_.try_emplace(vertex.key, static_cast<Index>(complex_.vertices.size()));
  if (fresh) complex_.vertices.push_back(vertex);
  return it->second;
}

void ComplexBuilder::number_vertices() {
  for (Index i = 0; i < data_.size(); ++i) {
    SquareData& data = data_[i];
    if (!is_triangulated(i)) data.triangulation = SquareTriangulation();
    for (const VolumeVertex& v : data.triangulation.points) data.vertex.push_back(number_of(v));
    data.cells.assign(std::max<std::size_t>(1, data.triangulation.triangles.size()),
                      {outside_cell, outside_cell});
  }
}

void ComplexBuilder::number_blank_leaves() {
  complex_.cube_cells.assign(octree_.size(), unknown_cell);
  for (Index cube = 0; cube < octree_.size(); ++cube) {
    if (!octree_.is_leaf(cube)) continue;
    if (!has_kind(cube, VolumeKind::blank)) continue;
    complex_.cube_cells[cube] = static_cast<Cell>(complex_.nodes++);
    for (std::size_t i = first_square_[cube]; i < first_square_[cube + 1]; ++i)
      for (Index t = 0; t < data_[squares_of_[i]].cells.size(); ++t)
        cell(squares_of_[i], t, cube) = complex_.cube_cells[cube];
  }
  complex_.blank_nodes = complex_.nodes;
}

HoleCubeSurface ComplexBuilder::surface_of(Index cube) const {
  std::vector<CubeSquare> squares;
  for (std::size_t i = first_square_[cube]; i < first_square_[cube + 1]; ++i) {
    const Index square = squares_of_[i];
    squares.push_back({square, &data_[square].triangulation, &data_[square].vertex,
                       complex_.squares[square].below == cube});
  }
  return hole_cube_surface(squares);
}

Index ComplexBuilder::apex_of(Index cube, const HoleCubeSurface& surface) {
  const Volume& volume = decomposition_.volumes[cube];
  if (volume.kind == VolumeKind::vertex)
    return number_of(
        {VertexKey::vertex(volume.apex), mesh_.mesh.vertices[volume.apex], volume.apex, VolumeVertex::none});
  Vector3 sum = Vector3::Zero();
  for (Index v : surface.rim_ends) sum += complex_.vertices[v].position;
  return number_of({VertexKey::apex(cube), sum / static_cast<double>(surface.rim_ends.size()),
                    VolumeVertex::none, volume.apex});
}

void ComplexBuilder::add_tetrahedra(Index cube, const HoleCubeSurface& surface) {
  const bool resolved =
      !surface.contradicting && (has_kind(cube, VolumeKind::vertex) || surface.rim_ends.size() == 2);
  if (!resolved) {
    decomposition_.volumes[cube].kind = VolumeKind::unresolved;
    unresolved_ = true;
    return;
  }
  const Index apex = apex_of(cube, surface);
  std::vector<Cell> cells;
  for (std::size_t b = 0; b < surface.bases.size(); ++b) {
    const Side side = surface.sides[b];
    Cell known = side == Side::inside ? inside_cell : outside_cell;
    if (side == Side::free) {
      known = static_cast<Cell>(complex_.nodes++);
      complex_.free_tetrahedra.push_back({cube, apex, surface.bases[b].corners});
    }
    cells.push_back(known);
    cell(surface.bases[b].square, surface.bases[b].triangle, cube) = known;
  }
  complex_.tetrahedra += cells.size();
  for (Index h = 0; h < surface.across.size(); ++h) {
    const Index b = h / 3, other = surface.across[h];
    if (surface.walled[h] || other < b || cells[b] == cells[other]) continue;
    const auto& corners = surface.bases[b].corners;
    // Seen from outside, the base is on the left of its side from p to q: the face q, p, apex looks to the
    // right.
    complex_.faces.push_back({{corners[(h % 3 + 1) % 3], corners[h % 3], apex}, cells[b], cells[other]});
  }
}

void ComplexBuilder::fill_hole_cubes(const Progress& progress) {
  std::vector<Index> cubes;
  for (Index cube = 0; cube < octree_.size(); ++cube)
    if (octree_.is_leaf(cube) && is_hole(cube)) cubes.push_back(cube);
  std::vector<HoleCubeSurface> surfaces(cubes.size());
  for_each(cubes.size(), grain, progress, [&](std::size_t i) { surfaces[i] = surface_of(cubes[i]); });
  for (std::size_t i = 0; i < cubes.size(); ++i) add_tetrahedra(cubes[i], surfaces[i]);
}

void ComplexBuilder::fill_with_cells() {
  for (std::size_t i = 0; i < cell_cubes_.cubes().size(); ++i) {
    const Index cube = cell_cubes_.cubes()[i];
    const std::vector<Index> squares = squares_of(cube);
    const auto place = [&](Index square) { return complex_.squares[square].above == cube ? 1 : 0; };
    CellSurface surface;
    for (Index s : squares) {
      const SquareData& data = data_[s];
      for (const auto& [vertex, point] : data.convex.points[place(s)])
        surface.vertices[vertex] = data.vertex[point];
      for (const auto& [edge, points] : data.convex.chains[place(s)]) {
        std::vector<Index>& chain = surface.chains[edge];
        chain.clear();
        for (Index point : points) chain.push_back(data.vertex[point]);
      }
    }
    const std::vector<Cell> volumes = add_cells(
        mesh_, cube, cell_cubes_.cells(i), surface, [&](const VolumeVertex& v) { return number_of(v); },
        complex_);
    for (Index s : squares)
      for (Index t = 0; t < data_[s].cells.size(); ++t)
        cell(s, t, cube) = volumes[data_[s].convex.cells[place(s)][t]];
  }
}

// Whether the mesh crosses a square between two crossed cubes.
bool ComplexBuilder::is_crossed(Index square) const {
  const LeafSquare& s = complex_.squares[square];
  const auto& below = decomposition_.volumes[s.below].triangles;
  const auto& above = decomposition_.volumes[s.above].triangles;
  const LatticeBox box = s.box();
  for (Index t : below.size() < above.size() ? below : above)
    if (meets(mesh_.triangle(t), box)) return true;
  return false;
}

// The sides of all triangles of a square that the mesh crosses: those along a segment have one, and it
// spreads over the sides of triangles where there is no segment.
std::vector<Side> ComplexBuilder::flood_square(const SquareData& data) const {
  const auto& triangles = data.triangulation.triangles;
  using Directed = std::pair<Index, Index>;
  std::vector<Directed> segments;
  for (const SquareTriangulation::Segment& s : data.triangulation.segments)
    segments.emplace_back(s.from, s.to);
  std::sort(segments.begin(), segments.end());
  const auto is_segment = [&](Index from, Index to) {
    return std::binary_search(segments.begin(), segments.end(), Directed(from, to));
  };
  std::vector<std::pair<Directed, std::size_t>> owners;  // the triangle with each side
  std::vector<Side> sides(triangles.size(), Side::free);
  std::vector<std::size_t> reached;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      const bool forth = is_segment(a, b), back = !forth && is_segment(b, a);
      if (!forth && !back) owners.push_back({{a, b}, t});
      if (sides[t] != Side::free || (!forth && !back)) continue;
      sides[t] = forth ? Side::outside : Side::inside;
      reached.push_back(t);
    }
  std::sort(owners.begin(), owners.end());
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const auto& t = triangles[reached[i]];
      const Directed across(t[(k + 1) % 3], t[k]);
      const auto next =
          std::lower_bound(owners.begin(), owners.end(), std::make_pair(across, std::size_t(0)));
      if (next == owners.end() || next->first != across || sides[next->second] != Side::free) continue;
      sides[next->second] = sides[reached[i]];
      reached.push_back(next->second);
    }
  return sides;
}

// Parts of the cube's surface that the mesh does not separate have one side: they hang together by lattice
// points, and where the mesh crosses a square it tells which side they have. Where it does not, a shot into
// the cube tells.
void ComplexBuilder::label_crossed_cube(Index cube) {
  std::vector<std::pair<VertexKey, Side>> known;
  std::vector<Index> uncrossed;
  for (std::size_t i = first_square_[cube]; i < first_square_[cube + 1]; ++i) {
    const Index square = squares_of_[i];
    const LeafSquare& s = complex_.squares[square];
    SquareData& data = data_[square];
    if (data.triangulation.segments.empty()) {
      const bool both = has_kind(s.below, VolumeKind::crossed) && has_kind(s.above, VolumeKind::crossed);
      if (both && is_crossed(square)) {
        cell(square, 0, cube) = unknown_cell;  // the cube beyond sets its own side, perhaps in another thread
      } else {
        uncrossed.push_back(square);
      }
      continue;
    }
    const std::vector<Side> sides = flood_square(data);
    for (Index t = 0; t < sides.size(); ++t) {
      cell(square, t, cube) = sides[t] == Side::inside ? inside_cell : outside_cell;
      for (Index corner : data.triangulation.triangles[t])
        if (data.triangulation.points[corner].key.kind == VertexKey::lattice_point)
          known.emplace_back(data.triangulation.points[corner].key, sides[t]);
    }
  }
  std::unordered_map<VertexKey, Side, VertexKeyHash> side_of(known.begin(), known.end());
  std::unordered_map<VertexKey, std::vector<Index>, VertexKeyHash> at_corner;
  for (Index square : uncrossed)
    for (const LatticePoint& p : complex_.squares[square].corners())
      at_corner[VertexKey::at(p)].push_back(square);
  std::vector<char> done(uncrossed.size(), 0);
  std::unordered_map<Index, std::size_t> position;
  for (std::size_t i = 0; i < uncrossed.size(); ++i) position[uncrossed[i]] = i;
  for (std::size_t start = 0; start < uncrossed.size(); ++start) {
    if (done[start]) continue;
    std::vector<Index> part = {uncrossed[start]};
    done[start] = 1;
    Side side = Side::free;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (const LatticePoint& p : complex_.squares[part[i]].corners()) {
        const VertexKey key = VertexKey::at(p);
        if (const auto at = side_of.find(key); side == Side::free && at != side_of.end()) side = at->second;
        for (Index next : at_corner[key]) {
          char& mark = done[position[next]];
          if (!mark) part.push_back(next);
          mark = 1;
        }
      }
    if (side == Side::free) {
      const Volume& volume = decomposition_.volumes[cube];
      const std::optional<bool> inside =
          is_inside(mesh_, volume.triangles, octree_.box(cube), complex_.squares[part.front()].centre());
      side = inside ? (*inside ? Side::inside : Side::outside) : Side::free;
    }
    const Cell label = side == Side::free ? unknown_cell : side == Side::inside ? inside_cell : outside_cell;
    for (Index square : part)
      for (Index t = 0; t < data_[square].cells.size(); ++t) cell(square, t, cube) = label;
  }
}

void ComplexBuilder::label_crossed_cubes(const Progress& progress) {
  std::vector<Index> cubes;
  for (Index cube = 0; cube < octree_.size(); ++cube)
    if (octree_.is_leaf(cube) && has_kind(cube, VolumeKind::crossed)) cubes.push_back(cube);
  for_each(cubes.size(), grain, progress, [&](std::size_t i) { label_crossed_cube(cubes[i]); });
}

void ComplexBuilder::add_square_faces() {
  for (Index i = 0; i < data_.size(); ++i) {
    const LeafSquare& s = complex_.squares[i];
    const SquareData& data = data_[i];
    const auto& triangles = data.triangulation.triangles;
    if (triangles.empty()) {
      const auto [below, above] = data.cells.front();
      if (below == above) continue;
      complex_.whole_squares.push_back({i, below, above});
      if (has_kind(s.below, VolumeKind::crossed) && has_kind(s.above, VolumeKind::crossed) &&
          below != unknown_cell && above != unknown_cell) {
        complex_.disagreeing.push_back(s.below);
        complex_.disagreeing.push_back(s.above);
      }
      continue;
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (data.cells[t][0] != data.cells[t][1])
        complex_.faces.push_back(
            {{data.vertex[triangles[t][0]], data.vertex[triangles[t][1]], data.vertex[triangles[t][2]]},
             data.cells[t][0],
             data.cells[t][1]});
  }
  auto& list = complex_.disagreeing;
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

std::optional<VolumeComplex> ComplexBuilder::build(const Progress& progress) {
  cell_cubes_.list();
  for_each(cell_cubes_.cubes().size(), 1, progress,
           [&](std::size_t i) { cell_cubes_.cut(i, squares_of(cell_cubes_.cubes()[i])); });
  cell_cubes_.meet();
  triangulate(progress);
  if (unresolved_) return std::nullopt;
  progress.update(0.5);
  number_vertices();
  number_blank_leaves();
  fill_hole_cubes(progress);
  if (unresolved_) return std::nullopt;
  fill_with_cells();
  progress.update(0.7);
  label_crossed_cubes(progress);
  progress.update(0.9);
  add_square_faces();
  progress.update(1);
  return std::move(complex_);
}

}  // namespace

VolumeComplex build_complex(const LatticeMesh& mesh, Decomposition& decomposition, const Progress& progress) {
  for (;;)
    if (auto complex = ComplexBuilder(mesh, decomposition).build(progress)) return std::move(*complex);
}

}  // namespace meshcomplete
