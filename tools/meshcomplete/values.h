// Parameter values: from text to what a filter takes.
#pragma once

#include <QString>
#include <QVariant>
#include <vector>

#include "common/host/runner_host.h"

namespace meshcomplete {
namespace runner {

/// The value of a layer parameter that names no layer, or one that is not loaded yet.
constexpr int no_layer = -1;

/// A declared parameter as the host describes one, without a document: lengths in per cent have no meaning
/// yet, and the default is the one that does not depend on the mesh.
host::HostParameter as_host_parameter(const host::ParameterDeclaration& declaration);

/// "integer", "one of projection, annealing", ...
QString type_in_words(const host::HostParameter& parameter);
/// "0 to 100", "at least 1", or nothing. Of a declared parameter.
QString range_in_words(const host::ParameterDeclaration& declaration);
/// A value as the user would write it.
QString value_in_words(const host::HostParameter& parameter, const QVariant& value);

/// The value that `text` stands for: `2%` for lengths, choices by position or name, layers by position or
/// label. Without `layers` (null), before anything is loaded, every layer will do. `declaration` (may be
/// null) adds the allowed range. Throws UsageError that names the parameter, what is wrong, and what is
/// allowed.
QVariant parse_value(const host::HostParameter& parameter, const host::ParameterDeclaration* declaration,
                     const std::vector<host::LayerInfo>* layers, const QString& text);

}  // namespace runner
}  // namespace meshcomplete
