#include "filter_atomicvolumes/symmetry_registration.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace meshcomplete {
namespace {

// Weight of a sample that slides along the surface: it matches wherever it goes, but on a surface of
// revolution there is nothing else.
constexpr double sliding_weight = 0.05;
// Of two motions that agree equally well the one with more support is taken. Half the support counts as much
// as 16 % of agreement, so that what a hole hides is hardly an argument against a motion.
constexpr double support_exponent = 0.25;
// Added to the diagonal of the normal equations, relative to its mean: directions in which the whole surface
// slides along itself stay where they are, and bumps of a hundredth of the diagonal, with their slopes of a
// tenth, still decide.
constexpr double damping = 1e-5;
// A step that moves images by a thousandth of the usual tolerance changes nothing that can be seen.
constexpr double settled = 1e-5;
// The neighbour in the table bounds the distance of the closest point; rounding to single precision must not
// hide that one.
constexpr double bound_slack = 1.001, bound_margin = 1e-6;
// Within this distance a site of the table stands for its tangent plane. Sites are 0.01 apart, and so are the
// cells of the table: the site of an image that lies on the surface is hardly ever further off.
constexpr double site_reach = 0.03;

// Tukey's biweight of a residual relative to its cut-off.
double biweight(double ratio) {
  const double rest = 1 - ratio * ratio;
  return rest > 0 ? rest * rest : 0;
}

double weight_of(const SymmetryPose& pose, const SurfacePoint& sample) {
  if (pose.kind == SymmetryKind::reflection) return 1;
  const double across = std::abs(sample.normal.dot(direction_of_travel(pose, sample.position)));
  return sliding_weight + (1 - sliding_weight) * across;
}

// The neighbour of an image, and how far off it is.
struct Neighbour {
  SurfacePoint point;
  double distance = 0;
};

// False when there is none within the radius. The table does not know the two sides of a thin plate apart,
// but what it has bounds the search for the closest point.
bool find_neighbour(const SampledSurface& surface, Neighbours neighbours, const Vector3& image,
                    const Vector3& normal, double radius, Neighbour& found) {
  const SurfacePoint& site = surface.rough_neighbour(image);
  const double distance = (site.position - image).norm();
  if (neighbours == Neighbours::exact) {
    const double bound =
        faces_alike(normal, site.normal) ? std::min(radius, bound_slack * distance + bound_margin) : radius;
    if (!surface.closest_facing(image, normal, bound, found.point)) return false;
    found.distance = (found.point.position - image).norm();
    return true;
  }
  found.point = site;
  found.distance = distance < site_reach ? std::abs(site.normal.dot(image - site.position)) : distance;
  return found.distance < radius && (faces_alike(normal, site.normal) || faces_alike(normal, -site.normal));
}

// Whether an image that lies on no known surface could lie on a missing part.
bool tells_nothing(const SampledSurface& surface, SymmetryKind kind, Neighbours neighbours,
                   const Vector3& image, double radius) {
  // A row of repeated parts ends somewhere.
  if (kind == SymmetryKind::translation &&
      (image.cwiseAbs().array() > surface.half_size().array() + radius).any())
    return true;
  if (!surface.has_rim()) return false;
  SurfacePoint nearest = surface.rough_neighbour(image);
  if (neighbours == Neighbours::exact)
    surface.closest(image, bound_slack * (nearest.position - image).norm() + bound_margin, nearest);
  return nearest.on_rim;
}

using Step = PoseFreedom::Step;

// The Gauss-Newton step to the neighbours within the radius; zero when there are none.
Step step_towards_neighbours(const SampledSurface& surface, const SymmetryPose& pose, Neighbours neighbours,
                             double radius, std::size_t stride) {
  const SymmetryMotion motion(pose);
  const PoseFreedom freedom(pose);
  Eigen::Matrix<double, PoseFreedom::most, PoseFreedom::most> equations;
  equations.setZero();
  Step right = Step::Zero();
  Neighbour found;
  for (std::size_t i = 0; i < surface.samples().size(); i += stride) {
    const SurfacePoint& sample = surface.samples()[i];
    const Vector3 image = motion(sample.position), turned = motion.linear * sample.normal;
    if (!find_neighbour(surface, neighbours, image, turned, radius, found)) continue;
    const double weight = biweight(found.distance / radius);
    const double side = found.point.normal.dot(turned) < 0 ? -1 : 1;
    const Vector3 normal = 0.5 * (found.point.normal + side * turned);
    const Step row = freedom.derivatives(sample.position).transpose() * normal;
    equations += weight * row * row.transpose();
    right -= weight * normal.dot(image - found.point.position) * row;
  }
  const double mean = equations.trace() / freedom.count();
  if (!(mean > 0)) return Step::Zero();
  equations.diagonal().array() += damping * mean;
  return equations.ldlt().solve(right);
}

}  // namespace

SymmetryFit fit_of(const SampledSurface& surface, const SymmetryPose& pose, Neighbours neighbours,
                   double radius, std::size_t stride) {
  const SymmetryMotion motion(pose);
  double matched = 0, contradicted = 0, closeness = 0;
  std::size_t on_surface = 0, looked_at = 0;
  Neighbour found;
  for (std::size_t i = 0; i < surface.samples().size(); i += stride) {
    const SurfacePoint& sample = surface.samples()[i];
    const Vector3 image = motion(sample.position);
    const double weight = weight_of(pose, sample);
    ++looked_at;
    if (find_neighbour(surface, neighbours, image, motion.linear * sample.normal, radius, found)) {
      ++on_surface;
      matched += weight;
      closeness += weight * (1 - found.distance * found.distance / (radius * radius));
    } else if (!tells_nothing(surface, pose.kind, neighbours, image, radius)) {
      contradicted += weight;
    }
  }
  SymmetryFit fit;
  if (on_surface == 0) return fit;
  fit.support = static_cast<double>(on_surface) / static_cast<double>(looked_at);
  fit.agreement = matched / (matched + contradicted);
  fit.closeness = closeness / (matched + contradicted);
  fit.score = fit.closeness * std::pow(fit.support, support_exponent);
  return fit;
}

SymmetryPose registered(const SampledSurface& surface, SymmetryPose pose, Neighbours neighbours,
                        const std::vector<double>& radii, std::size_t stride) {
  for (double radius : radii) {
    Step step = step_towards_neighbours(surface, pose, neighbours, radius, stride);
    // Linearised distances mean nothing beyond the radius within which they were taken.
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > radius) step *= radius / longest;
    pose = PoseFreedom(pose).moved(step);
    if (longest < settled && radius == radii.back()) break;
  }
  return pose;
}

}  // namespace meshcomplete
