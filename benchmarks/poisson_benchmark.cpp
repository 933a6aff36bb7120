// Prints how the screened Poisson reconstruction and the meshes of it fare beside those of other programs.
//
//   poisson_benchmark [solver|convergence|oracle|remeshing|criteria]... MESH...    without a word: all
//
// The meshes are closed ones, beside a sphere and a torus. MeshLab and the program reconstruct_points run in
// processes of their own; MeshLab needs a display, so run this under xvfb-run where there is none.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/arguments.h"
#include "benchmarks/known_surfaces.h"
#include "benchmarks/measuring.h"
#include "benchmarks/mesh_file.h"
#include "benchmarks/poisson_parts.h"

namespace {

using namespace meshcomplete;
using namespace meshcomplete::benchmarks;

// As many as the vertices of the paper's armadillo of 346,000 faces.
constexpr std::size_t sample_count = 173000;

std::vector<KnownSurface> surfaces(const std::vector<std::string>& files, std::size_t samples) {
  std::vector<KnownSurface> list;
  for (const std::string& file : files) list.push_back(known_mesh(file_name(file), read_mesh(file), samples));
  list.push_back(known_sphere(samples));
  list.push_back(known_torus(samples));
  return list;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a table that grows as it is measured
  const Arguments arguments(argc, argv, {"solver", "convergence", "oracle", "remeshing", "criteria"});
  try {
    const std::filesystem::path programs =
        std::filesystem::canonical("/proc/self/exe").parent_path().parent_path() / "bin";
    const std::vector<KnownSurface> truths = surfaces(arguments.files, sample_count);
    if (arguments.wanted("solver")) solver(truths, programs);
    if (arguments.wanted("convergence")) convergence(truths);
    if (arguments.wanted("oracle")) oracle(truths);
    if (arguments.wanted("remeshing")) remeshing(truths, programs);
    if (arguments.wanted("criteria")) criteria(truths, programs);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
