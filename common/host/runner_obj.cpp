#include <algorithm>
#include <charconv>

#include "common/core/error.h"
#include "common/host/runner_text.h"

namespace meshcomplete {
namespace host {

namespace {

const char* const stage = "reading an OBJ file";

/// Numbers of vertices, texture coordinates and normals.
struct Counts {
  long long vertices = 0, textures = 0, normals = 0;
};

/// An OBJ number (from 1, or negative: counted from the last one so far) as one from 1 behind the stand-ins.
long long shifted(std::string_view token, long long so_far, const char* what) {
  long long number = 0;
  const auto result = std::from_chars(token.data(), token.data() + token.size(), number);
  if (result.ec != std::errc() || result.ptr != token.data() + token.size())
    throw CompletionError(stage, "\"" + std::string(token) + "\" is not the number of a " + what);
  if (number < 0) number += so_far + 1;
  if (number < 1 || number > so_far)
    throw CompletionError(
        stage, std::string("a face refers to a ") + what + " that is not there (" + std::string(token) + ")");
  return number + obj_stand_ins;
}

class Rewriter {
 public:
  explicit Rewriter(const std::string& path) : path_(path) {}

  std::string run() {
    count();
    if (total_.vertices == 0) throw CompletionError(stage, "it has no vertices");
    write_stand_ins();
    for (TextLines lines(path_, true); lines.next();) {
      const std::string_view word = lines.tokens()[0];
      if (word == "v") ++so_far_.vertices;
      if (word == "vt") ++so_far_.textures;
      if (word == "vn") ++so_far_.normals;
      if (word == "f" || word == "l")
        write_element(lines.tokens(), word == "f");
      else
        text_ += lines.joined() + '\n';
    }
    return std::move(text_);
  }

 private:
  void count() {
    for (TextLines lines(path_, true); lines.next();) {
      const std::string_view word = lines.tokens()[0];
      const std::size_t numbers = lines.tokens().size() - 1;
      if (word == "v" && total_.vertices++ == 0) first_vertex_ = lines.joined();
      if (word == "vt") ++total_.textures;
      if (word == "vn") ++total_.normals;
      if ((word == "v" || word == "vn") && numbers < 3)
        throw CompletionError(stage, "the line \"" + lines.joined() + "\" has fewer than three numbers");
      if (word == "f" && numbers < 3)
        throw CompletionError(stage, "the line \"" + lines.joined() + "\" is not a face");
    }
  }

  void write_stand_ins() {
    for (int i = 0; i < obj_stand_ins; ++i) {
      text_ += first_vertex_ + '\n';
      if (total_.textures > 0) text_ += "vt 0 0\n";
      if (total_.normals > 0) text_ += "vn 0 0 1\n";
    }
  }

  void write_element(const std::vector<std::string_view>& tokens, bool face) {
    text_ += tokens[0];
    for (std::size_t i = 1; i < tokens.size(); ++i) {
      text_ += ' ';
      const std::string_view token = tokens[i];
      const std::size_t first = std::min(token.find('/'), token.size());
      text_ += std::to_string(shifted(token.substr(0, first), so_far_.vertices, "vertex"));
      if (face) write_corner(first < token.size() ? token.substr(first + 1) : std::string_view());
    }
    text_ += '\n';
  }

  /// What follows the vertex of a corner: "texture/normal", each of them perhaps missing.
  void write_corner(std::string_view rest) {
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    const std::string_view texture = rest.substr(0, slash);
    const std::string_view normal = slash < rest.size() ? rest.substr(slash + 1) : std::string_view();
    const auto number = [](std::string_view token, long long so_far, const char* what) {
      return std::to_string(token.empty() ? obj_stand_ins : shifted(token, so_far, what));
    };
    if (total_.textures > 0) text_ += "/" + number(texture, so_far_.textures, "texture coordinate");
    if (total_.normals > 0)
      text_ += (total_.textures > 0 ? "/" : "//") + number(normal, so_far_.normals, "normal");
  }

  std::string path_;
  std::string text_;
  std::string first_vertex_;
  Counts total_;
  Counts so_far_;
};

}  // namespace

std::string obj_for_meshlab(const std::string& path) { return Rewriter(path).run(); }

}  // namespace host
}  // namespace meshcomplete
