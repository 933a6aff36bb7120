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

/// Building blocks for further parameters.
ParameterDeclaration switch_parameter(const char* name, const char* label, const char* meaning, bool on);
ParameterDeclaration choice_parameter(const char* name, const char* label, const char* meaning,
                                      QStringList choices, int fallback = 0);
ParameterDeclaration integer_parameter(const char* name, const char* label, const char* meaning,
                                       const char* unit, int fallback, int minimum, int maximum);
/// A number greater than 0.
ParameterDeclaration positive_parameter(const char* name, const char* label, const char* meaning,
                                        const char* unit, double fallback);
ParameterDeclaration length_parameter(const char* name, const char* label, const char* meaning);
ParameterDeclaration point_parameter(const char* name, const char* label, const char* meaning,
                                     const Vector3& fallback);
/// A point whose default is the centre of the current layer's bounding box.
ParameterDeclaration centre_parameter(const char* name, const char* label, const char* meaning);
/// A layer, or none, which is the default.
ParameterDeclaration layer_parameter(const char* name, const char* label, const char* meaning);

}  // namespace host
}  // namespace meshcomplete
