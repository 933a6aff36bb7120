#include "benchmarks/mesh_file.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>

#include <fstream>
#include <stdexcept>

namespace meshcomplete {
namespace benchmarks {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

bool is_stl(const std::string& path) {
  const std::string end = path.size() < 4 ? "" : path.substr(path.size() - 4);
  return end == ".stl" || end == ".STL";
}

template <class T>
void put(std::ofstream& file, T value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

TriangleMesh read_mesh(const std::string& path) {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  if (!CGAL::IO::read_polygon_soup(path, points, polygons))
    throw std::runtime_error(path + " cannot be read");
  if (is_stl(path)) CGAL::Polygon_mesh_processing::merge_duplicate_points_in_polygon_soup(points, polygons);
  TriangleMesh mesh;
  mesh.vertices.reserve(points.size());
  for (const Point& p : points)
    mesh.vertices.push_back(Vector3(p.x(), p.y(), p.z()).cast<float>().cast<double>());
  for (const std::vector<std::size_t>& polygon : polygons) {
    for (std::size_t corner : polygon)
      if (corner >= points.size())
        throw std::runtime_error(path + " has a face with a corner that does not exist");
    for (std::size_t k = 2; k < polygon.size(); ++k)
      mesh.triangles.push_back({static_cast<Index>(polygon[0]), static_cast<Index>(polygon[k - 1]),
                                static_cast<Index>(polygon[k])});
  }
  return mesh;
}

void write_ply(const std::string& path, const TriangleMesh& mesh, const std::vector<Colour>& colours) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices.size()
       << "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!colours.empty()) file << "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  file << "element face " << mesh.triangles.size()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) put(file, static_cast<float>(mesh.vertices[i][k]));
    if (!colours.empty())
      for (std::uint8_t channel : colours[i]) put(file, channel);
  }
  for (const Triangle& t : mesh.triangles) {
    put(file, std::uint8_t{3});
    for (Index corner : t) put(file, static_cast<std::int32_t>(corner));
  }
  file.flush();
  if (!file) throw std::runtime_error(path + " cannot be written");
}

}  // namespace benchmarks
}  // namespace meshcomplete
