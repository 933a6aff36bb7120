#include "benchmarks/reconstruction_programs.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "benchmarks/mesh_file.h"

namespace meshcomplete::benchmarks {
namespace {

constexpr double limit = 900;  // seconds that a program may take

constexpr const char* script_head = R"(<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Surface Reconstruction: Screened Poisson">
  <Param type="RichBool" name="visibleLayer" value="false"/>
  <Param type="RichInt" name="depth" value=")";
constexpr const char* script_tail = R"("/>
  <Param type="RichInt" name="fullDepth" value="5"/>
  <Param type="RichInt" name="cgDepth" value="0"/>
  <Param type="RichFloat" name="scale" value="1.1"/>
  <Param type="RichFloat" name="samplesPerNode" value="1.5"/>
  <Param type="RichFloat" name="pointWeight" value="4"/>
  <Param type="RichInt" name="iters" value="8"/>
  <Param type="RichBool" name="confidence" value="false"/>
  <Param type="RichBool" name="preClean" value="false"/>
 </filter>
</FilterScript>
)";

// Lines "name: seconds".
std::map<std::string, double> stages_in(const std::string& text) {
  std::map<std::string, double> stages;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t colon = line.find(": "); colon != std::string::npos)
      stages[line.substr(0, colon)] = std::atof(line.c_str() + colon + 2);
  return stages;
}

}  // namespace

ReconstructionPrograms::ReconstructionPrograms(std::filesystem::path programs)
    : programs_(std::move(programs)) {
  std::string name = (std::filesystem::temp_directory_path() / "reconstruction-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("There is no folder for temporary files.");
  folder_ = name;
}

ReconstructionPrograms::~ReconstructionPrograms() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void ReconstructionPrograms::set_points(const OrientedPoints& set) { write_points(path("in.ply"), set); }

std::optional<Reconstruction> ReconstructionPrograms::run(const std::vector<std::string>& command) const {
  std::filesystem::remove(path("out.ply"));
  auto use = run_process(command, limit);
  // The exit code of meshlabserver says nothing.
  if (!use || !std::filesystem::exists(path("out.ply"))) return std::nullopt;
  Reconstruction result{read_mesh(path("out.ply")), {}, stages_in(use->output)};
  result.use = std::move(*use);
  if (result.mesh.triangles.empty()) return std::nullopt;
  return result;
}

std::optional<Reconstruction> ReconstructionPrograms::meshlab(int depth) const {
  std::ofstream(path("script.mlx")) << script_head << depth << script_tail;
  return run({"meshlabserver", "-i", path("in.ply"), "-o", path("out.ply"), "-s", path("script.mlx")});
}

std::optional<ProcessUse> ReconstructionPrograms::meshlab_alone() const {
  return run_process({"meshlabserver", "-i", path("in.ply"), "-o", path("out.ply")}, limit);
}

std::optional<Reconstruction> ReconstructionPrograms::ours(const std::string& method,
                                                           const std::vector<std::string>& arguments) const {
  std::vector<std::string> command = {(programs_ / "reconstruct_points").string(), method, path("in.ply"),
                                      path("out.ply")};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run(command);
}

}  // namespace meshcomplete::benchmarks
