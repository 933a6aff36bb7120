#include "common/host/runner_obj.h"

#include "common/core/error.h"

#include <sys/mman.h>
#include <unistd.h>

#include <charconv>
#include <fstream>
#include <string_view>
#include <vector>

namespace meshcomplete {
namespace host {

namespace {

const char* const stage = "reading an OBJ file";

/// Numbers of vertices, texture coordinates and normals.
struct Counts {
  long long vertices = 0, textures = 0, normals = 0;
};

/// The lines of a file, continued ones joined, split at blanks; comments and empty lines left out.
class Lines {
 public:
  explicit Lines(const std::string& path) : in_(path, std::ios::binary) {}

  bool next() {
    while (read_joined()) {
      split();
      if (!tokens_.empty() && tokens_[0][0] != '#') return true;
    }
    return false;
  }
  const std::string& line() const { return line_; }
  const std::vector<std::string_view>& tokens() const { return tokens_; }

 private:
  bool read_joined() {
    if (!std::getline(in_, line_)) return false;
    strip();
    while (!line_.empty() && line_.back() == '\\') {
      std::string more;
      line_.pop_back();
      if (!std::getline(in_, more)) break;
      line_ += more;
      strip();
    }
    return true;
  }

  void strip() {
    while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ')) line_.pop_back();
  }

  void split() {
    tokens_.clear();
    const std::string_view line(line_);
    std::size_t at = 0;
    while ((at = line.find_first_not_of(" \t", at)) != std::string_view::npos) {
      const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
      tokens_.push_back(line.substr(at, end - at));
      at = end;
    }
  }

  std::ifstream in_;
  std::string line_;
  std::vector<std::string_view> tokens_;
};

/// An OBJ number (from 1, or negative: counted from the last one so far) as one from 1 behind the stand-ins.
long long shifted(std::string_view token, long long so_far, const char* what) {
  long long number = 0;
  const auto result = std::from_chars(token.data(), token.data() + token.size(), number);
  if (result.ec != std::errc() || result.ptr != token.data() + token.size())
    throw CompletionError(stage, "\"" + std::string(token) + "\" is not the number of a " + what);
  if (number < 0) number += so_far + 1;
  if (number < 1 || number > so_far)
    throw CompletionError(stage, std::string("a face refers to a ") + what + " that is not there (" + std::string(token) + ")");
  return number + obj_stand_ins;
}

class Rewriter {
 public:
  explicit Rewriter(const std::string& path) : path_(path) {}

  std::string run() {
    count();
    if (total_.vertices == 0) throw CompletionError(stage, "it has no vertices");
    write_stand_ins();
    for (Lines lines(path_); lines.next();) {
      const std::string_view word = lines.tokens()[0];
      if (word == "v") ++so_far_.vertices;
      if (word == "vt") ++so_far_.textures;
      if (word == "vn") ++so_far_.normals;
      if (word == "f" || word == "l")
        write_element(lines.tokens(), word == "f");
      else
        text_ += lines.line() + '\n';
    }
    return std::move(text_);
  }

 private:
  void count() {
    for (Lines lines(path_); lines.next();) {
      const std::string_view word = lines.tokens()[0];
      const std::size_t numbers = lines.tokens().size() - 1;
      if (word == "v" && total_.vertices++ == 0) first_vertex_ = lines.line();
      if (word == "vt") ++total_.textures;
      if (word == "vn") ++total_.normals;
      if ((word == "v" || word == "vn") && numbers < 3)
        throw CompletionError(stage, "the line \"" + lines.line() + "\" has fewer than three numbers");
      if (word == "f" && numbers < 3) throw CompletionError(stage, "the line \"" + lines.line() + "\" is not a face");
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

TextFile::TextFile(const std::string& text) : descriptor_(memfd_create("mesh.obj", MFD_CLOEXEC)) {
  std::size_t written = 0;
  while (descriptor_ >= 0 && written < text.size()) {
    const ssize_t count = write(descriptor_, text.data() + written, text.size() - written);
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  if (written < text.size()) throw CompletionError(stage, "there is not enough memory for it");
}

TextFile::~TextFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string TextFile::path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

}  // namespace host
}  // namespace meshcomplete
