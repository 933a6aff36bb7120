// "Range Volume: Morphology" and "... Fill": filters that change a volume.
#pragma once

#include <vector>

#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

std::vector<FilterDeclaration> volume_change_filters();

}  // namespace host
}  // namespace meshcomplete
