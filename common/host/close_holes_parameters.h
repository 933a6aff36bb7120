// The parameters that every "Close Holes" filter starts with.
#pragma once

#include <vector>

#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

/// Selected, MaxHoleEdges, MaxHolePerimeter, KeepLargest, NewFaceSelected, AsNewLayer, in this order.
std::vector<ParameterDeclaration> close_holes_parameters();

/// The shared parameters as the core understands them: 0 means "any" in the dialog. Throws CompletionError
/// when a number of edges is given that no hole has.
HoleSelectionOptions hole_selection_options(const ParameterValues& parameters);

}  // namespace host
}  // namespace meshcomplete
