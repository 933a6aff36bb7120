// Layers of MeshLab made in code, and their complete state as bytes.
#pragma once

#include <string>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace test {

/// Adds a layer with these vertices and triangles, normals and bounding box computed.
MeshModel& layer_from(MeshDocument& document, const TriangleMesh& mesh, const char* name = "mesh.ply");

/// Switches every attribute on that MeshLab has, and gives each a different value at each vertex, face and
/// corner; adds custom attributes, adjacency, a selection, faux edges, two textures and a transformation.
void give_all_attributes(MeshModel& model);

/// A fan around the mean of each boundary loop.
Patch fans(const TriangleMesh& mesh);

/// Everything that a vertex or face of the layer holds, but its adjacency, as bytes; corners as vertex
/// numbers.
std::vector<std::string> vertex_states(const MeshModel& model);
std::vector<std::string> face_states(const MeshModel& model);

/// The whole layer: all vertices and faces, counts, selection counts, textures, transformation, name, box.
std::string layer_state(const MeshModel& model);

/// All layers in order, and which one is current.
std::string document_state(const MeshDocument& document);

}  // namespace test
}  // namespace meshcomplete
