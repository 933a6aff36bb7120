// What is wrong with an input file, found before anything is done.
#pragma once

#include <QString>
#include <QStringList>

namespace meshcomplete {
namespace runner {

/// The file is there, can be read, and is of a known kind. Throws UsageError. `formats` are extensions in
/// lower case.
void check_readable(const QString& path, const QStringList& formats);

}  // namespace runner
}  // namespace meshcomplete
