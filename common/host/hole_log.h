// What became of each hole, as lines for MeshLab's log.
#pragma once

#include <QStringList>

#include "common/core/patch.h"

namespace meshcomplete {
namespace host {

/// One line per hole. When there are many, those that were closed are summed up in one line and the list of
/// the others ends after a hundred lines with a count of the rest. Notes follow, one line with the
/// first hundred faces that a new layer lacks, and one line with all figures. The last line says how many
/// holes were closed.
QStringList describe_holes(const CompletionReport& report);

}  // namespace host
}  // namespace meshcomplete
