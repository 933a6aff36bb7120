#include "tools/meshcomplete/input_check.h"

#include "tools/meshcomplete/errors.h"
#include "tools/meshcomplete/suggest.h"

#include <unistd.h>

#include <QFile>
#include <QFileInfo>

#include <charconv>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace meshcomplete {
namespace runner {

namespace {

/// Reads an OFF file the way MeshLab's reader does, and stops where that one would run off the end.
class OffCheck {
 public:
  explicit OffCheck(const QString& path) : in_(QFile::encodeName(path).constData(), std::ios::binary) {}

  /// What is wrong, or nothing.
  std::string run() {
    if (!next_line() || tokens_[0].find("OFF") == std::string_view::npos) return "it does not start with OFF";
    const std::string_view prefix = tokens_[0].substr(0, tokens_[0].rfind("OFF"));
    const bool colours = prefix.find('C') != std::string_view::npos;
    per_vertex_ = 3 + (prefix.find('N') != std::string_view::npos ? 3 : 0) +
                  (prefix.find("ST") != std::string_view::npos ? 2 : 0);
    std::size_t at = 1;
    if (tokens_.size() == 1) {
      if (!next_line()) return "the numbers of vertices and faces are missing";
      at = 0;
    }
    if (tokens_.size() < at + 3 || !whole(tokens_[at], vertices_) || !whole(tokens_[at + 1], faces_))
      return "the numbers of vertices and faces are missing";
    const std::string problem = colours ? vertices_by_line() : vertices_by_token();
    return problem.empty() ? all_faces() : problem;
  }

 private:
  bool next_line() {
    while (std::getline(in_, line_)) {
      if (line_.empty() || line_[0] == '#') continue;
      split();
      if (!tokens_.empty()) return true;
    }
    tokens_.clear();
    return false;
  }

  void split() {
    tokens_.clear();
    std::size_t at = 0;
    const std::string_view line(line_);
    while ((at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos) {
      const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
      tokens_.push_back(line.substr(at, end - at));
      at = end;
    }
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

  std::string ends_at_vertex(long long vertex) const {
    return "it ends at vertex " + std::to_string(vertex) + " of " + std::to_string(vertices_);
  }

  std::string vertices_by_line() {
    for (long long vertex = 0; vertex < vertices_; ++vertex) {
      if (!next_line()) return ends_at_vertex(vertex);
      if (tokens_.size() < per_vertex_) return "vertex " + std::to_string(vertex) + " is not complete";
      for (std::size_t i = 0; i < 3; ++i)
        if (!number(tokens_[i])) return "vertex " + std::to_string(vertex) + " has a coordinate that is no number";
    }
    return {};
  }

  std::string vertices_by_token() {
    tokens_.clear();
    std::size_t at = 0;
    for (long long vertex = 0; vertex < vertices_; ++vertex) {
      for (std::size_t i = 0; i < per_vertex_; ++i) {
        if (at == tokens_.size()) {
          if (!next_line()) return ends_at_vertex(vertex);
          at = 0;
        }
        if (!number(tokens_[at++])) return "vertex " + std::to_string(vertex) + " has a coordinate that is no number";
      }
    }
    return {};
  }

  std::string all_faces() {
    for (long long face = 0; face < faces_; ++face) {
      const std::string name = "face " + std::to_string(face);
      long long corners = 0;
      if (!next_line()) return "it ends at " + name + " of " + std::to_string(faces_);
      if (!whole(tokens_[0], corners) || corners < 3) return name + " does not have three corners or more";
      std::size_t at = 1;
      for (long long corner = 0; corner < corners; ++corner) {
        if (at == tokens_.size()) {
          if (!next_line()) return "it ends inside " + name;
          at = 0;
        }
        long long vertex = 0;
        if (!whole(tokens_[at++], vertex) || vertex >= vertices_) return name + " refers to a vertex that is not there";
      }
    }
    return {};
  }

  std::ifstream in_;
  std::string line_;
  std::vector<std::string_view> tokens_;
  std::size_t per_vertex_ = 3;
  long long vertices_ = 0;
  long long faces_ = 0;
};

}  // namespace

void check_readable(const QString& path, const QStringList& formats) {
  const QFileInfo file(path);
  if (!file.exists()) throw UsageError("There is no file " + path + ".");
  if (file.isDir()) throw UsageError(path + " is a folder, not a mesh file.");
  if (access(QFile::encodeName(path).constData(), R_OK) != 0)
    throw UsageError("There is no permission to read " + path + ".");
  const QString extension = file.suffix().toLower();
  if (!formats.contains(extension))
    throw UsageError(QString("MeshLab does not read files like %1. It reads: %2.%3")
                         .arg(path, formats.join(' '), did_you_mean(extension, formats)));
}

void check_contents(const QString& path) {
  const QFileInfo file(path);
  if (file.size() == 0) throw Failure("The file " + path + " is empty.");
  if (file.suffix().toLower() != "off") return;
  const std::string problem = OffCheck(path).run();
  if (!problem.empty())
    throw Failure(QString("The file %1 is damaged: %2.").arg(path, QString::fromStdString(problem)));
}

}  // namespace runner
}  // namespace meshcomplete
