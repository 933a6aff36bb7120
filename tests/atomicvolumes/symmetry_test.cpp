#include "filter_atomicvolumes/symmetry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "common/core/error.h"
#include "filter_atomicvolumes/symmetry_pose.h"
#include "filter_atomicvolumes/symmetry_surface.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

using test::flat_grid;
using test::icosphere;
using test::join;
using test::translated;
using test::without_ball;
using test::without_faces;

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Bump {
  Vector3 at;  // on the unit sphere
  double height;
};

// The unit sphere with bumps, about 0.7 across; 5120 faces.
TriangleMesh bumpy_sphere(const std::vector<Bump>& bumps) {
  TriangleMesh mesh = icosphere(4);
  for (Vector3& p : mesh.vertices) {
    double radius = 1;
    for (const Bump& bump : bumps) radius += bump.height * std::exp(-(p - bump.at).squaredNorm() / 0.12);
    p *= radius;
  }
  return mesh;
}

// No two of them alike, in no particular directions.
const std::vector<Bump> some_bumps = {{Vector3(0.9, 0.3, 0.1).normalized(), 0.5},
                                      {Vector3(0.2, -0.5, 0.8).normalized(), 0.35},
                                      {Vector3(0.5, 0.7, -0.6).normalized(), -0.3}};

std::vector<Bump> mirrored_bumps(const Vector3& normal) {
  std::vector<Bump> bumps = some_bumps;
  for (const Bump& bump : some_bumps)
    bumps.push_back({bump.at - 2 * bump.at.dot(normal) * normal, bump.height});
  return bumps;
}

std::vector<Bump> turned_bumps(const Vector3& axis, int fold) {
  std::vector<Bump> bumps;
  for (int i = 0; i < fold; ++i)
    for (const Bump& bump : some_bumps)
      bumps.push_back({Eigen::AngleAxisd(2 * pi * i / fold, axis) * bump.at, bump.height});
  return bumps;
}

// A sheet of 80 x 30 with `count` hills in a row, `spacing` apart, starting at x = 8.
TriangleMesh row_of_hills(int count, double spacing) {
  TriangleMesh mesh = flat_grid(80, 30);
  for (Vector3& p : mesh.vertices)
    for (int i = 0; i < count; ++i)
      p.z() += 6 * std::exp(-(Vector3(p.x(), p.y(), 0) - Vector3(8 + i * spacing, 13, 0)).squaredNorm() / 12);
  return mesh;
}

TriangleMesh cut_off(const TriangleMesh& mesh, const Vector3& direction, double beyond) {
  return without_faces(mesh, [&](Index f) {
    const Triangle& t = mesh.triangles[f];
    return std::any_of(t.begin(), t.end(), [&](Index v) { return mesh.vertices[v].dot(direction) > beyond; });
  });
}

// A motion without anything special about it, 10 units far.
Eigen::Isometry3d some_pose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(1.1, Vector3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  pose.translation() = Vector3(4, -7, 5);
  return pose;
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3d& pose) {
  for (Vector3& p : mesh.vertices) p = (pose * p).cast<float>().cast<double>();
  return mesh;
}

// How far the images of the mesh's vertices are apart at most, relative to the diagonal.
double apart(const TriangleMesh& mesh, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  double most = 0;
  for (const Vector3& p : mesh.vertices) most = std::max(most, (a * p - b * p).norm());
  return most / bounding_box_diagonal(mesh);
}

std::optional<Symmetry> detect(const TriangleMesh& mesh, SymmetryKind kind) {
  SymmetryDetectionOptions options;
  options.kind = kind;
  return detect_symmetry(mesh, options);
}

// --- given
// -------------------------------------------------------------------------------------------------------

TEST(Symmetry, ReflectionTurnsOverTheNormalAndKeepsThePlane) {
  const Symmetry s = reflection(Vector3(1, 2, 3), Vector3(0, 0, -7));
  EXPECT_EQ(s.kind, SymmetryKind::reflection);
  EXPECT_FALSE(s.support);
  EXPECT_NEAR((s.motion * Vector3(5, 6, 4) - Vector3(5, 6, 2)).norm(), 0, 1e-12);
  EXPECT_NEAR(s.motion.linear().determinant(), -1, 1e-12);
  const Symmetry oblique = reflection(Vector3(1, 2, 3), Vector3(1e-200, 2e-200, -3e-200));
  const Vector3 in_plane = Vector3(1, 2, 3) + Vector3(2, -1, 0);
  EXPECT_NEAR((oblique.motion * in_plane - in_plane).norm(), 0, 1e-12);
  EXPECT_NEAR((oblique.motion * (oblique.motion * Vector3(8, 9, 7)) - Vector3(8, 9, 7)).norm(), 0, 1e-12);
}

TEST(Symmetry, RotationOfAFoldIsTheIdentityAfterThatManyTimes) {
  const Vector3 point(1, -2, 0.5), axis(1, 1, 3);
  for (int fold : {2, 3, 7}) {
    const Symmetry s = rotation(point, axis, fold);
    Eigen::Isometry3d power = Eigen::Isometry3d::Identity();
    for (int i = 0; i < fold; ++i) {
      if (i > 0) {
        EXPECT_GT((power.linear() - Eigen::Matrix3d::Identity()).norm(), 0.1);
      }
      power = s.motion * power;
    }
    EXPECT_NEAR((power.matrix() - Eigen::Matrix4d::Identity()).norm(), 0, 1e-12);
    EXPECT_NEAR((s.motion * (point + 2 * axis) - (point + 2 * axis)).norm(), 0, 1e-12);
  }
  EXPECT_NEAR(
      (rotation(Vector3::Zero(), Vector3::UnitZ(), 4).motion * Vector3::UnitX() - Vector3::UnitY()).norm(), 0,
      1e-12);
}

TEST(Symmetry, RefusesWhatIsNoMotion) {
  EXPECT_THROW(reflection(Vector3::Zero(), Vector3::Zero()), CompletionError);
  EXPECT_THROW(reflection(Vector3(0, 0, infinity), Vector3::UnitX()), CompletionError);
  EXPECT_THROW(rotation(Vector3::Zero(), Vector3::Zero(), 2), CompletionError);
  EXPECT_THROW(rotation(Vector3::Zero(), Vector3::UnitX(), 1), CompletionError);
  EXPECT_THROW(translation(Vector3::Zero()), CompletionError);
  EXPECT_THROW(translation(Vector3(0, infinity, 0)), CompletionError);
}

TEST(Symmetry, IsDescribedInWords) {
  EXPECT_EQ(describe(reflection(Vector3(3, 2, 5), Vector3(0, -2, 0))),
            "reflection in the plane through (0, 2, 0) with normal (0, 1, 0)");
  EXPECT_EQ(describe(rotation(Vector3(1, 2, 5), Vector3(0, 0, -3), 6)),
            "rotation by 60 degrees about the axis through (1, 2, 0) along (0, 0, -1)");
  EXPECT_EQ(describe(rotation(Vector3(1, 2, 5), Vector3(0, 0, -3), 2)),
            "rotation by 180 degrees about the axis through (1, 2, 0) along (0, 0, 1)");
  Symmetry shift = translation(Vector3(0.5, 0, -1.25));
  shift.support = 0.834;
  EXPECT_EQ(describe(shift), "translation by (0.5, 0, -1.25), 83 % of the area matched");
}

// --- parts
// -------------------------------------------------------------------------------------------------------

TEST(SymmetryPose, DerivativesAreThoseOfSmallSteps) {
  SymmetryPose pose;
  pose.direction = Vector3(1, -2, 0.5).normalized();
  pose.point = Vector3(0.3, 0.1, -0.2);
  pose.fold = 5;
  const Vector3 x(0.4, -0.3, 0.7);
  for (SymmetryKind kind : {SymmetryKind::reflection, SymmetryKind::rotation, SymmetryKind::translation}) {
    pose.kind = kind;
    const PoseFreedom freedom(pose);
    const double h = 1e-6;
    for (int k = 0; k < PoseFreedom::most; ++k) {
      PoseFreedom::Step step = PoseFreedom::Step::Zero();
      if (k < freedom.count()) step[k] = h;
      const Vector3 measured =
          (SymmetryMotion(freedom.moved(step))(x) - SymmetryMotion(freedom.moved(-step))(x)) / (2 * h);
      EXPECT_NEAR((measured - freedom.derivatives(x).col(k)).norm(), 0, 1e-8) << "entry " << k;
    }
  }
}

TEST(SampledSurface, FindsTheClosestPointAndKnowsTheRim) {
  const TriangleMesh mesh = flat_grid(10, 10);  // the middle of the box is (5, 5, 0), its diagonal 14.1
  const SampledSurface surface(mesh);
  const auto in_frame = [&](double x, double y, double z) -> Vector3 {
    return (Vector3(x, y, z) - Vector3(5, 5, 0)) / std::sqrt(200.0);
  };
  SurfacePoint found;
  ASSERT_TRUE(surface.closest(in_frame(3.25, 4.5, 2), 1, found));
  EXPECT_NEAR((found.position - in_frame(3.25, 4.5, 0)).norm(), 0, 1e-6);
  EXPECT_FALSE(found.on_rim);
  ASSERT_TRUE(surface.closest(in_frame(12, 4.5, 2), 1, found));
  EXPECT_NEAR((found.position - in_frame(10, 4.5, 0)).norm(), 0, 1e-6);
  EXPECT_TRUE(found.on_rim);
  ASSERT_TRUE(surface.closest(in_frame(12, 13, 0), 1, found));  // a corner of the sheet
  EXPECT_TRUE(found.on_rim);
  EXPECT_FALSE(surface.closest(in_frame(5, 5, 2), 0.1, found));
  EXPECT_TRUE(surface.closest_facing(in_frame(5, 5, 1), Vector3(0.5, 0, 0.8).normalized(), 1, found));
  EXPECT_FALSE(surface.closest_facing(in_frame(5, 5, 1), -Vector3::UnitZ(), 1, found));
}

TEST(SampledSurface, TableKnowsTheNeighbourhoodOfEveryPoint) {
  const TriangleMesh mesh = without_ball(icosphere(4), Vector3::UnitZ(), 0.6);
  const SampledSurface surface(mesh);
  ASSERT_TRUE(surface.has_rim());
  for (const SurfacePoint& sample : surface.samples()) {
    const Vector3 beside = 1.1 * sample.position;
    SurfacePoint nearest;
    ASSERT_TRUE(surface.closest(beside, 1, nearest));
    // Sites are 0.01 apart and cells 0.0125 wide.
    EXPECT_LT((surface.rough_neighbour(beside).position - beside).norm(),
              (nearest.position - beside).norm() + 0.02);
  }
  EXPECT_TRUE(surface.rough_neighbour(Vector3(0, 0, 3)).on_rim);
}

// --- detection
// ---------------------------------------------------------------------------------------------------

TEST(SymmetryDetection, FindsThePlaneOfAMeshWithAQuarterMissing) {
  const Vector3 normal = Vector3(1, 2, -0.5).normalized();
  const TriangleMesh whole = bumpy_sphere(mirrored_bumps(normal));
  // Nearly all that is missing lies on one side.
  const TriangleMesh part = cut_off(whole, (normal + Vector3(0, 0, 0.3)).normalized(), 0.5);
  ASSERT_LT(part.triangles.size(), 0.75 * whole.triangles.size());
  const TriangleMesh mesh = moved(part, some_pose());
  const Symmetry truth = reflection(some_pose() * Vector3::Zero(), some_pose().linear() * normal);
  const std::optional<Symmetry> found = detect(mesh, SymmetryKind::reflection);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, SymmetryKind::reflection);
  EXPECT_LT(apart(mesh, found->motion, truth.motion), 0.003);
  EXPECT_NEAR(found->motion.linear().determinant(), -1, 1e-12);
  // What is missing on one side has no counterpart on the other, and says nothing.
  EXPECT_GT(*found->support, 0.5);
  EXPECT_LT(*found->support, 0.75);
  EXPECT_GT(*found->agreement, 0.97);
}

TEST(SymmetryDetection, FindsAPlaneFarFromTheMiddleOfWhatIsThere) {
  // Two balls of three: the middle is that of the outer and the middle one, the plane goes through the
  // latter.
  const TriangleMesh ball = bumpy_sphere(mirrored_bumps(Vector3::UnitX()));
  const TriangleMesh left = translated(icosphere(4, 0.9), Vector3(-2.5, 0.4, 0)),
                     right =
                         cut_off(translated(icosphere(4, 0.9), Vector3(2.5, 0.4, 0)), Vector3::UnitX(), 2.2);
  const TriangleMesh mesh = moved(join(join(left, ball), right), some_pose());
  const Symmetry truth = reflection(some_pose() * Vector3::Zero(), some_pose().linear() * Vector3::UnitX());
  const std::optional<Symmetry> found = detect(mesh, SymmetryKind::reflection);
  ASSERT_TRUE(found);
  EXPECT_LT(apart(mesh, found->motion, truth.motion), 0.003) << describe(*found);
}

TEST(SymmetryDetection, FindsTheFoldAndTheAxis) {
  const Vector3 axis = Vector3(0.2, 1, 0.4).normalized();
  for (int fold : {2, 3, 6}) {
    const TriangleMesh whole = bumpy_sphere(turned_bumps(axis, fold));
    const TriangleMesh part = cut_off(whole, Vector3(1, 0.2, -0.3).normalized(), 0.6);
    ASSERT_LT(part.triangles.size(), 0.8 * whole.triangles.size());
    const TriangleMesh mesh = moved(part, some_pose());
    SymmetryDetectionOptions options;
    options.kind = SymmetryKind::rotation;
    options.highest_fold = 7;
    const std::optional<Symmetry> found = detect_symmetry(mesh, options);
    ASSERT_TRUE(found) << "fold " << fold;
    const Symmetry truth = rotation(some_pose() * Vector3::Zero(), some_pose().linear() * axis, fold);
    EXPECT_LT(std::min(apart(mesh, found->motion, truth.motion),
                       apart(mesh, found->motion, truth.motion.inverse())),
              0.003)
        << "fold " << fold << ": " << describe(*found);
    EXPECT_GT(*found->agreement, 0.97);
  }
}

TEST(SymmetryDetection, FindsTheAxisOfASurfaceOfRevolution) {
  const TriangleMesh mesh = moved(without_ball(test::torus(64, 32), Vector3(1, 0, 0), 0.7), some_pose());
  SymmetryDetectionOptions options;
  options.kind = SymmetryKind::rotation;
  options.highest_fold = 5;
  const std::optional<Symmetry> found = detect_symmetry(mesh, options);
  ASSERT_TRUE(found);
  // Half a turn about an axis across, too, takes the torus to itself.
  const Vector3 axis = some_pose().linear() * Vector3::UnitZ();
  EXPECT_NEAR(std::abs(axis.dot(found->motion.linear() * axis)), 1, 1e-4);
  EXPECT_GT(*found->agreement, 0.99);
  EXPECT_LT((found->motion * some_pose().translation() - some_pose().translation()).norm(), 0.01);
}

TEST(SymmetryDetection, FindsTheShiftByOnePartOfARow) {
  const double spacing = 13.5;
  const TriangleMesh part = without_ball(row_of_hills(5, spacing), Vector3(8 + spacing, 13, 3), 7);
  const TriangleMesh mesh = moved(part, some_pose());
  const Symmetry truth = translation(some_pose().linear() * Vector3(spacing, 0, 0));
  const std::optional<Symmetry> found = detect(mesh, SymmetryKind::translation);
  ASSERT_TRUE(found);
  EXPECT_LT(
      std::min(apart(mesh, found->motion, truth.motion), apart(mesh, found->motion, truth.motion.inverse())),
      0.003)
      << describe(*found);
  EXPECT_EQ(found->motion.linear(), Eigen::Matrix3d::Identity());
}

TEST(SymmetryDetection, FindsTheShiftBetweenSeparateParts) {
  const TriangleMesh ball = bumpy_sphere(some_bumps);
  const Vector3 shift(2.5, 1, 0.5);
  const TriangleMesh mesh = join(join(ball, translated(ball, shift)), translated(ball, 2 * shift));
  const std::optional<Symmetry> found = detect(mesh, SymmetryKind::translation);
  ASSERT_TRUE(found);
  EXPECT_LT(
      std::min((found->motion.translation() - shift).norm(), (found->motion.translation() + shift).norm()),
      0.02)
      << describe(*found);
  EXPECT_NEAR(*found->support, 2.0 / 3, 0.03);
}

TEST(SymmetryDetection, ReportsNoTranslationThatIsNearlyNone) {
  // Every bit of these matches itself.
  EXPECT_FALSE(detect(icosphere(4), SymmetryKind::translation));
  EXPECT_FALSE(detect(bumpy_sphere(some_bumps), SymmetryKind::translation));
  // The shift by one part is too short here.
  SymmetryDetectionOptions options;
  options.kind = SymmetryKind::translation;
  options.least_shift = 0.2;
  const TriangleMesh mesh = row_of_hills(5, 13.5);
  const std::optional<Symmetry> found = detect_symmetry(mesh, options);
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::abs(found->motion.translation().x()), 27, 0.3) << describe(*found);
}

TEST(SymmetryDetection, FindsNothingWhereThereIsNothing) {
  TriangleMesh mesh = icosphere(4);
  for (Vector3& p : mesh.vertices)
    p *= 1 + 0.2 * std::sin(4 * p.x() + 1) + 0.2 * std::sin(5 * p.y() - 2 * p.z()) +
         0.2 * std::sin(3 * p.z() + 3 * p.x());
  for (SymmetryKind kind : {SymmetryKind::reflection, SymmetryKind::rotation, SymmetryKind::translation}) {
    const std::optional<Symmetry> found = detect(mesh, kind);
    EXPECT_FALSE(found) << describe(*found) << ", agreement " << *found->agreement;
  }
}

TEST(SymmetryDetection, DependsNeitherOnUnitsNorOnNumberingNorOnTheRun) {
  const Vector3 normal = Vector3(1, 2, -0.5).normalized();
  const TriangleMesh mesh = cut_off(bumpy_sphere(mirrored_bumps(normal)), Vector3::UnitZ(), 0.7);
  const std::optional<Symmetry> found = detect(mesh, SymmetryKind::reflection);
  ASSERT_TRUE(found);
  const std::optional<Symmetry> again = detect(mesh, SymmetryKind::reflection);
  ASSERT_TRUE(again);
  EXPECT_EQ(found->motion.matrix(), again->motion.matrix());
  EXPECT_EQ(found->support, again->support);
  const std::optional<Symmetry> small =
      detect(test::scaled(mesh, std::ldexp(1, -20)), SymmetryKind::reflection);
  ASSERT_TRUE(small);
  EXPECT_LT((small->motion.linear() - found->motion.linear()).norm(), 0.001);
  EXPECT_NEAR(*small->support, *found->support, 0.01);
  const std::optional<Symmetry> shuffled = detect(test::shuffled(mesh, 3), SymmetryKind::reflection);
  ASSERT_TRUE(shuffled);
  EXPECT_LT(apart(mesh, found->motion, shuffled->motion), 0.003);
  EXPECT_NEAR(*shuffled->support, *found->support, 0.03);
}

TEST(SymmetryDetection, LeavesOutTrianglesWithoutArea) {
  const Vector3 normal = Vector3(1, 2, -0.5).normalized();
  TriangleMesh mesh = cut_off(bumpy_sphere(mirrored_bumps(normal)), Vector3::UnitZ(), 0.7);
  const Index first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.emplace_back(50, 0, 0);
  mesh.vertices.emplace_back(100, 0, 0);
  mesh.vertices.emplace_back(infinity, 0, 0);
  mesh.triangles.push_back({0, first, first});
  mesh.triangles.push_back({first, first + 1, first});
  mesh.triangles.push_back({0, 1, first + 2});
  const std::optional<Symmetry> found = detect(mesh, SymmetryKind::reflection);
  ASSERT_TRUE(found);
  EXPECT_LT((found->motion.linear() - reflection(Vector3::Zero(), normal).motion.linear()).norm(), 0.01);
}

TEST(SymmetryDetection, RefusesWhatItCannotLookAt) {
  EXPECT_THROW(detect(TriangleMesh(), SymmetryKind::reflection), CompletionError);
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(detect(line, SymmetryKind::rotation), CompletionError);
  const TriangleMesh mesh = icosphere(1);
  const auto refused = [&](const std::function<void(SymmetryDetectionOptions&)>& change) {
    SymmetryDetectionOptions options;
    change(options);
    EXPECT_THROW(detect_symmetry(mesh, options), CompletionError);
  };
  refused([](auto& options) { options.tolerance = 0; });
  refused([](auto& options) { options.tolerance = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& options) { options.least_support = 0; });
  refused([](auto& options) { options.least_agreement = 1.5; });
  refused([](auto& options) { options.highest_fold = 1; });
  refused([](auto& options) { options.least_shift = options.tolerance; });
}

// How often the receiver is called depends on the machine: whenever it asks to stop, the search does.
TEST(SymmetryDetection, CanBeCancelledAtAnyTime) {
  const TriangleMesh mesh = bumpy_sphere(some_bumps);
  for (int calls : {0, 1, 3, 6}) {
    int left = calls;
    bool asked = false, stopped = false;
    SymmetryDetectionOptions options;
    options.kind = SymmetryKind::translation;
    try {
      detect_symmetry(mesh, options, Progress([&](double, const std::string&) {
                        asked = left-- <= 0;
                        return !asked;
                      }));
    } catch (const Cancelled&) {
      stopped = true;
    }
    EXPECT_EQ(asked, stopped) << calls;
    EXPECT_TRUE(asked || calls > 0);
  }
}

TEST(SymmetryDetection, ReportsItsProgress) {
  double last = 0;
  SymmetryDetectionOptions options;
  options.kind = SymmetryKind::translation;
  detect_symmetry(bumpy_sphere(some_bumps), options, Progress([&](double fraction, const std::string&) {
                    EXPECT_GE(fraction, last);
                    last = fraction;
                    return true;
                  }));
  EXPECT_EQ(last, 1);
}

}  // namespace
}  // namespace meshcomplete
