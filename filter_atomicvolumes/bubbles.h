// Pieces of the cut's surface that touch no rim: bubbles, which are not added to the mesh.
#pragma once

#include <string>
#include <vector>

#include "common/core/sheets.h"
#include "filter_atomicvolumes/atomic_volumes.h"

namespace meshcomplete {

/// Notes for the user about given points whose side only a bubble gives them: as bubbles are not added, these
/// points end up on the other side. `sheets` are all sheets of one surface. Cost: O(bubbles' triangles) for
/// each point in their bounding box.
std::vector<std::string> describe_bubbles(const std::vector<Sheet>& sheets, const VolumeConstraints& given);

}  // namespace meshcomplete
