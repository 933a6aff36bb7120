// "Surface Reconstruction: Poisson Delaunay" as MeshLab sees it.
#pragma once

#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

FilterDeclaration remeshing_filter();

}  // namespace host
}  // namespace meshcomplete
