// What is right and wrong with a mesh, counted.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

struct MeshStatistics {
  std::size_t vertices = 0;  ///< all, used or not
  std::size_t faces = 0;
  std::size_t unreferenced_vertices = 0;
  std::size_t duplicated_vertices = 0;  ///< used vertices beyond the first at each position
  std::size_t components = 0;           ///< connected over edges
  std::size_t boundary_edges = 0;
  std::vector<std::size_t> boundary_loops;  ///< edges per loop, descending; loops follow the fans of faces,
                                            ///< so one that touches itself at a vertex is one loop
  std::size_t non_manifold_edges = 0;       ///< with three or more faces
  std::size_t non_manifold_vertices =
      0;                               ///< with more than one fan of faces (faces at one edge are in one fan)
  std::size_t inconsistent_edges = 0;  ///< two faces that walk the edge the same way
  bool orientable = true;
  std::optional<long long> genus;  ///< sum over components, boundary loops capped; absent when an edge is not
                                   ///< manifold or the mesh is not orientable
  std::size_t degenerate_faces = 0;                    ///< repeated, collinear or infinite corners
  std::size_t duplicate_faces = 0;                     ///< faces beyond the first with the same three corners
  std::optional<std::size_t> self_intersecting_pairs;  ///< absent when not asked for
  double volume = 0;  ///< signed, mesh units cubed, about the mean vertex; means something when watertight

  bool watertight() const;  ///< some faces, no boundary, no non-manifold or inconsistent edge
  bool manifold() const;    ///< no non-manifold edge or vertex
  /// Watertight, manifold, nothing degenerate, duplicated or intersecting, volume positive.
  /// False when intersections were not counted.
  bool solid() const;
};

/// Cost: O(faces), and O(faces log faces) with intersections.
MeshStatistics measure(const TriangleMesh& mesh, bool count_intersections,
                       const Progress& progress = Progress());

/// The statistics as lines of text for a log, one fact a line.
std::vector<std::string> describe(const MeshStatistics& statistics);

}  // namespace meshcomplete
