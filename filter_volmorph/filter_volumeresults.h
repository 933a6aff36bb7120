// "Range Volume: Extract Surface", "... Slice" and "... Save": what comes out of a volume.
#pragma once

#include <vector>

#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

std::vector<FilterDeclaration> volume_result_filters();

}  // namespace host
}  // namespace meshcomplete
