#include "common/host/other_layers.h"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "common/core/error.h"
#include "common/host/layers.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const stage = "reading other layers";

Eigen::Matrix4d matrix_of(const MeshModel& layer) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix(row, column) = layer.cm.Tr.ElementAt(row, column);
  return matrix;
}

/// From one layer's coordinates to another's, or to the project's.
class Change {
 public:
  explicit Change(const MeshModel& from)
      : none_(matrix_of(from) == Eigen::Matrix4d::Identity()),
        mirrors_(matrix_of(from).topLeftCorner<3, 3>().determinant() < 0),
        matrix_(matrix_of(from)) {}
  Change(const MeshModel& from, const MeshModel& to) {
    const Eigen::Matrix4d source = matrix_of(from), target = matrix_of(to);
    none_ = source == target;
    if (none_) return;
    matrix_ = target.inverse() * source;
    mirrors_ = matrix_.topLeftCorner<3, 3>().determinant() < 0;
    if (!matrix_.allFinite())
      throw CompletionError(stage,
                            "The transformation matrix of the layer " + quoted(to) +
                                " cannot be inverted. Reset it with \"Matrix: Reset Current Matrix\".");
  }

  Vector3 operator()(const Vector3& p) const {
    return none_ ? p : Vector3((matrix_ * p.homogeneous()).hnormalized());
  }
  Vector3 normal(const Vector3& n) const {
    return none_ ? n : Vector3(matrix_.topLeftCorner<3, 3>().inverse().transpose() * n);
  }
  bool mirrors() const { return mirrors_; }

 private:
  bool none_ = false;  ///< coordinates stay exactly as they are
  bool mirrors_ = false;
  Eigen::Matrix4d matrix_ = Eigen::Matrix4d::Identity();
};

std::vector<Vector3> points_of(const MeshModel& layer, const Change& change) {
  std::vector<Vector3> points;
  points.reserve(layer.cm.vert.size());
  for (const CVertexO& vertex : layer.cm.vert) {
    if (vertex.IsD()) continue;
    points.push_back(change(as_vector(vertex.cP())));
    if (!points.back().allFinite())
      throw CompletionError(stage, "The layer " + quoted(layer) +
                                       " has vertices with coordinates that are infinite or not numbers.");
  }
  return points;
}

// The layer that a parameter names, or null; it may be neither the current one nor empty.
const MeshModel* other_layer(const FilterRun& run, const char* parameter) {
  const MeshModel* layer = run.parameters.layer(parameter);
  if (layer == nullptr) return nullptr;
  if (layer == run.document.mm())
    throw CompletionError(stage, "Parameter \"" + std::string(parameter) + "\" names " + quoted(*layer) +
                                     ", the layer that the filter works on. Choose another one, or none.");
  if (layer->cm.vn == 0)
    throw CompletionError(stage, "The layer " + quoted(*layer) + ", chosen as \"" + parameter +
                                     "\", is empty: it has no vertices.");
  return layer;
}

// The vertices in use, in order, so that their numbers fit those of `points_of`.
std::vector<Vector3> normals_of(const MeshModel& layer, const Change& change) {
  std::vector<Vector3> normals;
  for (const CVertexO& vertex : layer.cm.vert) {
    if (vertex.IsD()) continue;
    normals.push_back(change.normal(as_vector(vertex.cN())));
    if (!normals.back().allFinite() || normals.back().isZero(0))
      throw CompletionError(stage, "The layer " + quoted(layer) +
                                       " is a point set with points that have no normals. Apply \"Compute "
                                       "normals for point sets\" to it.");
  }
  return normals;
}

}  // namespace

std::vector<Vector3> other_layer_points(const FilterRun& run, const char* parameter) {
  const MeshModel* layer = other_layer(run, parameter);
  if (layer == nullptr) return {};
  return points_of(*layer, Change(*layer, *run.document.mm()));
}

namespace {

LayerSurface changed_surface(const MeshModel& layer, const Change& change) {
  LayerSurface surface;
  std::vector<Vector3> points = points_of(layer, change);
  if (layer.cm.fn == 0) {
    surface.points = std::move(points);
    surface.normals = normals_of(layer, change);
    if (surface.points.empty())
      throw CompletionError(stage, "The layer " + quoted(layer) + " is empty: it has no vertices.");
    return surface;
  }
  std::vector<Index> number(layer.cm.vert.size(), 0);
  Index count = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (!layer.cm.vert[v].IsD()) number[v] = count++;
  for (const CFaceO& face : layer.cm.face) {
    if (face.IsD()) continue;
    Triangle t;
    for (int k = 0; k < 3; ++k) t[k] = number[vcg::tri::Index(layer.cm, face.cV(k))];
    if (change.mirrors()) std::swap(t[1], t[2]);
    surface.mesh.triangles.push_back(t);
  }
  surface.mesh.vertices = std::move(points);
  return surface;
}

}  // namespace

LayerSurface layer_surface(const MeshModel& layer, const MeshModel& in) {
  return changed_surface(layer, Change(layer, in));
}

LayerSurface layer_surface(const MeshModel& layer) { return changed_surface(layer, Change(layer)); }

Vector3 point_in_project(const MeshModel& layer, const Vector3& point) { return Change(layer)(point); }

Vector3 direction_in_project(const MeshModel& layer, const Vector3& direction) {
  return matrix_of(layer).topLeftCorner<3, 3>() * direction;
}

LayerSurface other_layer_surface(const FilterRun& run, const char* parameter) {
  const MeshModel* layer = other_layer(run, parameter);
  return layer == nullptr ? LayerSurface() : layer_surface(*layer, *run.document.mm());
}

std::vector<std::pair<QString, LayerSurface>> visible_layer_surfaces(const FilterRun& run,
                                                                     const MeshModel* left_out) {
  std::vector<std::pair<QString, LayerSurface>> surfaces;
  for (const MeshModel* layer : run.document.meshList)
    if (layer != run.document.mm() && layer != left_out && layer->visible && layer->cm.vn > 0)
      surfaces.emplace_back(layer->label(), layer_surface(*layer, *run.document.mm()));
  return surfaces;
}

void refuse_shared_layers(const FilterRun& run, const std::vector<const char*>& parameters) {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const MeshModel* layer = run.parameters.layer(parameters[i]);
      if (layer != nullptr && layer == run.parameters.layer(parameters[j]))
        throw CompletionError(stage, "The layer " + quoted(*layer) + " is chosen twice, as \"" +
                                         parameters[j] + "\" and as \"" + parameters[i] + "\".");
    }
}

std::vector<LayerView> layer_views(const FilterRun& run) {
  std::vector<LayerView> views;
  for (const MeshModel* layer : run.document.meshList) {
    if (layer == run.document.mm() || !layer->visible || !layer->cm.shot.IsValid() || layer->cm.vn == 0)
      continue;
    const Change change(*layer, *run.document.mm());
    LayerView view;
    view.layer = layer->label();
    view.from = change(as_vector(layer->cm.shot.GetViewPoint()));
    if (!view.from.allFinite())
      throw CompletionError(stage, "The camera of the layer " + quoted(*layer) + " has no finite position.");
    view.seen = points_of(*layer, change);
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace host
}  // namespace meshcomplete
