#include "tools/meshcomplete/input_check.h"

#include <unistd.h>

#include <QFile>
#include <QFileInfo>

#include "tools/meshcomplete/errors.h"
#include "tools/meshcomplete/suggest.h"

namespace meshcomplete {
namespace runner {

void check_readable(const QString& path, const QStringList& formats) {
  const QFileInfo file(path);
  if (!file.exists()) throw UsageError("There is no file " + path + ".");
  if (file.isDir()) throw UsageError(path + " is a folder, not a mesh file.");
  if (access(QFile::encodeName(path).constData(), R_OK) != 0)
    throw UsageError("There is no permission to read " + path + ".");
  const QString extension = file.suffix().toLower();
  if (!formats.contains(extension))
    throw UsageError(QString("MeshLab does not read files like %1. It reads: %2.%3")
                         .arg(path, formats.join(' '), did_you_mean(extension, formats)));
}

}  // namespace runner
}  // namespace meshcomplete
