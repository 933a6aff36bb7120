#include "filter_atomicvolumes/labelling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meshcomplete {
namespace {

// What faces cost is counted in this share of what the root's face would. All faces together have a few
// hundred times the area of the root's, and as many times its cost as there are faces at most, which stays
// below what counts as infinite.
double units(CutWeight weight) {
  switch (weight) {
    case CutWeight::area:
      return static_cast<double>(std::int64_t{1} << 40);
    case CutWeight::balanced:
      return static_cast<double>(std::int64_t{1} << 28);
    case CutWeight::unit:
      break;
  }
  return 1024;  // prices need not be whole
}

double area_of(const VolumeComplex& complex, const VolumeFace& face) {
  const Vector3& p = complex.vertices[face.corners[0]].position;
  return 0.5 * (complex.vertices[face.corners[1]].position - p)
                   .cross(complex.vertices[face.corners[2]].position - p)
                   .norm();
}

double area_of(const LatticeMesh& mesh, const VolumeComplex& complex, const VolumeSquare& s) {
  const double length = static_cast<double>(complex.squares[s.square].length) * mesh.lattice.step();
  return length * length;
}

class GraphBuilder {
 public:
  GraphBuilder(const LatticeMesh& mesh, const VolumeComplex& complex, CutWeight weight)
      : mesh_(mesh),
        complex_(complex),
        weight_(weight),
        scale_(units(weight) / cost_of_face(weight, mesh.lattice.side() * mesh.lattice.side())),
        graph_(complex.nodes, complex.faces.size() + complex.whole_squares.size()) {}

  Labelling cut(const std::vector<NodeTie>& ties);

 private:
  GraphCut::Capacity capacity(double area) const {
    return std::max<GraphCut::Capacity>(1, std::llround(cost_of_face(weight_, area) * scale_));
  }
  void add(Cell a, Cell b, double area);

  const LatticeMesh& mesh_;
  const VolumeComplex& complex_;
  const CutWeight weight_;
  const double scale_;
  GraphCut graph_;
};

void GraphBuilder::add(Cell a, Cell b, double area) {
  if (a == unknown_cell || b == unknown_cell || (a < 0 && b < 0)) return;
  if (a < 0) std::swap(a, b);
  const std::size_t node = static_cast<std::size_t>(a);
  if (b >= 0)
    graph_.join(node, static_cast<std::size_t>(b), capacity(area));
  else
    graph_.tie(node, b == inside_cell ? capacity(area) : 0, b == outside_cell ? capacity(area) : 0);
}

Labelling GraphBuilder::cut(const std::vector<NodeTie>& ties) {
  for (const VolumeFace& face : complex_.faces) add(face.behind, face.before, area_of(complex_, face));
  for (const VolumeSquare& s : complex_.whole_squares) add(s.behind, s.before, area_of(mesh_, complex_, s));
  for (const NodeTie& tie : ties) {
    const GraphCut::Capacity price = std::isinf(tie.price)
                                         ? GraphCut::infinite
                                         : std::max<GraphCut::Capacity>(1, std::llround(tie.price * scale_));
    graph_.tie(static_cast<std::size_t>(tie.node), tie.inside ? price : 0, tie.inside ? 0 : price);
  }
  Labelling labelling;
  labelling.weight = static_cast<double>(graph_.cut()) / scale_;
  labelling.inside.resize(complex_.nodes);
  for (std::size_t node = 0; node < complex_.nodes; ++node) labelling.inside[node] = graph_.with_source(node);
  return labelling;
}

}  // namespace

double cost_of_face(CutWeight weight, double area) {
  switch (weight) {
    case CutWeight::area:
      return area;
    case CutWeight::balanced:
      return std::sqrt(std::sqrt(area));
    case CutWeight::unit:
      break;
  }
  return 1;
}

FaceMeasure measure_faces(const LatticeMesh& mesh, const VolumeComplex& complex, CutWeight weight) {
  FaceMeasure measure;
  measure.of_node.assign(complex.nodes, 0);
  double area_in_all = 0, cost_in_all = 0;
  const auto add = [&](Cell behind, Cell before, double area) {
    const double cost = cost_of_face(weight, area);
    area_in_all += area;
    cost_in_all += cost;
    for (Cell cell : {behind, before})
      if (cell >= 0) measure.of_node[static_cast<std::size_t>(cell)] += cost;
  };
  for (const VolumeFace& face : complex.faces) add(face.behind, face.before, area_of(complex, face));
  for (const VolumeSquare& s : complex.whole_squares) add(s.behind, s.before, area_of(mesh, complex, s));
  if (const std::size_t count = complex.faces.size() + complex.whole_squares.size(); count > 0) {
    measure.mean_area = area_in_all / static_cast<double>(count);
    measure.mean_cost = cost_in_all / static_cast<double>(count);
  }
  return measure;
}

Labelling cut_complex(const LatticeMesh& mesh, const VolumeComplex& complex, CutWeight weight,
                      const std::vector<NodeTie>& ties, const Progress& progress) {
  progress.check();
  GraphBuilder builder(mesh, complex, weight);
  Labelling labelling = builder.cut(ties);
  progress.update(1);
  return labelling;
}

}  // namespace meshcomplete
