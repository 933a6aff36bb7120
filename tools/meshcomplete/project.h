// MeshLab projects (.mlp): layers with their transformations.
#pragma once

#include <QByteArray>
#include <QString>
#include <array>
#include <vector>

namespace meshcomplete {
namespace runner {

struct ProjectLayer {
  QString file;  ///< absolute
  QString label;
  std::array<double, 16> transformation;  ///< row by row
};

/// The layers of a project; its photographs are left out, which `has_rasters` tells. Throws UsageError when
/// the file is not there or not a project.
std::vector<ProjectLayer> read_project(const QString& path, bool& has_rasters);

/// A project as it is stored in the file `path`: the layers' files are named relative to it.
QByteArray project_as_xml(const QString& path, const std::vector<ProjectLayer>& layers);

}  // namespace runner
}  // namespace meshcomplete
