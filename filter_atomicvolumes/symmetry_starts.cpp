#include "filter_atomicvolumes/symmetry_starts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

// Over half the sphere: no direction is further than 7 degrees from one of them.
constexpr int direction_count = 256;
constexpr int least_directions = 64;  // none further than 14 degrees
// How far the images of neighbouring starts are apart; registration bridges more.
constexpr double image_step = 0.06;
// A plane further out leaves less than a sixth of the extent on one side: no half of the surface could be
// matched.
constexpr double reach_of_planes = 0.7;
// Of an axis from the middle of the box or of the area: a missing half of a round shape moves the middle by
// 0.15.
constexpr double reach_of_axes = 0.2;

// Principal axes of the area's second moments, then a Fibonacci spiral over half the sphere.
std::vector<Vector3> directions(const SampledSurface& surface, const Vector3& centroid, int count) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const SurfacePoint& sample : surface.samples()) {
    const Vector3 d = sample.position - centroid;
    moments += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
  std::vector<Vector3> list;
  for (int k = 0; k < 3; ++k) list.push_back(solver.eigenvectors().col(k));
  for (int i = 0; i < count; ++i) {
    const double z = (i + 0.5) / count, around = i * pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - z * z);
    list.emplace_back(r * std::cos(around), r * std::sin(around), z);
  }
  return list;
}

Vector3 centroid_of(const SampledSurface& surface) {
  Vector3 sum = Vector3::Zero();
  for (const SurfacePoint& sample : surface.samples()) sum += sample.position;
  return sum / static_cast<double>(surface.samples().size());
}

// Votes of pairs of samples for the translation from one to the other.
class TranslationVotes {
 public:
  explicit TranslationVotes(const SampledSurface& surface);
  std::vector<SymmetryPose> peaks(double least_shift) const;

 private:
  // Samples are this far apart, or somewhat further: a pair that belongs together votes for the right cell or
  // one beside.
  static constexpr double cell = 0.015;
  static constexpr std::size_t voters = 1400;  // a million pairs
  static constexpr std::size_t most_peaks = 3000;
  // What slides along the surface is no evidence, or next to none.
  static constexpr double sliding_weight = 0.05;

  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * size_[1] + static_cast<std::size_t>(y)) * size_[0] +
           static_cast<std::size_t>(x);
  }
  void vote(const Vector3& shift, float weight);
  bool is_peak(int x, int y, int z) const;

  std::array<int, 3> reach_;  // cells from the middle to either side
  std::array<std::size_t, 3> size_;
  std::vector<float> votes_;
};

TranslationVotes::TranslationVotes(const SampledSurface& surface) {
  for (int k = 0; k < 3; ++k) {
    reach_[k] = static_cast<int>(2 * surface.half_size()[k] / cell) + 2;
    size_[k] = static_cast<std::size_t>(2 * reach_[k] + 1);
  }
  votes_.assign(size_[0] * size_[1] * size_[2], 0.0f);
  const std::vector<SurfacePoint>& samples = surface.samples();
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / voters);
  for (std::size_t i = 0; i < samples.size(); i += stride)
    for (std::size_t j = i + stride; j < samples.size(); j += stride) {
      if (!faces_alike(samples[i].normal, samples[j].normal)) continue;
      const Vector3 shift = samples[j].position - samples[i].position;
      const double length = shift.norm();
      if (!(length > cell)) continue;
      const double steep = std::abs((samples[i].normal + samples[j].normal).dot(shift)) / (2 * length);
      const float weight = static_cast<float>(sliding_weight + (1 - sliding_weight) * steep);
      vote(shift, weight);
      vote(-shift, weight);
    }
}

void TranslationVotes::vote(const Vector3& shift, float weight) {
  const auto index = [&](int k) { return static_cast<int>(std::lround(shift[k] / cell)) + reach_[k]; };
  votes_[at(index(0), index(1), index(2))] += weight;
}

bool TranslationVotes::is_peak(int x, int y, int z) const {
  const float here = votes_[at(x, y, z)];
  if (!(here > 0)) return false;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (votes_[at(x + dx, y + dy, z + dz)] > here) return false;
  return true;
}

std::vector<SymmetryPose> TranslationVotes::peaks(double least_shift) const {
  std::vector<std::pair<float, SymmetryPose>> found;
  // The outermost cells, which no pair reaches, spare the neighbours a test; the opposite half holds the
  // same.
  for (int z = reach_[2]; z + 1 < static_cast<int>(size_[2]); ++z)
    for (int y = 1; y + 1 < static_cast<int>(size_[1]); ++y)
      for (int x = 1; x + 1 < static_cast<int>(size_[0]); ++x) {
        SymmetryPose pose;
        pose.kind = SymmetryKind::translation;
        pose.point = cell * Vector3(x - reach_[0], y - reach_[1], z - reach_[2]);
        const Vector3& s = pose.point;
        if (s.z() == 0 && (s.y() < 0 || (s.y() == 0 && s.x() <= 0))) continue;
        if (s.norm() > least_shift && is_peak(x, y, z)) found.emplace_back(votes_[at(x, y, z)], pose);
      }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (found.size() > most_peaks) found.resize(most_peaks);
  std::vector<SymmetryPose> poses;
  for (const auto& [votes, pose] : found) poses.push_back(pose);
  return poses;
}

}  // namespace

std::vector<SymmetryPose> reflection_starts(const SampledSurface& surface) {
  std::vector<SymmetryPose> starts;
  for (const Vector3& n : directions(surface, centroid_of(surface), direction_count)) {
    const double reach = reach_of_planes * n.cwiseAbs().dot(surface.half_size());
    const int steps = static_cast<int>(std::ceil(reach / (0.5 * image_step)));  // images move twice as far
    for (int i = -steps; i <= steps; ++i) {
      SymmetryPose pose;
      pose.direction = n;
      pose.point = reach * i / steps * n;
      starts.push_back(pose);
    }
  }
  return starts;
}

std::vector<SymmetryPose> rotation_starts(const SampledSurface& surface, int highest_fold) {
  std::vector<SymmetryPose> starts;
  const Vector3 centroid = centroid_of(surface);
  const Vector3 middle = 0.5 * centroid;  // between that of the area and that of the box
  for (int fold = 2; fold <= highest_fold; ++fold) {
    // A point at distance 1 from the axis moves by twice this, and images as much less when the axis changes.
    const double sine = std::sin(pi / fold);
    const double step = image_step / (2 * sine);
    const int steps = static_cast<int>(std::ceil(reach_of_axes / step));
    const int axes = std::max(least_directions, static_cast<int>(direction_count * sine * sine));
    for (const Vector3& axis : directions(surface, centroid, axes)) {
      const Vector3 u = axis.unitOrthogonal(), v = axis.cross(u);
      for (int i = -steps; i <= steps; ++i)
        for (int j = -steps; j <= steps; ++j) {
          if (i * i + j * j > steps * steps) continue;
          SymmetryPose pose;
          pose.kind = SymmetryKind::rotation;
          pose.direction = axis;
          pose.point = middle + step * (i * u + j * v);
          pose.fold = fold;
          starts.push_back(pose);
        }
    }
  }
  return starts;
}

std::vector<SymmetryPose> translation_starts(const SampledSurface& surface, double least_shift) {
  return TranslationVotes(surface).peaks(least_shift);
}

}  // namespace meshcomplete
