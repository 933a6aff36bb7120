// "Close Holes: Triangle Fan" as MeshLab sees it.
#pragma once

#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

FilterDeclaration triangle_fan_filter();

}  // namespace host
}  // namespace meshcomplete
