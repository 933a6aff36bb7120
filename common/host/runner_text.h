// Mesh files in text form, as MeshLab 2020.09's readers can take them. Internal to common/host.
//
// Its OBJ reader stops the program at the first face that uses vertex 1, and its OFF reader checks no index
// and runs off the end of a line of blanks or of a file that was cut off. Both get a copy that is checked and
// written plainly; numbers are copied as they stand, so no coordinate changes.
#pragma once

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace meshcomplete {
namespace host {

/// So many vertices stand at the front of `obj_for_meshlab`'s result that are not the file's, and are to be
/// removed.
constexpr int obj_stand_ins = 2;

/// The contents of an OBJ file with stand-ins in front of vertices, texture coordinates and normals, all
/// numbers shifted, and a texture coordinate and a normal at every corner when there are some at all. Throws
/// CompletionError when the file is damaged. Cost: two passes over the file, and its size in memory.
std::string obj_for_meshlab(const std::string& path);

/// The contents of an OFF file with one vertex or face a line. Throws CompletionError when there are fewer
/// than the file says, when a coordinate is no number, or when a face refers to a vertex that is not there.
/// Cost: one pass over the file, and its size in memory.
std::string off_for_meshlab(const std::string& path);

/// The lines of a text file, split at blanks. Comments (from # on) and lines with nothing else are left out.
class TextLines {
 public:
  /// With `continued`, a line that ends in a backslash goes on in the next one.
  TextLines(const std::string& path, bool continued) : in_(path, std::ios::binary), continued_(continued) {}

  bool next();
  /// The line's tokens, until the next call of `next`; none at the end of the file.
  const std::vector<std::string_view>& tokens() const { return tokens_; }
  /// The tokens with one blank between them.
  std::string joined() const;

 private:
  bool read_line();

  std::ifstream in_;
  std::string line_;
  std::vector<std::string_view> tokens_;
  bool continued_;
};

/// Text as a file that vanishes with this object.
class TextFile {
 public:
  /// Throws CompletionError when there is no memory for it.
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
