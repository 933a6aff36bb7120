#include "filter_atomicvolumes/labelling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meshcomplete {
namespace {

// Areas are counted in this share of the root's face. All faces together have a few hundred times the area of
// the root's, which stays below what counts as infinite.
constexpr double area_units = static_cast<double>(std::int64_t{1} << 40);

// Numbers of faces in this share of a face: prices need not be whole.
constexpr double face_units = 1024;

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
        by_area_(weight == CutWeight::area),
        scale_(by_area_ ? area_units / (mesh.lattice.side() * mesh.lattice.side()) : face_units),
        graph_(complex.nodes, complex.faces.size() + complex.whole_squares.size()) {}

  Labelling cut(const std::vector<NodeTie>& ties);

 private:
  GraphCut::Capacity capacity(double area) const {
    if (!by_area_) return static_cast<GraphCut::Capacity>(face_units);
    return std::max<GraphCut::Capacity>(1, std::llround(area * scale_));
  }
  void add(Cell a, Cell b, double area);

  const LatticeMesh& mesh_;
  const VolumeComplex& complex_;
  const bool by_area_;
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

FaceMeasure measure_faces(const LatticeMesh& mesh, const VolumeComplex& complex, CutWeight weight) {
  FaceMeasure measure;
  measure.of_node.assign(complex.nodes, 0);
  double total = 0;
  const auto add = [&](Cell behind, Cell before, double area) {
    total += area;
    for (Cell cell : {behind, before})
      if (cell >= 0) measure.of_node[static_cast<std::size_t>(cell)] += weight == CutWeight::area ? area : 1;
  };
  for (const VolumeFace& face : complex.faces) add(face.behind, face.before, area_of(complex, face));
  for (const VolumeSquare& s : complex.whole_squares) add(s.behind, s.before, area_of(mesh, complex, s));
  const std::size_t count = complex.faces.size() + complex.whole_squares.size();
  if (count > 0) measure.mean_area = total / static_cast<double>(count);
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
