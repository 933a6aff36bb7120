// The one place that knows which release of MeshLab this is built for: headers, names and signatures that
// differ. MESHCOMPLETE_MESHLAB is the release as a number, 202009 for 2020.09; cmake/FindMeshLab.cmake
// defines it.
#pragma once

#if MESHCOMPLETE_MESHLAB < 202100
#include <common/interfaces.h>
#else
#error "This release of MeshLab is not supported; supported: 2020.09."
#endif

#include <common/meshmodel.h>

#include <vector>

namespace meshcomplete {
namespace host {

#if MESHCOMPLETE_MESHLAB < 202100
using PluginInterface = MeshFilterInterface;
using FilterId = MeshFilterInterface::FilterIDType;
using FilterClass = MeshFilterInterface::FilterClass;
using FilterArity = MeshFilterInterface::FILTER_ARITY;
#define MESHCOMPLETE_FILTER_PLUGIN                 \
  Q_PLUGIN_METADATA(IID MESH_FILTER_INTERFACE_IID) \
  Q_INTERFACES(MeshFilterInterface meshcomplete::host::DeclaredFilters)
#endif

}  // namespace host
}  // namespace meshcomplete
