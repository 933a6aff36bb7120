// Exact coordinates in text files.
#pragma once

#include <QString>

#include "common/host/runner_host.h"

namespace meshcomplete {
namespace runner {

/// MeshLab writes text formats with six or seven digits, which moves vertices; a float needs up to nine. Puts
/// the shortest numbers that read back as exactly the same floats in the places of the coordinates, and
/// leaves all else as it is. Knows OFF, OBJ, and PLY and STL in their text form (binary ones need nothing).
/// Returns a warning when the file is of another kind, and may therefore hold rounded coordinates. Cost: one
/// pass over the file. Throws Failure when the file cannot be rewritten.
QString restore_coordinates(const QString& path, const host::LayerGeometry& geometry, bool binary);

}  // namespace runner
}  // namespace meshcomplete
