#include "benchmarks/point_file.h"

#include <CGAL/IO/read_ply_points.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace meshcomplete::benchmarks {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using OrientedPoint = std::pair<Kernel::Point_3, Kernel::Vector_3>;

void put(std::ofstream& file, const Vector3& v) {
  const std::array<float, 3> stored = {static_cast<float>(v[0]), static_cast<float>(v[1]),
                                       static_cast<float>(v[2])};
  file.write(reinterpret_cast<const char*>(stored.data()), sizeof stored);
}

}  // namespace

void write_points(const std::string& path, const OrientedPoints& set) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << set.points.size()
       << "\nproperty float x\nproperty float y\nproperty float z\n"
          "property float nx\nproperty float ny\nproperty float nz\nend_header\n";
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    put(file, set.points[i]);
    put(file, set.normals[i]);
  }
  file.flush();
  if (!file) throw std::runtime_error(path + " cannot be written");
}

OrientedPoints read_points(const std::string& path) {
  std::vector<OrientedPoint> list;
  const auto parameters = CGAL::parameters::point_map(CGAL::First_of_pair_property_map<OrientedPoint>())
                              .normal_map(CGAL::Second_of_pair_property_map<OrientedPoint>());
  if (!CGAL::IO::read_PLY(path, std::back_inserter(list), parameters))
    throw std::runtime_error(path + " cannot be read");
  OrientedPoints set;
  for (const auto& [p, n] : list) {
    set.points.emplace_back(p.x(), p.y(), p.z());
    set.normals.emplace_back(n.x(), n.y(), n.z());
  }
  return set;
}

}  // namespace meshcomplete::benchmarks
