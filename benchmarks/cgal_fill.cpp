// Closes every hole of a mesh with CGAL's triangulate_refine_and_fair_hole, to compare with.
//
//   cgal_fill IN OUT.ply
#include <cstdio>
#include <exception>

#include "benchmarks/cgal_filling.h"
#include "benchmarks/mesh_file.h"

int main(int argc, char** argv) {
  using namespace meshcomplete::benchmarks;
  if (argc != 3) {
    std::fprintf(stderr, "usage: cgal_fill IN OUT.ply\n");
    return 2;
  }
  try {
    const CgalFilling result = fill_with_cgal(read_mesh(argv[1]));
    std::printf("%zu of %zu holes filled in %.3f s\n", result.filled, result.holes, result.seconds);
    write_ply(argv[2], result.mesh);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
