#include "filter_atomicvolumes/bubbles.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "common/core/counted.h"

namespace meshcomplete {
namespace {

constexpr double full_angle = 4 * 3.14159265358979323846;

struct Bubble {
  Eigen::AlignedBox3d box;
  std::vector<std::array<Vector3, 3>> triangles;
};

// A bubble is closed: the solid angles of its triangles add up to a full angle round a point in it and to
// nothing round any other. Source: van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983.
bool is_in(const Vector3& point, const Bubble& bubble) {
  if (!bubble.box.contains(point)) return false;
  double sum = 0;
  for (const auto& t : bubble.triangles) {
    const Vector3 a = t[0] - point, b = t[1] - point, c = t[2] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(sum) > 0.5 * full_angle;
}

void add_note(const std::vector<Vector3>& points, const std::vector<Bubble>& bubbles, const char* side,
              std::vector<std::string>& notes) {
  std::size_t count = 0;
  for (const Vector3& point : points) {
    int round = 0;
    if (point.allFinite())
      for (const Bubble& bubble : bubbles) round += is_in(point, bubble);
    count += round % 2;  // a bubble in a bubble gives the side of the space round both
  }
  if (count == 0) return;
  const std::string given = std::string(" given as ") + side;
  notes.push_back(
      counted_of(count, points.size(), "point" + given, "points" + given, "is", "are") + " " + side +
      " only within bubbles that touch no rim; as these are not added, nothing follows. Give more "
      "points, between there and the rims.");
}

}  // namespace

std::vector<std::string> describe_bubbles(const std::vector<Sheet>& sheets, const VolumeConstraints& given) {
  std::vector<std::string> notes;
  if (given.inside.empty() && given.outside.empty()) return notes;
  std::vector<Bubble> bubbles;
  for (const Sheet& sheet : sheets) {
    if (!sheet.closes.empty()) continue;
    Bubble& bubble = bubbles.emplace_back();
    for (const SheetVertex& v : sheet.vertices) bubble.box.extend(v.position);
    for (const Triangle& t : sheet.triangles)
      bubble.triangles.push_back(
          {sheet.vertices[t[0]].position, sheet.vertices[t[1]].position, sheet.vertices[t[2]].position});
  }
  add_note(given.inside, bubbles, "inside", notes);
  add_note(given.outside, bubbles, "outside", notes);
  return notes;
}

}  // namespace meshcomplete
