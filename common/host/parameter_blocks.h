// Declarations of single parameters, by what they hold.
#pragma once

#include <QStringList>

#include "common/core/mesh.h"
#include "common/host/filter_declaration.h"

namespace meshcomplete {
namespace host {

ParameterDeclaration switch_parameter(const char* name, const char* label, const char* meaning, bool on);
ParameterDeclaration choice_parameter(const char* name, const char* label, const char* meaning,
                                      QStringList choices, int fallback = 0);
ParameterDeclaration integer_parameter(const char* name, const char* label, const char* meaning,
                                       const char* unit, int fallback, int minimum, int maximum);
/// A number greater than 0.
ParameterDeclaration positive_parameter(const char* name, const char* label, const char* meaning,
                                        const char* unit, double fallback);
/// A number of at least 0.
ParameterDeclaration at_least_zero_parameter(const char* name, const char* label, const char* meaning,
                                             double fallback);
/// Above 0, at most 90 degrees.
ParameterDeclaration angle_parameter(const char* name, const char* label, const char* meaning,
                                     double fallback);
/// In mesh units, at least 0, which is the default.
ParameterDeclaration length_parameter(const char* name, const char* label, const char* meaning);
ParameterDeclaration point_parameter(const char* name, const char* label, const char* meaning,
                                     const Vector3& fallback);
/// A point whose default is the centre of the current layer's bounding box.
ParameterDeclaration centre_parameter(const char* name, const char* label, const char* meaning);
/// A layer, or none, which is the default.
ParameterDeclaration layer_parameter(const char* name, const char* label, const char* meaning);
ParameterDeclaration text_parameter(const char* name, const char* label, const char* meaning,
                                    const char* fallback);
/// A file to read or to write, or a folder, as `type` says; none by default.
ParameterDeclaration file_parameter(const char* name, const char* label, const char* meaning,
                                    ParameterType type);

}  // namespace host
}  // namespace meshcomplete
