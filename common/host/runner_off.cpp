#include <charconv>

#include "common/core/error.h"
#include "common/host/runner_text.h"

namespace meshcomplete {
namespace host {

namespace {

/// Reads an OFF file and writes it again.
class OffRewriter {
 public:
  explicit OffRewriter(const std::string& path) : lines_(path, false) {}

  std::string run() {
    header();
    if (colours_)
      vertices_by_line();
    else
      vertices_by_token();
    faces();
    return std::move(text_);
  }

 private:
  [[noreturn]] static void damaged(const std::string& how) {
    throw CompletionError("reading an OFF file", "the file is damaged: " + how);
  }

  static bool whole(std::string_view token, long long& value) {
    const auto result = std::from_chars(token.data(), token.data() + token.size(), value);
    return result.ec == std::errc() && value >= 0 && value < (1LL << 31);
  }

  static bool number(std::string_view token) {
    if (token[0] == '+') token.remove_prefix(1);
    double value = 0;
    const auto result = std::from_chars(token.data(), token.data() + token.size(), value);
    return result.ptr == token.data() + token.size() && result.ec != std::errc::invalid_argument;
  }

  void header() {
    if (!lines_.next()) damaged("it does not start with OFF");
    const std::string keyword(lines_.tokens()[0]);
    const std::size_t off = keyword.rfind("OFF");
    if (off == std::string::npos) damaged("it does not start with OFF");
    const std::string prefix = keyword.substr(0, off);
    colours_ = prefix.find('C') != std::string::npos;
    if (prefix.find('N') != std::string::npos) per_vertex_ += 3;
    if (prefix.find("ST") != std::string::npos) per_vertex_ += 2;
    std::size_t at = 1;
    if (lines_.tokens().size() == 1) {
      lines_.next();
      at = 0;
    }
    if (lines_.tokens().size() < at + 2 || !whole(lines_.tokens()[at], vertices_) ||
        !whole(lines_.tokens()[at + 1], faces_))
      damaged("the numbers of vertices and faces are missing");
    text_ = keyword + "\n" + std::to_string(vertices_) + " " + std::to_string(faces_) + " 0\n";
  }

  [[noreturn]] void ends_at_vertex(long long vertex) const {
    damaged("it ends at vertex " + std::to_string(vertex) + " of " + std::to_string(vertices_));
  }

  static void check_coordinate(std::string_view token, long long vertex) {
    if (!number(token)) damaged("vertex " + std::to_string(vertex) + " has a coordinate that is no number");
  }

  /// Colours are as many numbers as are left on the line, so a vertex is a line.
  void vertices_by_line() {
    for (long long vertex = 0; vertex < vertices_; ++vertex) {
      if (!lines_.next()) ends_at_vertex(vertex);
      const std::size_t count = lines_.tokens().size();
      if (count < per_vertex_ || count > per_vertex_ + 4)
        damaged("vertex " + std::to_string(vertex) + " has " + std::to_string(count) + " numbers");
      for (std::size_t i = 0; i < 3; ++i) check_coordinate(lines_.tokens()[i], vertex);
      text_ += lines_.joined() + '\n';
    }
  }

  void vertices_by_token() {
    std::size_t at = lines_.tokens().size();
    for (long long vertex = 0; vertex < vertices_; ++vertex) {
      for (std::size_t i = 0; i < per_vertex_; ++i) {
        if (at == lines_.tokens().size()) {
          if (!lines_.next()) ends_at_vertex(vertex);
          at = 0;
        }
        check_coordinate(lines_.tokens()[at], vertex);
        text_ += lines_.tokens()[at++];
        text_ += i + 1 < per_vertex_ ? ' ' : '\n';
      }
    }
  }

  void faces() {
    for (long long face = 0; face < faces_; ++face) {
      const std::string name = "face " + std::to_string(face);
      long long corners = 0;
      if (!lines_.next()) damaged("it ends at " + name + " of " + std::to_string(faces_));
      if (!whole(lines_.tokens()[0], corners) || corners < 3)
        damaged(name + " does not have three corners or more");
      text_ += std::to_string(corners);
      std::size_t at = 1;
      for (long long corner = 0; corner < corners; ++corner) {
        if (at == lines_.tokens().size()) {
          if (!lines_.next()) damaged("it ends inside " + name);
          at = 0;
        }
        long long vertex = 0;
        if (!whole(lines_.tokens()[at++], vertex) || vertex >= vertices_)
          damaged(name + " refers to a vertex that is not there");
        text_ += ' ' + std::to_string(vertex);
      }
      for (; at < lines_.tokens().size(); ++at) {
        text_ += ' ';
        text_ += lines_.tokens()[at];
      }
      text_ += '\n';
    }
  }

  TextLines lines_;
  std::string text_;
  bool colours_ = false;
  std::size_t per_vertex_ = 3;
  long long vertices_ = 0;
  long long faces_ = 0;
};

}  // namespace

std::string off_for_meshlab(const std::string& path) { return OffRewriter(path).run(); }

}  // namespace host
}  // namespace meshcomplete
