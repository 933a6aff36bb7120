// Small things about MeshLab's layers that several files need.
#pragma once

#include <QString>
#include <string>

#include "common/core/mesh.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {

/// The layer's name in quotation marks, for messages.
inline std::string quoted(const MeshModel& layer) { return "\"" + layer.label().toStdString() + "\""; }

inline Vector3 as_vector(const Point3m& p) { return Vector3(p[0], p[1], p[2]); }

inline Point3m as_point(const Vector3& v) {
  return Point3m(static_cast<Scalarm>(v.x()), static_cast<Scalarm>(v.y()), static_cast<Scalarm>(v.z()));
}

/// A new layer that `fill(MeshModel&)` fills; when that throws, it is taken away again. The current layer
/// stays current.
template <class Fill>
MeshModel& add_layer_with(MeshDocument& document, const QString& name, Fill&& fill) {
  MeshModel* layer = document.addNewMesh("", name, false);
  try {
    fill(*layer);
  } catch (...) {
    document.delMesh(layer);
    throw;
  }
  return *layer;
}

}  // namespace host
}  // namespace meshcomplete
