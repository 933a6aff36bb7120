#include "filter_atomicvolumes/extraction.h"

#include <unordered_map>
#include <utility>

namespace meshcomplete {
namespace {

class Extractor {
 public:
  Extractor(const LatticeMesh& mesh, const Octree& octree, const VolumeComplex& complex,
            const Labelling& labelling)
      : mesh_(mesh), octree_(octree), complex_(complex), labelling_(labelling) {}

  LabelledSurface run() {
    for (const VolumeFace& face : complex_.faces)
      if (separates(face.behind, face.before)) {
        const auto vertex = [&](Index v) { return number_of(complex_.vertices[v]); };
        add({vertex(face.corners[0]), vertex(face.corners[1]), vertex(face.corners[2])}, face.behind,
            face.before);
      }
    for (const VolumeSquare& s : complex_.whole_squares)
      if (separates(s.behind, s.before)) add_square(s);
    return std::move(surface_);
  }

 private:
  bool separates(Cell behind, Cell before) const {
    return behind != unknown_cell && before != unknown_cell &&
           labelling_.is_inside(behind) != labelling_.is_inside(before);
  }
  Index number_of(const VolumeVertex& vertex) {
    const auto [it, fresh] = number_.try_emplace(vertex.key, static_cast<Index>(surface_.vertices.size()));
    if (fresh) surface_.vertices.push_back(vertex);
    return it->second;
  }
  void add(Triangle t, Cell behind, Cell before) {
    if (!labelling_.is_inside(behind)) {
      std::swap(t[1], t[2]);
      std::swap(behind, before);
    }
    surface_.triangles.push_back(t);
    surface_.volumes.push_back({behind, before});
  }
  void add_square(const VolumeSquare& s) {
    const SquareTriangulation square = triangulate_square(mesh_, octree_, complex_.squares[s.square], {});
    std::vector<Index> vertex;
    for (const VolumeVertex& v : square.points) vertex.push_back(number_of(v));
    for (const auto& [a, b, c] : square.triangles) add({vertex[a], vertex[b], vertex[c]}, s.behind, s.before);
  }

  const LatticeMesh& mesh_;
  const Octree& octree_;
  const VolumeComplex& complex_;
  const Labelling& labelling_;
  LabelledSurface surface_;
  std::unordered_map<VertexKey, Index, VertexKeyHash> number_;
};

}  // namespace

LabelledSurface extract(const LatticeMesh& mesh, const Octree& octree, const VolumeComplex& complex,
                        const Labelling& labelling) {
  return Extractor(mesh, octree, complex, labelling).run();
}

SeparatingSurface separating(const LabelledSurface& surface) {
  SeparatingSurface result;
  result.triangles = surface.triangles;
  for (const VolumeVertex& v : surface.vertices)
    result.vertices.push_back({v.position, v.input, v.rim_edge, v.key.is_cut()});
  return result;
}

}  // namespace meshcomplete
