#include "common/core/attributes.h"

#include <Eigen/Geometry>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "common/core/disjoint_sets.h"
#include "common/core/error.h"

namespace meshcomplete {
namespace {

// Bounds of an edge's weight (half the sum of the two opposite angles' cotangents). Positive weights give the
// maximum principle; bounds keep the system well conditioned. 0.05 and 20 are the weights of two angles of 87
// and of 3 degrees.
constexpr double least_weight = 0.05;
constexpr double greatest_weight = 20;

/// The patch with vertices numbered 0, 1, ...: new ones first, then the input vertices that it uses.
struct LocalPatch {
  std::vector<Index> rim;  ///< input vertices, in the order of their first appearance
  std::vector<Triangle> triangles;
  std::vector<Vector3> positions;

  LocalPatch(const TriangleMesh& mesh, const Patch& patch) : positions(patch.vertices) {
    std::unordered_map<Index, Index> number;
    const auto local = [&](Index v) {
      if (v >= patch.input_vertices) return v - patch.input_vertices;
      const auto [place, is_new] = number.try_emplace(v, static_cast<Index>(positions.size()));
      if (is_new) {
        rim.push_back(v);
        positions.push_back(mesh.vertices[v]);
      }
      return place->second;
    };
    for (const auto& [a, b, c] : patch.triangles) triangles.push_back({local(a), local(b), local(c)});
  }
};

/// Cotangent of the angle at `apex`; 0 for a degenerate one.
double cotangent(const Vector3& apex, const Vector3& a, const Vector3& b) {
  const Vector3 u = a - apex, v = b - apex;
  const double sine = u.cross(v).norm();
  return sine > 0 ? u.dot(v) / sine : 0.0;
}

/// The weight of every edge, listed from both ends.
Eigen::SparseMatrix<double> edge_weights(const LocalPatch& patch) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(6 * patch.triangles.size());
  for (const Triangle& t : patch.triangles)
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3], apex = t[(k + 2) % 3];
      const double half = cotangent(patch.positions[apex], patch.positions[a], patch.positions[b]) / 2;
      entries.emplace_back(a, b, half);
      entries.emplace_back(b, a, half);
    }
  const auto n = static_cast<Eigen::Index>(patch.positions.size());
  Eigen::SparseMatrix<double> weights(n, n);
  weights.setFromTriplets(entries.begin(), entries.end());
  for (Eigen::Index i = 0; i < weights.nonZeros(); ++i) {
    double& w = weights.valuePtr()[i];
    w = std::clamp(w, least_weight, greatest_weight);
  }
  return weights;
}

/// Connected pieces of the patch: for every vertex the number of its piece.
std::vector<Index> pieces_of(const LocalPatch& patch) {
  DisjointSets pieces(patch.positions.size());
  for (const auto& [a, b, c] : patch.triangles) {
    pieces.unite(a, b);
    pieces.unite(b, c);
  }
  std::vector<Index> piece(pieces.size());
  for (Index v = 0; v < piece.size(); ++v) piece[v] = pieces.root(v);
  return piece;
}

/// The range of the rim's values by piece and column.
struct Ranges {
  Eigen::MatrixXd low, high;
};

/// Values that are not finite are replaced by the mean of the finite ones of their piece (0 when there are
/// none), so that one bad vertex does not spoil the patch.
Ranges rim_ranges(const std::vector<Index>& piece, Eigen::Index new_vertices, Eigen::MatrixXd& rim_values) {
  const auto pieces = static_cast<Eigen::Index>(piece.size());
  const Eigen::Index columns = rim_values.cols();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Ranges ranges{Eigen::MatrixXd::Constant(pieces, columns, infinity),
                Eigen::MatrixXd::Constant(pieces, columns, -infinity)};
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(pieces, columns), count = sum;
  for (Eigen::Index i = 0; i < rim_values.rows(); ++i)
    for (Eigen::Index c = 0; c < columns; ++c) {
      const Index p = piece[static_cast<std::size_t>(new_vertices + i)];
      const double value = rim_values(i, c);
      if (!std::isfinite(value)) continue;
      sum(p, c) += value;
      count(p, c) += 1;
      ranges.low(p, c) = std::min(ranges.low(p, c), value);
      ranges.high(p, c) = std::max(ranges.high(p, c), value);
    }
  for (Eigen::Index i = 0; i < rim_values.rows(); ++i)
    for (Eigen::Index c = 0; c < columns; ++c) {
      const Index p = piece[static_cast<std::size_t>(new_vertices + i)];
      if (count(p, c) == 0) ranges.low(p, c) = ranges.high(p, c) = 0;
      if (!std::isfinite(rim_values(i, c)))
        rim_values(i, c) = count(p, c) > 0 ? sum(p, c) / count(p, c) : 0.0;
    }
  return ranges;
}

/// Whether the rim of every piece has one value in every column, so that there is nothing to interpolate.
bool one_value_each(const Ranges& ranges, const std::vector<Index>& piece) {
  return std::all_of(piece.begin(), piece.end(), [&](Index p) {
    return (ranges.low.row(p).array() == ranges.high.row(p).array()).all();
  });
}

}  // namespace

Eigen::MatrixXd interpolate_attributes(const TriangleMesh& mesh, const Patch& patch, Eigen::Index columns,
                                       const std::function<Eigen::RowVectorXd(Index)>& rim_value) {
  const LocalPatch local(mesh, patch);
  const auto free = static_cast<Eigen::Index>(patch.vertices.size());
  const auto fixed = static_cast<Eigen::Index>(local.rim.size());
  Eigen::MatrixXd rim_values(fixed, columns);
  for (Eigen::Index i = 0; i < fixed; ++i)
    rim_values.row(i) = rim_value(local.rim[static_cast<std::size_t>(i)]);
  Eigen::MatrixXd values(free, columns);
  if (free == 0 || columns == 0) return values;

  const std::vector<Index> piece = pieces_of(local);
  const Ranges ranges = rim_ranges(piece, free, rim_values);
  std::vector<char> has_rim(piece.size(), 0);
  for (Eigen::Index i = free; i < free + fixed; ++i) has_rim[piece[static_cast<std::size_t>(i)]] = 1;
  for (Eigen::Index i = 0; i < free; ++i)
    if (!has_rim[piece[static_cast<std::size_t>(i)]])
      throw CompletionError("interpolating attributes",
                            "A part of the patch is not connected to the rim of a hole.");

  if (one_value_each(ranges, piece)) {
    for (Eigen::Index v = 0; v < free; ++v)
      values.row(v) = ranges.low.row(piece[static_cast<std::size_t>(v)]);
    return values;
  }

  const Eigen::SparseMatrix<double> weights = edge_weights(local);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(free, columns);
  for (Eigen::Index v = 0; v < free; ++v) {
    double sum = 0;
    for (Eigen::SparseMatrix<double>::InnerIterator w(weights, v); w; ++w) {
      sum += w.value();
      if (w.row() < free)
        entries.emplace_back(v, w.row(), -w.value());
      else
        pull.row(v) += w.value() * rim_values.row(w.row() - free);
    }
    entries.emplace_back(v, v, sum);
  }
  Eigen::SparseMatrix<double> laplacian(free, free);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors(laplacian);
  if (factors.info() != Eigen::Success)
    throw CompletionError("interpolating attributes",
                          "The attributes of the patch could not be interpolated.");
  values = factors.solve(pull);
  // Exactly what the maximum principle says, whatever the rounding.
  for (Eigen::Index v = 0; v < free; ++v)
    for (Eigen::Index c = 0; c < columns; ++c) {
      const Index p = piece[static_cast<std::size_t>(v)];
      values(v, c) = std::clamp(values(v, c), ranges.low(p, c), ranges.high(p, c));
    }
  return values;
}

std::vector<Vector3> patch_vertex_normals(const TriangleMesh& mesh, const Patch& patch) {
  std::vector<Vector3> normals(patch.vertices.size(), Vector3::Zero()), any = normals;
  for (const Triangle& t : patch.triangles) {
    const std::array<Vector3, 3> p = corners(mesh, patch, t);
    const Vector3 across = (p[1] - p[0]).cross(p[2] - p[0]);
    const double length = across.norm();
    if (!(length > 0)) continue;
    const Vector3 normal = across / length;
    for (int k = 0; k < 3; ++k) {
      if (t[k] < patch.input_vertices) continue;
      const Vector3 u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
      normals[t[k] - patch.input_vertices] += std::atan2(length, u.dot(v)) * normal;
      any[t[k] - patch.input_vertices] = normal;
    }
  }
  for (std::size_t v = 0; v < normals.size(); ++v) {
    // Faces folded back on each other cancel out: then any of them will do.
    const double length = normals[v].norm();
    normals[v] = length > 1e-12 ? Vector3(normals[v] / length) : any[v];
    if (normals[v].isZero(0)) normals[v] = Vector3::UnitZ();
  }
  return normals;
}

}  // namespace meshcomplete
