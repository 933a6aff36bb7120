#include "common/core/patch.h"

#include <algorithm>
#include <limits>

namespace meshcomplete {

Vector3 as_stored(const Vector3& position) { return position.cast<float>().cast<double>(); }

double stored_resolution(const Vector3& position) {
  return position.cwiseAbs().maxCoeff() * std::numeric_limits<float>::epsilon();
}

const Vector3& position(const TriangleMesh& mesh, const Patch& patch, Index vertex) {
  return vertex < patch.input_vertices ? mesh.vertices[vertex]
                                       : patch.vertices[vertex - patch.input_vertices];
}

std::array<Vector3, 3> corners(const TriangleMesh& mesh, const Patch& patch, const Triangle& triangle) {
  return {position(mesh, patch, triangle[0]), position(mesh, patch, triangle[1]),
          position(mesh, patch, triangle[2])};
}

void append(Patch& patch, const Patch& other) {
  const Index offset = static_cast<Index>(patch.vertices.size());
  patch.input_vertices = other.input_vertices;
  patch.vertices.insert(patch.vertices.end(), other.vertices.begin(), other.vertices.end());
  patch.triangles.reserve(patch.triangles.size() + other.triangles.size());
  for (Triangle triangle : other.triangles) {
    for (Index& corner : triangle)
      if (corner >= other.input_vertices) corner += offset;
    patch.triangles.push_back(triangle);
  }
}

const char* name(HoleOutcome outcome) {
  switch (outcome) {
    case HoleOutcome::closed:
      return "closed";
    case HoleOutcome::partial:
      return "partial";
    case HoleOutcome::skipped:
      return "skipped";
    case HoleOutcome::failed:
      return "failed";
  }
  return "";
}

std::size_t CompletionReport::count(HoleOutcome outcome) const {
  return static_cast<std::size_t>(std::count_if(
      holes.begin(), holes.end(), [outcome](const HoleReport& hole) { return hole.outcome == outcome; }));
}

}  // namespace meshcomplete
