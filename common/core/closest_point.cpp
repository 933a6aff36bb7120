#include "common/core/closest_point.h"

namespace meshcomplete {

ClosestPoint closest_point(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
               d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {a, ClosestPoint::corner};
  if (d3 >= 0 && d4 <= d3) return {b, ClosestPoint::corner + 1};
  if (d6 >= 0 && d5 <= d6) return {c, ClosestPoint::corner + 2};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, ClosestPoint::edge};
  if (va <= 0 && d4 >= d3 && d5 >= d6)
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), ClosestPoint::edge + 1};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, ClosestPoint::edge + 2};
  const double total = va + vb + vc;
  return {a + vb / total * ab + vc / total * ac, ClosestPoint::face};
}

}  // namespace meshcomplete
