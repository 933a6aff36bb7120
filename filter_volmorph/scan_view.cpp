#include "filter_volmorph/scan_view.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "common/core/mesh_topology.h"
#include "filter_volmorph/image_outline.h"

namespace meshcomplete {
namespace {

/// Coordinates in an image are rounded by far less than this part of a pixel, and depths by far less than
/// this part of a voxel (2^-53 of coordinates of at most 2^20 voxels).
constexpr double rounding_pad = 1e-6;

/// Enough pixels to tell apart the depths of a few large tilted faces.
constexpr std::size_t least_pixels = 1 << 14;

/// An image is crowded when a face shares its pixels with more faces than this, on average: in scans with
/// samples at equal distances they are about ten.
constexpr std::uint64_t most_faces_in_pixel = 64;

/// Images with fewer faces, or that were halved so often, are not halved any more.
constexpr std::size_t least_faces_to_halve = 1 << 12;
constexpr int most_halvings = 40;

/// Of a pixel or of a square of pixels.
struct Cell {
  enum Cover : std::uint8_t { none, some, all };
  double low = std::numeric_limits<double>::infinity();  ///< bounds of depth, which grows towards the sensor
  double high = -std::numeric_limits<double>::infinity();
  Cover cover = none;
};

/// What several cells show together.
struct CellSum {
  Cell cell;
  bool begun = false;
  void add(const Cell& other) {
    cell.cover = begun && cell.cover != other.cover ? Cell::some : other.cover;
    begun = true;
    if (other.cover == Cell::none) return;
    cell.low = std::min(cell.low, other.low);
    cell.high = std::max(cell.high, other.high);
  }
};

struct Level {
  int columns = 0, rows = 0;
  std::vector<Cell> cells;
  const Cell& at(int column, int row) const { return cells[std::size_t(row) * columns + column]; }
  Cell& at(int column, int row) { return cells[std::size_t(row) * columns + column]; }
};

/// Half-edges at which the number of faces on a line of sight changes, when all faces look towards the
/// sensor: those without a face on the other side of the edge.
std::vector<Index> cover_changes(const TriangleMesh& scan) {
  const MeshTopology topology = build_topology(scan);
  std::vector<Index> result;
  const Index half_edges = static_cast<Index>(3 * scan.triangles.size());
  const auto start = [&](Index h) { return scan.triangles[h / 3][h % 3]; };
  for (Index h = 0; h < half_edges; ++h) {
    const Index other = topology.opposite[h];
    if (other >= half_edges || start(other) == start(h)) result.push_back(h);
  }
  return result;
}

/// From the viewpoint to the scan.
Vector3 mean_direction(const TriangleMesh& scan, const std::vector<Vector3>& points) {
  Vector3 sum = Vector3::Zero();
  for (const Triangle& t : scan.triangles)
    for (const Index v : t) sum += points[v].normalized();
  return sum.norm() > 0 ? Vector3(sum.normalized()) : Vector3::UnitZ();
}

Eigen::Matrix3d frame_towards(const Vector3& axis) {
  Eigen::Matrix3d rotation;
  rotation.row(2) = axis.normalized();
  rotation.row(0) = Vector3(rotation.row(2)).unitOrthogonal();
  rotation.row(1) = Vector3(rotation.row(2)).cross(Vector3(rotation.row(0)));
  return rotation;
}

}  // namespace

struct ScanView::Image {
  using Points = std::shared_ptr<const std::vector<Vector3>>;

  bool perspective = false;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< rows: to the right, up, towards the sensor
  Vector3 origin = Vector3::Zero();                        ///< the viewpoint
  Points points;  ///< parallel: in the view; perspective: from the viewpoint, not turned
  double nearest = 0;
  std::vector<Triangle> triangles;
  /// The part of the side of the cube, or of the plane, that is this image's, both ends included.
  Range region[2] = {unlimited, unlimited};
  double margin = 0;  ///< faces so near to the region may lie in it
  int halvings = 0;
  Vector2 low, high;  ///< of what the image shows
  double pixel = 1;
  std::vector<std::uint32_t> first;  ///< per pixel, and one more: into `listed`
  std::vector<Index> listed;         ///< triangles that may lie in a pixel
  std::vector<Level> levels;         ///< the pixels first

  Vector3 viewed(Index vertex) const {
    return perspective ? Vector3(rotation * (*points)[vertex]) : (*points)[vertex];
  }
  bool project(const Triangle& corners, int count, Outline& outline) const;
  bool take(const std::vector<Triangle>& candidates);
  bool crowded() const;
  Image half(bool upper) const;
  int number(double x, int axis, int level) const;
  template <class Visit>
  void for_each_pixel(const Outline& outline, Visit&& visit) const;
  Cell depths(const Triangle& corners, int column, int row) const;
  void list_faces();
  void find_cover(const TriangleMesh& scan, const std::vector<Index>& boundary);
  void build_levels();
  double edge(Index a, Index b, const Vector3& line) const;
  std::optional<SightHit> meet(const Vector3& line, int column, int row) const;
  bool bound(const Vector3& middle, double half, Range& u, Range& v, Range& depth) const;
  BlockView judge(const Range& u, const Range& v, const Range& depth, double ramp) const;
};

/// Above 0 to the left of the edge as the sensor sees it. The same number, negated, for the edge the other
/// way round: that is why the ends are put into order. Exactly 0 for parallel rays through one of the ends,
/// so that a voxel straight above a vertex does not fall between the faces round it.
inline double ScanView::Image::edge(Index a, Index b, const Vector3& line) const {
  const bool turned = a > b;
  const Vector3 &p = (*points)[turned ? b : a], &q = (*points)[turned ? a : b];
  const double side = perspective
                          ? -line.dot(p.cross(q))
                          : (p.x() - line.x()) * (q.y() - line.y()) - (q.x() - line.x()) * (p.y() - line.y());
  return turned ? -side : side;
}

/// The outline of a triangle, or of its first edge (`count` 2), as far as it is before a viewpoint.
bool ScanView::Image::project(const Triangle& corners, int count, Outline& outline) const {
  outline.count = 0;
  if (!perspective) {
    for (int k = 0; k < count; ++k) outline.add((*points)[corners[static_cast<std::size_t>(k)]].head<2>());
    return true;
  }
  const double clip = nearest / 2;  // within the image nothing is nearer: its corners are at sqrt(3)
  for (int k = 0; k < count; ++k) {
    const Vector3 a = viewed(corners[static_cast<std::size_t>(k)]);
    const Vector3 b = viewed(corners[static_cast<std::size_t>((k + 1) % count)]);
    if (-a.z() >= clip) outline.add(a.head<2>() / -a.z());
    if ((-a.z() >= clip) != (-b.z() >= clip) && (count > 2 || k == 0)) {
      const Vector3 cut = a + (b - a) * ((clip + a.z()) / (a.z() - b.z()));
      outline.add(cut.head<2>() / clip);
    }
  }
  return outline.count > 0;
}

/// Takes the triangles that may lie in the image; false when there are none.
bool ScanView::Image::take(const std::vector<Triangle>& candidates) {
  Range u, v;
  Outline outline;
  for (const Triangle& t : candidates) {
    if (!project(t, 3, outline)) continue;
    Range at[2];
    for (int i = 0; i < outline.count; ++i)
      for (int axis = 0; axis < 2; ++axis)
        at[axis].include(outline.corners[static_cast<std::size_t>(i)][axis]);
    const auto outside = [&](int axis) {
      return at[axis].low > region[axis].high + margin || at[axis].high < region[axis].low - margin;
    };
    if (outside(0) || outside(1)) continue;
    triangles.push_back(t);
    u.include(at[0].low), u.include(at[0].high);
    v.include(at[1].low), v.include(at[1].high);
  }
  if (triangles.empty()) return false;
  low = Vector2(std::max(u.low, region[0].low), std::max(v.low, region[1].low));
  high = Vector2(std::min(u.high, region[0].high), std::min(v.high, region[1].high)).cwiseMax(low);
  const Vector2 size = high - low;
  const double wanted = static_cast<double>(std::max(least_pixels, triangles.size()));
  // A strip has no area to speak of: as many pixels along it, then.
  pixel = std::max(std::sqrt(size.x() * size.y() / wanted), size.maxCoeff() / wanted);
  Level pixels;
  pixels.columns = std::max(1, static_cast<int>(std::ceil(size.x() / pixel)));
  pixels.rows = std::max(1, static_cast<int>(std::ceil(size.y() / pixel)));
  pixels.cells.resize(std::size_t(pixels.columns) * std::size_t(pixels.rows));
  levels.push_back(std::move(pixels));
  return true;
}

int ScanView::Image::number(double x, int axis, int level) const {
  const int last = (axis == 0 ? levels[0].columns : levels[0].rows) - 1;
  return static_cast<int>(std::clamp((x - low[axis]) / pixel, 0.0, static_cast<double>(last))) >> level;
}

/// `visit(column, row)` for the pixels that an outline may meet.
template <class Visit>
void ScanView::Image::for_each_pixel(const Outline& outline, Visit&& visit) const {
  const double pad = rounding_pad * pixel;
  Range v;
  for (int i = 0; i < outline.count; ++i) v.include(outline.corners[static_cast<std::size_t>(i)].y());
  if (v.low - pad > high.y() || v.high + pad < low.y()) return;
  const int last = number(v.high + pad, 1, 0);
  for (int row = number(v.low - pad, 1, 0); row <= last; ++row) {
    const double bottom = low.y() + row * pixel;
    const Range u = columns_between(outline, bottom - pad, bottom + pixel + pad);
    if (u.low > u.high || u.low - pad > high.x() || u.high + pad < low.x()) continue;
    const int end = number(u.high + pad, 0, 0);
    for (int column = number(u.low - pad, 0, 0); column <= end; ++column) visit(column, row);
  }
}

/// Bounds of the depth of a triangle in a pixel.
Cell ScanView::Image::depths(const Triangle& corners, int column, int row) const {
  const Vector3 a = viewed(corners[0]), b = viewed(corners[1]), c = viewed(corners[2]);
  Cell cell;
  cell.low = std::min({a.z(), b.z(), c.z()});
  cell.high = std::max({a.z(), b.z(), c.z()});
  const Vector3 normal = (b - a).cross(c - a);
  Range plane;
  for (int k = 0; k < 4; ++k) {
    const double u = low.x() + (column + k % 2) * pixel, v = low.y() + (row + k / 2) * pixel;
    if (!perspective) {
      plane.include(a.z() - (normal.x() * (u - a.x()) + normal.y() * (v - a.y())) / normal.z());
      continue;
    }
    // The plane's point at depth z is -z (u, v, -1).
    const double rate = normal.dot(Vector3(-u, -v, 1));
    const double depth = normal.dot(a) / rate;
    if (!(depth < 0)) return cell;  // the plane leaves the image here
    plane.include(depth);
  }
  const double pad = rounding_pad;
  if (std::isfinite(plane.low)) cell.low = std::max(cell.low, plane.low - pad);
  if (std::isfinite(plane.high)) cell.high = std::min(cell.high, plane.high + pad);
  if (cell.low > cell.high) std::swap(cell.low, cell.high);  // beside the triangle
  return cell;
}

void ScanView::Image::list_faces() {
  Level& pixels = levels[0];
  first.assign(pixels.cells.size() + 2, 0);
  Outline outline;
  for (const Triangle& t : triangles) {
    project(t, 3, outline);
    for_each_pixel(outline, [&](int column, int row) {
      ++first[std::size_t(row) * pixels.columns + column + 2];
      const Cell part = depths(t, column, row);
      Cell& cell = pixels.at(column, row);
      cell.low = std::min(cell.low, part.low);
      cell.high = std::max(cell.high, part.high);
    });
  }
  for (std::size_t i = 2; i < first.size(); ++i) first[i] += first[i - 1];
  listed.resize(first.back());
  for (Index t = 0; t < triangles.size(); ++t) {
    project(triangles[t], 3, outline);
    for_each_pixel(outline, [&](int column, int row) {
      listed[first[std::size_t(row) * pixels.columns + column + 1]++] = t;
    });
  }
  first.pop_back();
}

/// Whether the pixels are too large for most of the faces: where samples are much nearer to each other than
/// elsewhere, or a fragment lies far away.
bool ScanView::Image::crowded() const {
  if (halvings == most_halvings || triangles.size() < least_faces_to_halve) return false;
  std::uint64_t squares = 0;
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    const std::uint64_t count = first[i + 1] - first[i];
    squares += count * count;
  }
  return squares > most_faces_in_pixel * listed.size();
}

/// One half of this image's region, without faces yet. Points belong to one of them.
ScanView::Image ScanView::Image::half(bool upper) const {
  Image half;
  half.perspective = perspective;
  half.rotation = rotation;
  half.origin = origin;
  half.points = points;
  half.nearest = nearest;
  half.margin = rounding_pad * pixel;
  half.halvings = halvings + 1;
  std::copy(std::begin(region), std::end(region), std::begin(half.region));
  const int axis = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
  const double middle = (low[axis] + high[axis]) / 2;
  if (upper)
    half.region[axis].low = middle;
  else
    half.region[axis].high = std::nextafter(middle, low[axis]);
  return half;
}

/// What the pixels show: partly covered along the boundary half-edges, elsewhere as in their middles.
void ScanView::Image::find_cover(const TriangleMesh& scan, const std::vector<Index>& boundary) {
  Level& pixels = levels[0];
  Outline outline;
  for (const Index h : boundary) {
    const Triangle& t = scan.triangles[h / 3];
    if (!project({t[h % 3], t[(h + 1) % 3], 0}, 2, outline)) continue;
    for_each_pixel(outline, [&](int column, int row) { pixels.at(column, row).cover = Cell::some; });
  }
  for (int row = 0; row < pixels.rows; ++row) {
    for (int column = 0; column < pixels.columns; ++column) {
      Cell& cell = pixels.at(column, row);
      if (cell.cover == Cell::some) continue;
      const double u = std::min(low.x() + (column + 0.5) * pixel, high.x());
      const double v = std::min(low.y() + (row + 0.5) * pixel, high.y());
      const Vector3 line = perspective ? Vector3(rotation.transpose() * Vector3(u, v, -1)) : Vector3(u, v, 1);
      cell.cover = meet(line, column, row) ? Cell::all : Cell::none;
    }
  }
}

void ScanView::Image::build_levels() {
  while (levels.back().columns > 1 || levels.back().rows > 1) {
    const Level& fine = levels.back();
    Level coarse;
    coarse.columns = (fine.columns + 1) / 2;
    coarse.rows = (fine.rows + 1) / 2;
    coarse.cells.resize(std::size_t(coarse.columns) * std::size_t(coarse.rows));
    for (int row = 0; row < coarse.rows; ++row) {
      for (int column = 0; column < coarse.columns; ++column) {
        CellSum sum;
        for (int y = 2 * row; y < std::min(2 * row + 2, fine.rows); ++y)
          for (int x = 2 * column; x < std::min(2 * column + 2, fine.columns); ++x) sum.add(fine.at(x, y));
        coarse.at(column, row) = sum.cell;
      }
    }
    levels.push_back(std::move(coarse));
  }
}

/// The first triangle of a pixel on a line of sight. The hit's distance is not one yet: it is the depth, for
/// a viewpoint minus the part of `line` up to the hit.
std::optional<SightHit> ScanView::Image::meet(const Vector3& line, int column, int row) const {
  std::optional<SightHit> best;
  const std::size_t at = std::size_t(row) * levels[0].columns + column;
  const double square = perspective ? line.squaredNorm() : 1;
  for (std::uint32_t i = first[at]; i < first[at + 1]; ++i) {
    const Triangle& t = triangles[listed[i]];
    const double a = edge(t[1], t[2], line);
    if (a < 0) continue;
    const double b = edge(t[2], t[0], line);
    if (b < 0) continue;
    const double c = edge(t[0], t[1], line);
    if (c < 0) continue;
    const double sum = a + b + c;
    if (!(sum > 0)) continue;
    const std::array<double, 3> parts{a / sum, b / sum, c / sum};
    const Vector3 hit = parts[0] * (*points)[t[0]] + parts[1] * (*points)[t[1]] + parts[2] * (*points)[t[2]];
    const double depth = perspective ? -hit.dot(line) / square : hit.z();
    if (!best || depth > best->distance) best = SightHit{depth, t, parts};
  }
  return best;
}

/// Where a cube lies in the image, and its depth; false when it is not before the viewpoint.
bool ScanView::Image::bound(const Vector3& middle, double half, Range& u, Range& v, Range& depth) const {
  const Vector3 at = rotation * (middle - origin);
  const Vector3 extent = half * rotation.cwiseAbs().rowwise().sum();
  depth = {at.z() - extent.z(), at.z() + extent.z()};
  u = {at.x() - extent.x(), at.x() + extent.x()};
  v = {at.y() - extent.y(), at.y() + extent.y()};
  if (!perspective) return true;
  if (!(depth.low < 0)) return false;
  const double near = -depth.high, far = -depth.low;
  for (Range* range : {&u, &v}) {
    const double all = std::numeric_limits<double>::infinity();
    range->low = near > 0 ? std::min(range->low / near, range->low / far) : -all;
    range->high = near > 0 ? std::max(range->high / near, range->high / far) : all;
  }
  return true;
}

BlockView ScanView::Image::judge(const Range& u, const Range& v, const Range& depth, double ramp) const {
  if (u.low > high.x() || u.high < low.x() || v.low > high.y() || v.high < low.y()) return BlockView::nothing;
  const bool sticks_out = u.low < low.x() || u.high > high.x() || v.low < low.y() || v.high > high.y();
  int level = 0;
  const auto span = [&](const Range& range, int axis) {
    return number(range.high, axis, level) - number(range.low, axis, level);
  };
  while (span(u, 0) > 2 || span(v, 1) > 2) ++level;
  CellSum sum;
  const int last_column = number(u.high, 0, level), last_row = number(v.high, 1, level);
  for (int row = number(v.low, 1, level); row <= last_row; ++row)
    for (int column = number(u.low, 0, level); column <= last_column; ++column)
      sum.add(levels[static_cast<std::size_t>(level)].at(column, row));
  if (sum.cell.cover == Cell::none || depth.high < sum.cell.low - ramp - rounding_pad) {
    return BlockView::nothing;
  }
  if (!(depth.low > sum.cell.high + ramp + rounding_pad)) return BlockView::near;
  return sum.cell.cover == Cell::all && !sticks_out ? BlockView::empty : BlockView::partly_empty;
}

ScanView::ScanView(std::shared_ptr<const Image> image) : image_(std::move(image)) {}

/// The image, or its halves, and theirs, as long as they are crowded.
void ScanView::add_views(std::shared_ptr<Image> image, const std::vector<Triangle>& candidates,
                         const TriangleMesh& scan, const std::vector<Index>& boundary,
                         std::vector<ScanView>& views) {
  if (!image->take(candidates)) return;
  image->list_faces();
  if (image->crowded()) {
    image->first = {}, image->listed = {}, image->levels = {};
    for (const bool upper : {false, true})
      add_views(std::make_shared<Image>(image->half(upper)), image->triangles, scan, boundary, views);
    return;
  }
  image->find_cover(scan, boundary);
  image->build_levels();
  views.push_back(ScanView(std::move(image)));
}

std::vector<ScanView> ScanView::make(const TriangleMesh& scan, const LineOfSight& line_of_sight,
                                     double nearest) {
  const std::vector<Index> boundary = cover_changes(scan);
  std::vector<ScanView> views;
  Image whole;
  whole.perspective = line_of_sight.kind == LineOfSight::Kind::viewpoint;
  whole.nearest = nearest;
  auto points = std::make_shared<std::vector<Vector3>>(scan.vertices);
  if (whole.perspective) {
    whole.origin = line_of_sight.vector;
    for (Vector3& point : *points) point -= whole.origin;
    whole.rotation = frame_towards(-mean_direction(scan, *points));
  } else {
    whole.rotation = frame_towards(line_of_sight.vector);
    for (Vector3& point : *points) point = whole.rotation * point;
  }
  whole.points = std::move(points);
  const Eigen::Matrix3d turned = whole.rotation;
  for (int side = 0; side < (whole.perspective ? 6 : 1); ++side) {
    auto image = std::make_shared<Image>(whole);
    // The side of the cube to which the scan is comes first, and is usually the only one.
    const int axis = 2 - side / 2;
    image->rotation.row(2) = (side % 2 == 0 ? 1 : -1) * turned.row(axis);
    image->rotation.row(0) = turned.row((axis + 1) % 3);
    image->rotation.row(1) = turned.row((axis + 2) % 3);
    if (whole.perspective) image->region[0] = image->region[1] = {-1, 1};
    add_views(std::move(image), scan.triangles, scan, boundary, views);
  }
  return views;
}

BlockView ScanView::look(const Vector3& middle, double half_side, double ramp) const {
  Range u, v, depth;
  if (!image_->bound(middle, half_side, u, v, depth)) return BlockView::nothing;
  return image_->judge(u, v, depth, ramp);
}

Sighting ScanView::sight(const Vector3& point, double ramp) const {
  const Image& image = *image_;
  const Vector3 away = point - image.origin;
  const Vector3 view = image.rotation * away;
  double u = view.x(), v = view.y();
  if (image.perspective) {
    const double far = -view.z();
    if (!(far > 0) || std::abs(u) > far || std::abs(v) > far) return {};
    u /= far;
    v /= far;
  }
  if (u < image.low.x() || u > image.high.x() || v < image.low.y() || v > image.high.y()) return {};
  const int column = image.number(u, 0, 0), row = image.number(v, 1, 0);
  const Cell& cell = image.levels[0].at(column, row);
  if (cell.cover == Cell::none || view.z() < cell.low - ramp - rounding_pad) return {};
  if (cell.cover == Cell::all && view.z() > cell.high + ramp + rounding_pad) return {BlockView::empty, {}};
  std::optional<SightHit> hit = image.meet(image.perspective ? away : Vector3(u, v, 1), column, row);
  if (!hit) return {};
  hit->distance = image.perspective ? (-hit->distance - 1) * away.norm() : view.z() - hit->distance;
  if (hit->distance <= -ramp) return {};
  if (hit->distance > ramp) return {BlockView::empty, {}};
  return {BlockView::near, *hit};
}

std::size_t ScanView::memory() const {
  std::size_t bytes = image_->points->size() * sizeof(Vector3) + image_->triangles.size() * sizeof(Triangle) +
                      image_->first.size() * sizeof(std::uint32_t) + image_->listed.size() * sizeof(Index);
  for (const Level& level : image_->levels) bytes += level.cells.size() * sizeof(Cell);
  return bytes;
}

}  // namespace meshcomplete
