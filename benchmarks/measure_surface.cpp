// What a surface is like as a whole and in its largest component, and how far another one is from it.
//
//   measure_surface topology MESH             faces, components and genus
//   measure_surface distance FROM TO [LIMIT]  quantiles of the distances of FROM's vertices from the surface
//                                             TO; with LIMIT also how many lie within it
//
// Everything is printed as one JSON object.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/mesh_file.h"
#include "benchmarks/surface_distance.h"
#include "common/core/disjoint_sets.h"
#include "common/core/mesh_statistics.h"

namespace {

using namespace meshcomplete;

std::string text_of(const std::optional<long long>& genus) { return genus ? std::to_string(*genus) : "null"; }

/// The face that stands for each face's component, connected over edges.
std::vector<Index> components_of(const TriangleMesh& mesh) {
  std::vector<std::pair<std::pair<Index, Index>, Index>> edges;
  for (Index f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k)
      edges.push_back({std::minmax(mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3]), f});
  std::sort(edges.begin(), edges.end());
  DisjointSets sets(mesh.triangles.size());
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].first == edges[i - 1].first) sets.unite(edges[i].second, edges[i - 1].second);
  std::vector<Index> component;
  for (Index f = 0; f < mesh.triangles.size(); ++f) component.push_back(sets.root(f));
  return component;
}

TriangleMesh largest_component(const TriangleMesh& mesh) {
  const std::vector<Index> component = components_of(mesh);
  std::vector<std::size_t> faces(mesh.triangles.size());
  for (const Index c : component) ++faces[c];
  const auto largest = static_cast<std::size_t>(std::max_element(faces.begin(), faces.end()) - faces.begin());
  constexpr Index none = -1;
  std::vector<Index> number(mesh.vertices.size(), none);
  TriangleMesh result;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (component[f] != largest) continue;
    Triangle triangle = mesh.triangles[f];
    for (Index& v : triangle) {
      if (number[v] == none) {
        number[v] = static_cast<Index>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

void print_topology(const TriangleMesh& mesh) {
  const MeshStatistics all = measure(mesh, false);
  const MeshStatistics largest = measure(largest_component(mesh), false);
  std::printf(
      "{\"vertices\": %zu, \"faces\": %zu, \"components\": %zu, \"genus\": %s, \"boundary_loops\": %zu, "
      "\"manifold\": %s, \"largest_faces\": %zu, \"largest_genus\": %s, \"volume\": %.9g}\n",
      all.vertices, all.faces, all.components, text_of(all.genus).c_str(), all.boundary_loops.size(),
      all.manifold() ? "true" : "false", largest.faces, text_of(largest.genus).c_str(), all.volume);
}

void print_distance(const TriangleMesh& from, const TriangleMesh& to, double limit) {
  const auto distance = benchmarks::distance_function(to);
  std::vector<double> found;
  for (const Vector3& vertex : from.vertices) found.push_back(distance(vertex));
  if (found.empty()) throw std::runtime_error("the first mesh has no vertices");
  std::sort(found.begin(), found.end());
  const auto quantile = [&](double share) {
    return found[static_cast<std::size_t>(share * double(found.size() - 1))];
  };
  const auto within = std::upper_bound(found.begin(), found.end(), limit) - found.begin();
  std::printf(
      "{\"vertices\": %zu, \"median\": %.9g, \"quantile_90\": %.9g, \"quantile_99\": %.9g, "
      "\"greatest\": %.9g, \"within\": %zu}\n",
      found.size(), quantile(0.5), quantile(0.9), quantile(0.99), found.back(),
      static_cast<std::size_t>(within));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string task = argc > 1 ? argv[1] : "";
    if (task == "topology" && argc == 3) {
      print_topology(benchmarks::read_mesh(argv[2]));
    } else if (task == "distance" && (argc == 4 || argc == 5)) {
      print_distance(benchmarks::read_mesh(argv[2]), benchmarks::read_mesh(argv[3]),
                     argc == 5 ? std::stod(argv[4]) : 0);
    } else {
      std::fprintf(stderr, "usage: measure_surface topology MESH | distance FROM TO [LIMIT]\n");
      return 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
