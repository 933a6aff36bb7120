#include "filter_atomicvolumes/labelling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/core/threads.h"

namespace meshcomplete {
namespace {

// What faces cost is counted in this share of what the root's face would. All faces together have a few
// hundred times the area of the root's, and as many times its cost as there are faces at most, which stays
// below what counts as infinite.
double units(CutWeight weight) {
  switch (weight) {
    case CutWeight::area:
    case CutWeight::poisson:
      return static_cast<double>(std::int64_t{1} << 40);
    case CutWeight::balanced:
      return static_cast<double>(std::int64_t{1} << 28);
    case CutWeight::unit:
      break;
  }
  return 1024;  // prices need not be whole
}

// What of a face its cost depends on.
struct FaceShape {
  double area, size;  // its longest side
  Vector3 middle;
};

FaceShape shape_of(const VolumeComplex& complex, const VolumeFace& face) {
  const Vector3 &a = complex.vertices[face.corners[0]].position,
                &b = complex.vertices[face.corners[1]].position,
                &c = complex.vertices[face.corners[2]].position;
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return {0.5 * (b - a).cross(c - a).norm(), std::sqrt(longest), (a + b + c) / 3};
}

FaceShape shape_of(const LatticeMesh& mesh, const VolumeComplex& complex, const VolumeSquare& s) {
  const LeafSquare& square = complex.squares[s.square];
  const double length = static_cast<double>(square.length) * mesh.lattice.step();
  return {length * length, length, mesh.lattice.position(square.centre())};
}

// A face between volumes, whatever its form.
struct PricedFace {
  Cell behind, before;
  double area, cost;
};

constexpr std::size_t grain = 4096;

// Triangles first, then whole squares. The oracle is asked in threads, and only about faces that the cut can
// do something about.
std::vector<PricedFace> priced_faces(const LatticeMesh& mesh, const VolumeComplex& complex,
                                     const FaceCost& cost, const Progress& progress) {
  const std::size_t triangles = complex.faces.size();
  std::vector<PricedFace> faces(triangles + complex.whole_squares.size());
  for_ranges(faces.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const bool whole = i >= triangles;
      const Cell behind = whole ? complex.whole_squares[i - triangles].behind : complex.faces[i].behind;
      const Cell before = whole ? complex.whole_squares[i - triangles].before : complex.faces[i].before;
      const FaceShape shape = whole ? shape_of(mesh, complex, complex.whole_squares[i - triangles])
                                    : shape_of(complex, complex.faces[i]);
      const bool known = behind < 0 && before < 0;
      const double share = known || !(shape.size > 0) ? 1 : cost.closeness(shape.middle, shape.size);
      faces[i] = {behind, before, shape.area, share * cost.most(shape.area)};
    }
  });
  return faces;
}

}  // namespace

FaceMeasure measure_faces(const LatticeMesh& mesh, const VolumeComplex& complex, const FaceCost& cost,
                          const Progress& progress) {
  FaceMeasure measure;
  measure.of_node.assign(complex.nodes, 0);
  double area_in_all = 0, cost_in_all = 0;
  const std::vector<PricedFace> faces = priced_faces(mesh, complex, cost, progress);
  for (const PricedFace& face : faces) {
    area_in_all += face.area;
    cost_in_all += face.cost;
    for (Cell cell : {face.behind, face.before})
      if (cell >= 0) measure.of_node[static_cast<std::size_t>(cell)] += face.cost;
  }
  if (!faces.empty()) {
    measure.mean_area = area_in_all / static_cast<double>(faces.size());
    measure.mean_cost = cost_in_all / static_cast<double>(faces.size());
  }
  return measure;
}

Labelling cut_complex(const LatticeMesh& mesh, const VolumeComplex& complex, const FaceCost& cost,
                      const std::vector<NodeTie>& ties, const Progress& progress) {
  progress.check();
  const double scale = units(cost.weight()) / cost.most(mesh.lattice.side() * mesh.lattice.side());
  const auto capacity = [scale](double price) {
    return std::max<GraphCut::Capacity>(1, std::llround(price * scale));
  };
  GraphCut graph(complex.nodes, complex.faces.size() + complex.whole_squares.size());
  for (const PricedFace& face : priced_faces(mesh, complex, cost, progress.part(0, 0.3, ""))) {
    Cell a = face.behind, b = face.before;
    if (a == unknown_cell || b == unknown_cell || (a < 0 && b < 0)) continue;
    if (a < 0) std::swap(a, b);
    const std::size_t node = static_cast<std::size_t>(a);
    const GraphCut::Capacity price = capacity(face.cost);
    if (b >= 0)
      graph.join(node, static_cast<std::size_t>(b), price);
    else
      graph.tie(node, b == inside_cell ? price : 0, b == outside_cell ? price : 0);
  }
  for (const NodeTie& tie : ties) {
    const GraphCut::Capacity price = std::isinf(tie.price) ? GraphCut::infinite : capacity(tie.price);
    graph.tie(static_cast<std::size_t>(tie.node), tie.inside ? price : 0, tie.inside ? 0 : price);
  }
  Labelling labelling;
  labelling.weight = static_cast<double>(graph.cut()) / scale;
  labelling.inside.resize(complex.nodes);
  for (std::size_t node = 0; node < complex.nodes; ++node) labelling.inside[node] = graph.with_source(node);
  progress.update(1);
  return labelling;
}

}  // namespace meshcomplete
