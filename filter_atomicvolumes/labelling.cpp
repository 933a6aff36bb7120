#include "filter_atomicvolumes/labelling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meshcomplete {
namespace {

// Areas are counted in this share of the root's face. All faces together have a few hundred times the area of
// the root's, which stays below what counts as infinite.
constexpr double area_units = static_cast<double>(std::int64_t{1} << 40);

class GraphBuilder {
 public:
  GraphBuilder(const LatticeMesh& mesh, const VolumeComplex& complex, CutWeight weight)
      : complex_(complex),
        by_area_(weight == CutWeight::area),
        scale_(by_area_ ? area_units / (mesh.lattice.side() * mesh.lattice.side()) : 1.0),
        step_(mesh.lattice.step()),
        graph_(complex.nodes, complex.faces.size() + complex.whole_squares.size()) {}

  Labelling cut(const std::vector<NodeTie>& ties);

 private:
  GraphCut::Capacity capacity(double area) const {
    if (!by_area_) return 1;
    return std::max<GraphCut::Capacity>(1, std::llround(area * scale_));
  }
  void add(Cell a, Cell b, double area);
  double area(const VolumeFace& face) const {
    const Vector3& p = complex_.vertices[face.corners[0]].position;
    return 0.5 * (complex_.vertices[face.corners[1]].position - p)
                     .cross(complex_.vertices[face.corners[2]].position - p)
                     .norm();
  }

  const VolumeComplex& complex_;
  const bool by_area_;
  const double scale_, step_;
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
  for (const VolumeFace& face : complex_.faces) add(face.behind, face.before, area(face));
  for (const VolumeSquare& s : complex_.whole_squares) {
    const double length = static_cast<double>(complex_.squares[s.square].length) * step_;
    add(s.behind, s.before, length * length);
  }
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

Labelling cut_complex(const LatticeMesh& mesh, const VolumeComplex& complex, CutWeight weight,
                      const std::vector<NodeTie>& ties, const Progress& progress) {
  progress.check();
  GraphBuilder builder(mesh, complex, weight);
  Labelling labelling = builder.cut(ties);
  progress.update(1);
  return labelling;
}

}  // namespace meshcomplete
