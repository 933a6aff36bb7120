#include "filter_atomicvolumes/offending_faces.h"

#include <algorithm>

namespace meshcomplete {

std::vector<Index> offending_faces(const LatticeMesh& mesh, const Decomposition& decomposition,
                                   const std::vector<char>& rims) {
  std::vector<Index> faces;
  for (Index cube = 0; cube < decomposition.octree.size(); ++cube) {
    const Volume& volume = decomposition.volumes[cube];
    if (!decomposition.octree.is_leaf(cube) || volume.kind != VolumeKind::unresolved) continue;
    const LatticeBox box = decomposition.octree.box(cube);
    std::vector<Index> boundary;  // vertices in the cube
    const std::size_t before = faces.size();
    bool counts = rims.empty();
    for (Index t : volume.triangles)
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        if (mesh.topology.opposite[h] != MeshTopology::boundary) continue;
        const Index a = mesh.origin(h), b = mesh.target(h);
        if (!meets(mesh.vertex(a), mesh.vertex(b), box)) continue;
        counts = counts || rims[h];
        faces.push_back(t);
        for (Index v : {a, b})
          if (box.contains(mesh.vertex(v))) boundary.push_back(v);
      }
    if (!counts) {
      faces.resize(before);
      continue;
    }
    std::sort(boundary.begin(), boundary.end());
    for (Index t : volume.triangles)
      for (Index v : mesh.mesh.triangles[t])
        if (std::binary_search(boundary.begin(), boundary.end(), v)) faces.push_back(t);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

}  // namespace meshcomplete
