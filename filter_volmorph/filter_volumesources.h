// "Range Volume: Merge Scans", "... Voxelize Mesh" and "... Open": filters that make a volume.
#pragma once

#include <vector>

#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

std::vector<FilterDeclaration> volume_source_filters();

}  // namespace host
}  // namespace meshcomplete
