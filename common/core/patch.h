// What every algorithm returns: a patch, and what became of each hole.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"

namespace meshcomplete {

/// New vertices and triangles that are added to a mesh of `input_vertices` vertices. A corner below
/// `input_vertices` is a vertex of the input, any other is `vertices[corner - input_vertices]`. Positions are
/// exactly representable as floats, because that is how they will be stored.
struct Patch {
  Index input_vertices = 0;
  std::vector<Vector3> vertices;
  std::vector<Triangle> triangles;

  bool empty() const { return triangles.empty(); }
};

/// Rounds to the nearest float, coordinate by coordinate: the value that MeshLab will store.
Vector3 as_stored(const Vector3& position);

/// The step between the numbers that MeshLab can store at the greatest coordinate of a position, or somewhat
/// more.
double stored_resolution(const Vector3& position);

/// Where a vertex of `patch`, which belongs to `mesh`, is: a corner's number as its triangles have it.
const Vector3& position(const TriangleMesh& mesh, const Patch& patch, Index vertex);

/// Positions of the corners of a triangle of `patch`, which belongs to `mesh`.
std::array<Vector3, 3> corners(const TriangleMesh& mesh, const Patch& patch, const Triangle& triangle);

/// Appends `other` (over the same input mesh) to `patch`, renumbering its new vertices.
void append(Patch& patch, const Patch& other);

enum class HoleOutcome {
  closed,   ///< a patch was added
  partial,  ///< part of the boundary was closed, as asked
  skipped,  ///< not asked for, or nothing that a patch could close
  failed,   ///< asked for, tried, left open
};

/// "closed", "partial", "skipped", "failed".
const char* name(HoleOutcome outcome);

/// What became of one hole, in the order of the boundary loops.
struct HoleReport {
  std::vector<std::size_t> loops;  ///< the boundary loops of this hole, by their position in the traced list
  std::size_t edges = 0;
  double perimeter = 0;              ///< mesh units
  Vector3 centre = Vector3::Zero();  ///< mean of the loop's vertices
  HoleOutcome outcome = HoleOutcome::skipped;
  std::string route;   ///< which way led to the patch, e.g. "projected, thin plate"
  std::string reason;  ///< why it was skipped or failed, or which part was closed; empty when closed
  std::size_t vertices_added = 0;
  std::size_t faces_added = 0;
};

/// What a whole run did.
struct CompletionReport {
  std::vector<HoleReport> holes;
  std::vector<std::pair<std::string, double>>
      stage_seconds;                                    ///< wall seconds per stage, in the order they ran
  std::vector<std::string> notes;                       ///< anything else the user should know
  std::vector<std::pair<std::string, double>> figures;  ///< what the run came to in numbers, by name
  /// Faces of the input, by the caller's numbers, ascending, that the new layer lacks; only in modes that say
  /// so. The input itself has them still.
  std::vector<Index> removed_faces;
  /// Vertices of the input, by the caller's numbers, ascending, that the new layer has copies of, so that
  /// each fan of faces there has a vertex of its own; one entry for each copy. Only in modes that say so.
  std::vector<Index> split_vertices;

  std::size_t count(HoleOutcome outcome) const;
};

/// The result of an algorithm: nothing of the input mesh is in it.
struct Completion {
  Patch patch;
  CompletionReport report;
};

}  // namespace meshcomplete
