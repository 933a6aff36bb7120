#include "filter_atomicvolumes/symmetry_hints.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/threads.h"

namespace meshcomplete {
namespace {

// Powers of a rotation, and multiples of a translation each way, that are looked at.
constexpr int most_powers = 36;
constexpr int most_multiples = 8;

// A power of a rotation that moves nothing within the mesh's size by more than this share of it is the
// identity: it has closed.
constexpr double closed_share = 1e-3;

// Half the diagonal of a cube, in sides.
constexpr double half_diagonal = 0.8660254037844386;

// From this size, in finest leaves, a leaf is looked at in parts.
constexpr double large = 4;

// Leaves per task.
constexpr std::size_t grain = 16;

bool is_identity(const Eigen::Isometry3d& motion, const Vector3& middle, double size) {
  double most = 0;
  for (int place = 0; place < 8; ++place) {
    const Vector3 corner =
        middle + 0.5 * size * Vector3(place & 1 ? 1 : -1, place & 2 ? 1 : -1, place & 4 ? 1 : -1);
    most = std::max(most, (motion * corner - corner).norm());
  }
  return most < closed_share * size;
}

}  // namespace

std::vector<Eigen::Isometry3d> images_under(const Symmetry& symmetry, const Vector3& middle, double size) {
  const Eigen::Isometry3d& motion = symmetry.motion;
  std::vector<Eigen::Isometry3d> images;
  Eigen::Isometry3d forward = motion, backward = motion.inverse();
  const bool shifts = symmetry.kind == SymmetryKind::translation;
  for (int power = 1; power <= (shifts ? most_multiples : most_powers / 2); ++power) {
    if (shifts && (forward * middle - middle).norm() > size) break;
    if (is_identity(forward, middle, size)) break;
    images.push_back(forward);
    if (is_identity(forward * backward.inverse(), middle, size)) break;  // both ways meet half-way round
    images.push_back(backward);
    if (is_identity(forward * motion * backward.inverse(), middle, size)) break;
    forward = forward * motion;
    backward = backward * motion.inverse();
  }
  return images;
}

SymmetryHints::SymmetryHints(const SideFinder& sides, const std::vector<Symmetry>& symmetries,
                             const Vector3& middle, double size, double misfit)
    : sides_(sides), misfit_(misfit) {
  for (const Symmetry& symmetry : symmetries) images_.push_back(images_under(symmetry, middle, size));
}

SymmetryHints::Suggestion SymmetryHints::suggest(std::size_t symmetry, const Vector3& point,
                                                 Starts& starts) const {
  const std::vector<Eigen::Isometry3d>& images = images_[symmetry];
  const NearestSide own = sides_.nearest(point, starts.own);
  // Images further off than the point itself tell nothing.
  const double radius = own.inside ? own.distance : own.distance + misfit_;
  starts.images.resize(std::max(starts.images.size(), images.size()), 0);
  NearestSide best;
  double nearest_boundary = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < images.size(); ++i) {
    const NearestSide image = sides_.nearest(images[i] * point, starts.images[i], radius);
    if (!image.inside)
      nearest_boundary = std::min(nearest_boundary, image.distance);
    else if (image.distance < best.distance)
      best = image;
  }
  if (!best.inside || nearest_boundary + misfit_ < best.distance) return {};
  const double weight = own.inside ? std::clamp((own.distance - best.distance) / misfit_, 0.0, 1.0) : 1.0;
  return {*best.inside ? weight : -weight, best.distance};
}

bool SymmetryHints::is_near(std::size_t symmetry, const Vector3& point, double reach, Starts& starts) const {
  const std::vector<Eigen::Isometry3d>& images = images_[symmetry];
  starts.images.resize(std::max(starts.images.size(), images.size()), 0);
  for (std::size_t i = 0; i < images.size(); ++i)
    if (sides_.nearest(images[i] * point, starts.images[i], reach).inside) return true;
  return false;
}

bool SymmetryHints::is_known(std::size_t symmetry, const Vector3& point, double reach, Starts& starts) const {
  const Suggestion suggestion = suggest(symmetry, point, starts);
  return std::abs(suggestion.inside) > 0.5 && suggestion.distance < reach;
}

bool refine_near_images(Decomposition& decomposition, const LatticeMesh& mesh,
                        const DecompositionOptions& options, const SymmetryHints& hints, double finest,
                        std::size_t budget, const Progress& progress) {
  const Octree& octree = decomposition.octree;
  const std::size_t most = octree.size() + budget;
  // Large leaves are looked at in their eight parts too: the mesh may know the middle of one, not its
  // corners.
  const auto is_crossed = [&](Index leaf, SymmetryHints::Starts& starts) {
    const LatticeBox box = octree.box(leaf);
    const Vector3 low = mesh.lattice.position(box.low), high = mesh.lattice.position(box.high);
    const Vector3 middle = 0.5 * (low + high);
    const double side = high[0] - low[0], reach = half_diagonal * side;
    for (std::size_t s = 0; s < hints.symmetries(); ++s) {
      if (!hints.is_near(s, middle, reach, starts)) continue;
      if (hints.is_known(s, middle, reach, starts)) return true;
      if (side <= large * finest) continue;
      for (int part = 0; part < 8; ++part) {
        const Vector3 offset(part & 1 ? 0.25 : -0.25, part & 2 ? 0.25 : -0.25, part & 4 ? 0.25 : -0.25);
        if (hints.is_known(s, middle + side * offset, 0.5 * reach, starts)) return true;
      }
    }
    return false;
  };
  bool any = false;
  std::size_t done = 0;  // cubes looked at
  while (done < octree.size()) {
    std::vector<Index> level;
    for (; done < octree.size(); ++done) {
      const Index leaf = static_cast<Index>(done);
      const double side = static_cast<double>(Octree::side(octree[leaf].depth)) * mesh.lattice.step();
      if (octree.is_leaf(leaf) && decomposition.volumes[leaf].kind == VolumeKind::blank && side > finest)
        level.push_back(leaf);
    }
    std::vector<char> crossed(level.size(), 0);
    for_ranges(level.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
      SymmetryHints::Starts starts;
      for (std::size_t i = begin; i < end; ++i) crossed[i] = is_crossed(level[i], starts);
    });
    std::vector<Index> leaves;
    for (std::size_t i = 0; i < level.size(); ++i)
      if (crossed[i]) leaves.push_back(level[i]);
    if (leaves.empty() || octree.size() + 8 * leaves.size() > most) break;
    if (!split_further(decomposition, mesh, options, leaves, progress)) break;
    any = true;
  }
  return any;
}

}  // namespace meshcomplete
