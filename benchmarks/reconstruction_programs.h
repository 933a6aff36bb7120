// Programs that make a surface of points with normals, each in a process of its own.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/child_process.h"
#include "benchmarks/point_file.h"
#include "common/core/mesh.h"

namespace meshcomplete::benchmarks {

struct Reconstruction {
  TriangleMesh mesh;
  ProcessUse use;                        ///< with reading the points and writing the mesh
  std::map<std::string, double> stages;  ///< seconds of those that the program names
};

/// The programs, and a folder for their files that is removed with this.
class ReconstructionPrograms {
 public:
  /// Runs `reconstruct_points` from the folder `programs`.
  explicit ReconstructionPrograms(std::filesystem::path programs);
  ~ReconstructionPrograms();
  ReconstructionPrograms(const ReconstructionPrograms&) = delete;
  ReconstructionPrograms& operator=(const ReconstructionPrograms&) = delete;

  /// The points that all programs get from now on. Throws std::runtime_error.
  void set_points(const OrientedPoints& set);

  /// MeshLab's Surface Reconstruction: Screened Poisson with its defaults. Nothing when it made no mesh, as
  /// the others.
  std::optional<Reconstruction> meshlab(int depth) const;
  /// What MeshLab needs to start, to read the points and to write them.
  std::optional<ProcessUse> meshlab_alone() const;
  /// A method of `reconstruct_points` with its arguments.
  std::optional<Reconstruction> ours(const std::string& method,
                                     const std::vector<std::string>& arguments) const;

 private:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::optional<Reconstruction> run(const std::vector<std::string>& command) const;

  std::filesystem::path programs_, folder_;
};

}  // namespace meshcomplete::benchmarks
