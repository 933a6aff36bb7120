#include "filter_atomicvolumes/cell_faces.h"

#include <algorithm>
#include <utility>

namespace meshcomplete {
namespace {

class CellAdder {
 public:
  CellAdder(const LatticeMesh& mesh, Index cube, const ConvexCells& cells, const CellSurface& surface,
            const std::function<Index(const VolumeVertex&)>& number_of, VolumeComplex& complex)
      : mesh_(mesh),
        cube_(cube),
        cells_(cells),
        surface_(surface),
        number_of_(number_of),
        complex_(complex),
        input_(cells.complex.points().size(), VolumeVertex::none) {
    for (const auto& [v, boundary_vertex] : cells.rim_vertices) input_[v] = boundary_vertex;
  }

  std::vector<Cell> run();

 private:
  struct LoopPoint {
    Index vertex;  // of the complex
    bool corner;   // not in the middle of a straight side
  };

  Vector3 position(const Vector3& relative) const {
    return mesh_.lattice.position(cells_.centre) + mesh_.lattice.step() * relative;
  }
  Index vertex(Index v) const;
  bool turns(Index facet, std::size_t place) const;
  std::vector<LoopPoint> loop(Index facet) const;
  void add_facet(Index facet);
  VolumeComplex::ConvexCell describe(Index cell) const;

  const LatticeMesh& mesh_;
  const Index cube_;
  const ConvexCells& cells_;
  const CellSurface& surface_;
  const std::function<Index(const VolumeVertex&)>& number_of_;
  VolumeComplex& complex_;
  std::vector<Index> input_;
  std::vector<Cell> volume_;  // of each cell
};

Index CellAdder::vertex(Index v) const {
  if (const auto found = surface_.vertices.find(v); found != surface_.vertices.end()) return found->second;
  if (input_[v] != VolumeVertex::none)
    return number_of_(
        {VertexKey::vertex(input_[v]), mesh_.mesh.vertices[input_[v]], input_[v], VolumeVertex::none});
  return number_of_({{VertexKey::cut_in_cube, cube_, v, 0},
                     position(cells_.complex.points()[v].rounded),
                     VolumeVertex::none,
                     cells_.rims[v].empty() ? VolumeVertex::none : cells_.rims[v].front()});
}

// Whether the facet's boundary turns at a corner.
bool CellAdder::turns(Index facet, std::size_t place) const {
  const CellComplex& complex = cells_.complex;
  const auto& corners = complex.facets()[facet].corners;
  const std::size_t n = corners.size();
  const Index before = complex.plane_through_side(facet, (place + n - 1) % n);
  return side_of(complex.planes()[before], complex.points()[corners[(place + 1) % n]]) != 0;
}

std::vector<CellAdder::LoopPoint> CellAdder::loop(Index facet) const {
  const CellComplex::Facet& f = cells_.complex.facets()[facet];
  std::vector<LoopPoint> points;
  for (std::size_t place = 0; place < f.corners.size(); ++place) {
    points.push_back({vertex(f.corners[place]), turns(facet, place)});
    const auto found = surface_.chains.find(f.sides[place]);
    if (found == surface_.chains.end()) continue;
    std::vector<Index> chain = found->second;
    if (chain.front() != points.back().vertex) std::reverse(chain.begin(), chain.end());
    for (std::size_t i = 1; i + 1 < chain.size(); ++i) points.push_back({chain[i], false});
  }
  return points;
}

// A fan from a corner whose sides have no points in the middle, else from a point inside.
void CellAdder::add_facet(Index facet) {
  const CellComplex::Facet& f = cells_.complex.facets()[facet];
  const Cell before = volume_[f.cells[0]], behind = volume_[f.cells[1]];
  if (before == behind) return;
  const std::vector<LoopPoint> points = loop(facet);
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!points[i].corner || (n > 3 && (!points[(i + 1) % n].corner || !points[(i + n - 1) % n].corner)))
      continue;
    for (std::size_t k = 1; k + 1 < n; ++k)
      complex_.faces.push_back(
          {{points[i].vertex, points[(i + k) % n].vertex, points[(i + k + 1) % n].vertex}, behind, before});
    return;
  }
  Vector3 sum = Vector3::Zero();
  for (const LoopPoint& p : points) sum += complex_.vertices[p.vertex].position;
  const Index middle = number_of_({{VertexKey::middle_of_cut, cube_, facet, 0},
                                   sum / static_cast<double>(n),
                                   VolumeVertex::none,
                                   VolumeVertex::none});
  for (std::size_t i = 0; i < n; ++i)
    complex_.faces.push_back({{points[i].vertex, points[(i + 1) % n].vertex, middle}, behind, before});
}

VolumeComplex::ConvexCell CellAdder::describe(Index cell) const {
  const CellComplex& complex = cells_.complex;
  VolumeComplex::ConvexCell result{cube_, volume_[cell], Vector3::Zero(), {}};
  std::vector<Index> corners;
  std::vector<std::pair<Index, bool>> planes;  // with the cell on the positive side
  for (Index f : complex.cells()[cell].facets) {
    const CellComplex::Facet& facet = complex.facets()[f];
    corners.insert(corners.end(), facet.corners.begin(), facet.corners.end());
    planes.emplace_back(facet.plane, facet.cells[0] == cell);
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  for (Index v : corners) result.centre += complex.points()[v].rounded / static_cast<double>(corners.size());
  result.centre = position(result.centre);
  std::sort(planes.begin(), planes.end());
  planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  const double step = mesh_.lattice.step();
  for (const auto& [plane, positive] : planes) {
    const std::array<double, 4>& p = complex.planes()[plane].rounded;
    const Vector3 normal(p[0], p[1], p[2]);
    const double scale = (positive ? 1 : -1) / normal.norm();
    const Vector3 unit = scale * normal;
    result.sides.push_back({unit, scale * p[3] * step - unit.dot(mesh_.lattice.position(cells_.centre))});
  }
  return result;
}

std::vector<Cell> CellAdder::run() {
  const CellComplex& complex = cells_.complex;
  for (Index c = 0; c < complex.cells().size(); ++c) {
    const Side side = cells_.sides[c];
    volume_.push_back(side == Side::free     ? static_cast<Cell>(complex_.nodes++)
                      : side == Side::inside ? inside_cell
                                             : outside_cell);
    complex_.convex_cells.push_back(describe(c));
  }
  for (Index f = 0; f < complex.facets().size(); ++f)
    if (!CellComplex::on_surface(complex.facets()[f]) && complex.facets()[f].wall == no_wall) add_facet(f);
  return std::move(volume_);
}

}  // namespace

bool VolumeComplex::ConvexCell::holds(const Vector3& point) const {
  return std::all_of(sides.begin(), sides.end(),
                     [&](const Plane& side) { return side.normal.dot(point) + side.offset >= 0; });
}

std::vector<Cell> add_cells(const LatticeMesh& mesh, Index cube, const ConvexCells& cells,
                            const CellSurface& surface,
                            const std::function<Index(const VolumeVertex&)>& number_of,
                            VolumeComplex& complex) {
  return CellAdder(mesh, cube, cells, surface, number_of, complex).run();
}

}  // namespace meshcomplete
