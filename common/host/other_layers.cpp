#include "common/host/other_layers.h"

#include <Eigen/LU>
#include <cmath>
#include <cstring>

#include "common/core/error.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const stage = "reading other layers";

Vector3 as_vector(const Point3m& p) { return Vector3(p[0], p[1], p[2]); }

std::string quoted(const MeshModel& layer) { return "\"" + layer.label().toStdString() + "\""; }

Eigen::Matrix4d matrix_of(const MeshModel& layer) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix(row, column) = layer.cm.Tr.ElementAt(row, column);
  return matrix;
}

/// From one layer's coordinates to another's.
class Change {
 public:
  Change(const MeshModel& from, const MeshModel& to) {
    const Eigen::Matrix4d source = matrix_of(from), target = matrix_of(to);
    none_ = source == target;
    if (none_) return;
    matrix_ = target.inverse() * source;
    if (!matrix_.allFinite())
      throw CompletionError(stage,
                            "The transformation matrix of the layer " + quoted(to) +
                                " cannot be inverted. Reset it with \"Matrix: Reset Current Matrix\".");
  }

  Vector3 operator()(const Vector3& p) const {
    return none_ ? p : Vector3((matrix_ * p.homogeneous()).hnormalized());
  }

 private:
  bool none_ = false;  ///< coordinates stay exactly as they are
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

}  // namespace

std::vector<Vector3> other_layer_points(const FilterRun& run, const char* parameter) {
  const MeshModel* layer = run.parameters.layer(parameter);
  if (layer == nullptr) return {};
  if (layer == run.document.mm())
    throw CompletionError(stage, "Parameter \"" + std::string(parameter) + "\" names " + quoted(*layer) +
                                     ", the layer that the filter works on. Choose another one, or none.");
  if (layer->cm.vn == 0)
    throw CompletionError(stage, "The layer " + quoted(*layer) + ", chosen as \"" + parameter +
                                     "\", is empty: it has no vertices.");
  return points_of(*layer, Change(*layer, *run.document.mm()));
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
