#include "tools/meshcomplete/exact_text.h"

#include <QFile>
#include <QFileInfo>
#include <charconv>
#include <fstream>
#include <string>

#include "tools/meshcomplete/errors.h"

namespace meshcomplete {
namespace runner {

namespace {

using host::LayerGeometry;
using Point = std::array<float, 3>;

/// Where the next token of `line` starts at or after `at`.
std::size_t token_start(const std::string& line, std::size_t at) {
  const std::size_t start = line.find_first_not_of(" \t", at);
  return start == std::string::npos ? line.size() : start;
}

std::size_t token_end(const std::string& line, std::size_t at) {
  const std::size_t end = line.find_first_of(" \t\r", at);
  return end == std::string::npos ? line.size() : end;
}

std::string as_text(const Point& point) {
  std::string text;
  for (const float coordinate : point) {
    char digits[32];
    const auto result = std::to_chars(digits, digits + sizeof(digits), coordinate);
    if (!text.empty()) text += ' ';
    text.append(digits, result.ptr);
  }
  return text;
}

/// Replaces the three numbers that start at the token behind `skip` tokens.
bool replace_point(std::string& line, int skip, const Point& point) {
  std::size_t begin = token_start(line, 0);
  for (int i = 0; i < skip; ++i) begin = token_start(line, token_end(line, begin));
  std::size_t end = begin;
  for (int i = 0; i < 3; ++i) {
    const std::size_t start = token_start(line, end);
    if (start == line.size()) return false;
    end = token_end(line, start);
  }
  line.replace(begin, end - begin, as_text(point));
  return true;
}

/// Finds the vertices of one format while its lines go by.
class Format {
 public:
  virtual ~Format() = default;
  /// How many tokens stand in front of the coordinates on this line; -1 when it holds none.
  virtual int tokens_before_point(const std::string& line) = 0;
};

/// A header, then the vertices one a line.
class HeaderFormat : public Format {
 public:
  HeaderFormat(std::size_t vertices, bool ply) : left_(vertices), ply_(ply) {}
  int tokens_before_point(const std::string& line) override {
    if (in_header_) {
      if (ply_ && line.rfind("element camera 1", 0) == 0) skip_ = 1;
      const bool last = ply_ ? line.rfind("end_header", 0) == 0 : ++header_lines_ == 2;
      in_header_ = !last;
      return -1;
    }
    if (skip_ > 0) {
      --skip_;
      return -1;
    }
    return left_ > 0 && left_-- > 0 ? 0 : -1;
  }

 private:
  std::size_t left_;
  bool ply_;
  bool in_header_ = true;
  int header_lines_ = 0;
  int skip_ = 0;
};

/// A word in front of every vertex.
class KeywordFormat : public Format {
 public:
  explicit KeywordFormat(std::string keyword) : keyword_(std::move(keyword)) {}
  int tokens_before_point(const std::string& line) override {
    const std::size_t start = token_start(line, 0);
    return line.compare(start, token_end(line, start) - start, keyword_) == 0 ? 1 : -1;
  }

 private:
  std::string keyword_;
};

std::unique_ptr<Format> format_of(const QString& extension, std::size_t vertices) {
  if (extension == "off") return std::make_unique<HeaderFormat>(vertices, false);
  if (extension == "ply") return std::make_unique<HeaderFormat>(vertices, true);
  if (extension == "obj") return std::make_unique<KeywordFormat>("v");
  if (extension == "stl") return std::make_unique<KeywordFormat>("vertex");
  return nullptr;
}

/// The points in the order in which the format lists them: STL repeats them for every face.
class Points {
 public:
  Points(const LayerGeometry& geometry, bool per_corner) : geometry_(geometry), per_corner_(per_corner) {}
  std::size_t size() const { return per_corner_ ? 3 * geometry_.faces.size() : geometry_.vertices.size(); }
  const Point& operator[](std::size_t i) const {
    return geometry_.vertices[per_corner_ ? geometry_.faces[i / 3][i % 3] : i];
  }

 private:
  const LayerGeometry& geometry_;
  bool per_corner_;
};

}  // namespace

QString restore_coordinates(const QString& path, const LayerGeometry& geometry, bool binary) {
  const QString extension = QFileInfo(path).suffix().toLower();
  if (binary && (extension == "ply" || extension == "stl")) return QString();
  const std::unique_ptr<Format> format = format_of(extension, geometry.vertices.size());
  if (!format)
    return QString("MeshLab's writer for .%1 may round coordinates; PLY keeps them exactly.").arg(extension);
  const Points points(geometry, extension == "stl");
  const QString rewritten = path + ".exact";
  std::ifstream in(QFile::encodeName(path).constData(), std::ios::binary);
  std::ofstream out(QFile::encodeName(rewritten).constData(), std::ios::binary);
  std::size_t next = 0;
  bool fits = true;
  for (std::string line; fits && std::getline(in, line);) {
    const int skip = format->tokens_before_point(line);
    if (skip >= 0) fits = next < points.size() && replace_point(line, skip, points[next++]);
    out << line << '\n';
  }
  fits = fits && next == points.size();
  out.close();
  if (!fits || !out || in.bad()) {
    QFile::remove(rewritten);
    throw Failure(QString("Writing %1: the file that MeshLab wrote is not complete; is the disk full?")
                      .arg(QFileInfo(path).fileName()));
  }
  QFile::remove(path);
  QFile::rename(rewritten, path);
  return QString();
}

}  // namespace runner
}  // namespace meshcomplete
