#include "tools/meshcomplete/script.h"

#include <QDomDocument>
#include <QFile>

#include "tools/meshcomplete/errors.h"

namespace meshcomplete {
namespace runner {

namespace {

/// The value of a <Param>: one attribute, or the several that MeshLab writes for colours, points and
/// matrices.
QString value_of(const QDomElement& element) {
  if (element.hasAttribute("value")) return element.attribute("value");
  QStringList names;
  if (element.hasAttribute("r"))
    names << "r"
          << "g"
          << "b"
          << "a";
  if (element.hasAttribute("x"))
    names << "x"
          << "y"
          << "z";
  if (element.hasAttribute("val0"))
    for (int i = 0; i < 16; ++i) names << QString("val%1").arg(i);
  QStringList values;
  for (const QString& name : names) values << element.attribute(name);
  return values.join(' ');
}

StepRequest read_filter(const QDomElement& element, const QString& path) {
  StepRequest step;
  step.name = element.attribute("name");
  if (step.name.isEmpty())
    throw UsageError(QString("Script %1, line %2: a filter has no name.")
                         .arg(path, QString::number(element.lineNumber())));
  for (QDomElement child = element.firstChildElement(); !child.isNull(); child = child.nextSiblingElement()) {
    if (child.tagName() != "Param")
      throw UsageError(QString("Script %1, line %2: <%3> is not known inside a filter.")
                           .arg(path, QString::number(child.lineNumber()), child.tagName()));
    const QString name = child.attribute("name");
    if (name.isEmpty())
      throw UsageError(QString("Script %1, line %2: a parameter has no name.")
                           .arg(path, QString::number(child.lineNumber())));
    step.parameters.emplace_back(name, value_of(child));
  }
  return step;
}

}  // namespace

std::vector<StepRequest> read_script(const QString& path) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly))
    throw UsageError(QString("The script %1 cannot be read: %2.").arg(path, file.errorString()));
  QDomDocument document;
  QString message;
  int line = 0, column = 0;
  if (!document.setContent(&file, &message, &line, &column))
    throw UsageError(QString("The script %1 is not XML: line %2, column %3: %4.")
                         .arg(path, QString::number(line), QString::number(column), message));
  const QDomElement root = document.documentElement();
  if (root.tagName() != "FilterScript")
    throw UsageError(QString("%1 is not a MeshLab filter script: it starts with <%2>, not <FilterScript>.")
                         .arg(path, root.tagName()));
  std::vector<StepRequest> steps;
  for (QDomElement child = root.firstChildElement(); !child.isNull(); child = child.nextSiblingElement()) {
    if (child.tagName() != "filter")
      throw UsageError(QString("Script %1, line %2: <%3> is not a filter that this program can run.")
                           .arg(path, QString::number(child.lineNumber()), child.tagName()));
    steps.push_back(read_filter(child, path));
  }
  if (steps.empty()) throw UsageError(QString("The script %1 has no filters in it.").arg(path));
  return steps;
}

}  // namespace runner
}  // namespace meshcomplete
