// Cuts holes into a mesh, to have something to close.
//
//   cut_holes IN OUT.ply CUT...
//
// A CUT is one of
//   round=X,Y,Z,R      the faces in a ball
//   path=WHERE         the faces round a path that winds over the surface
//   winding=WHERE      the same, with a rim that no fitted plane shows simple
//   overlapping=WHERE  the same, with a rim that no projection shows simple
//   subdivide          every face split into four
// WHERE: SIZE[,SEED[,X,Y,Z,R[,RINGS]]], for a rim of SIZE vertices; the first seed from SEED on that gives
// one; begun in a ball; RINGS of faces on each side of the path.
#include <cstdio>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks/cut_holes.h"
#include "benchmarks/mesh_file.h"
#include "filter_curveunfold/loop_geometry.h"

namespace {

using namespace meshcomplete;
using namespace meshcomplete::benchmarks;

std::vector<double> numbers(const std::string& text) {
  std::vector<double> list;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) list.push_back(std::stod(word));
  return list;
}

TriangleMesh cut(const TriangleMesh& mesh, const std::string& what) {
  if (what == "subdivide") return subdivided(mesh);
  const std::size_t equals = what.find('=');
  const std::string kind = what.substr(0, equals);
  std::vector<double> n =
      equals == std::string::npos ? std::vector<double>() : numbers(what.substr(equals + 1));
  std::optional<CutMesh> result;
  if (kind == "round" && n.size() == 4) {
    result = cut_round_hole(mesh, {Vector3(n[0], n[1], n[2]), n[3]});
  } else if ((kind == "winding" || kind == "overlapping" || kind == "path") &&
             (n.size() == 1 || n.size() == 2 || n.size() == 6 || n.size() == 7)) {
    const Rim rim = kind == "path" ? Rim::any : kind == "winding" ? Rim::strongly_curved : Rim::overlapping;
    const std::uint32_t seed = n.size() > 1 ? static_cast<std::uint32_t>(n[1]) : 1;
    const Region region = n.size() > 2 ? Region{Vector3(n[2], n[3], n[4]), n[5]} : Region();
    result = cut_winding_hole(mesh, static_cast<std::size_t>(n[0]), rim, seed, region,
                              n.size() > 6 ? static_cast<int>(n[6]) : 1);
  } else {
    throw std::runtime_error("not a cut: " + what);
  }
  if (!result) throw std::runtime_error("no such hole can be cut: " + what);
  Vector3 centre = Vector3::Zero();
  for (const Vector3& p : result->rim) centre += p / static_cast<double>(result->rim.size());
  std::printf("%s: a rim of %zu vertices round %.4g,%.4g,%.4g", kind.c_str(), result->rim.size(), centre.x(),
              centre.y(), centre.z());
  const Vector3 outwards = area_vector(result->rim).normalized();
  std::printf(", open towards %.2f,%.2f,%.2f, seed %u\n", outwards.x(), outwards.y(), outwards.z(),
              result->seed);
  return result->mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: cut_holes IN OUT.ply CUT...\n");
    return 2;
  }
  try {
    TriangleMesh mesh = read_mesh(argv[1]);
    for (int i = 3; i < argc; ++i) mesh = cut(mesh, argv[i]);
    write_ply(argv[2], mesh);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
