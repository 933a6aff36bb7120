// MeshLab's filter scripts (.mlx).
#pragma once

#include <QString>
#include <vector>

#include "tools/meshcomplete/options.h"

namespace meshcomplete {
namespace runner {

/// The filters of a script with the parameters that it gives, in order. Colours, points and matrices become
/// their numbers separated by spaces. Throws UsageError when the file is not there or not such a script.
std::vector<StepRequest> read_script(const QString& path);

}  // namespace runner
}  // namespace meshcomplete
