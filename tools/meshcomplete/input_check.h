// What is wrong with an input file, found before MeshLab's readers see it.
#pragma once

#include <QString>
#include <QStringList>

namespace meshcomplete {
namespace runner {

/// The file is there, can be read, and is of a known kind. Throws UsageError. `formats` are extensions in lower case.
void check_readable(const QString& path, const QStringList& formats);

/// The contents are whole, as far as MeshLab's readers do not check that themselves: the file is not empty, and an OFF
/// file holds as many vertices and faces as it says, of numbers, with every index in range. Throws Failure.
/// Cost: one pass over an OFF file.
void check_contents(const QString& path);

}  // namespace runner
}  // namespace meshcomplete
