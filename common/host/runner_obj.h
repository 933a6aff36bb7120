// OBJ files for MeshLab 2020.09, whose reader stops the program at the first face that uses vertex 1. Internal to
// common/host.
#pragma once

#include <string>

namespace meshcomplete {
namespace host {

/// So many vertices stand at the front of `obj_for_meshlab`'s result that are not the file's, and are to be removed.
constexpr int obj_stand_ins = 2;

/// The contents of an OBJ file in a form that the reader takes: stand-ins in front of vertices, texture coordinates and
/// normals, all numbers shifted, and a texture coordinate and a normal at every corner when there are some at all.
/// Coordinates are copied as they are written. Throws CompletionError when the file is damaged.
std::string obj_for_meshlab(const std::string& path);

/// Text as a file that vanishes with this object.
class TextFile {
 public:
  explicit TextFile(const std::string& text);
  ~TextFile();
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  std::string path() const;

 private:
  int descriptor_;
};

}  // namespace host
}  // namespace meshcomplete
