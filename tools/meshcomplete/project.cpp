#include "tools/meshcomplete/project.h"

#include <QDir>
#include <QDomDocument>
#include <QFile>
#include <QFileInfo>
#include <QRegularExpression>
#include <QXmlStreamWriter>

#include "tools/meshcomplete/errors.h"

namespace meshcomplete {
namespace runner {

namespace {

std::array<double, 16> matrix_of(const QDomElement& mesh, const QString& path) {
  std::array<double, 16> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const QDomElement element = mesh.firstChildElement("MLMatrix44");
  if (element.isNull()) return matrix;
  const QStringList numbers = element.text().split(QRegularExpression("\\s+"), Qt::SkipEmptyParts);
  bool fine = numbers.size() == 16;
  for (int i = 0; fine && i < 16; ++i) matrix[std::size_t(i)] = numbers[i].toDouble(&fine);
  if (!fine)
    throw UsageError(QString("The project %1, line %2: a transformation is not 16 numbers.")
                         .arg(path, QString::number(element.lineNumber())));
  return matrix;
}

}  // namespace

std::vector<ProjectLayer> read_project(const QString& path, bool& has_rasters) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly))
    throw UsageError(QString("The project %1 cannot be read: %2.").arg(path, file.errorString()));
  QDomDocument document;
  if (!document.setContent(&file) || document.documentElement().tagName() != "MeshLabProject")
    throw UsageError(path + " is not a MeshLab project.");
  const QDomElement root = document.documentElement();
  const QDir folder = QFileInfo(path).absoluteDir();
  std::vector<ProjectLayer> layers;
  const QDomElement group = root.firstChildElement("MeshGroup");
  for (QDomElement mesh = group.firstChildElement("MLMesh"); !mesh.isNull();
       mesh = mesh.nextSiblingElement("MLMesh"))
    layers.push_back({folder.absoluteFilePath(mesh.attribute("filename")), mesh.attribute("label"),
                      matrix_of(mesh, path)});
  has_rasters = !root.firstChildElement("RasterGroup").firstChildElement().isNull();
  return layers;
}

QByteArray project_as_xml(const QString& path, const std::vector<ProjectLayer>& layers) {
  QByteArray bytes;
  QXmlStreamWriter xml(&bytes);
  const QDir folder = QFileInfo(path).absoluteDir();
  xml.setAutoFormatting(true);
  xml.setAutoFormattingIndent(1);
  xml.writeDTD("<!DOCTYPE MeshLabDocument>");
  xml.writeStartElement("MeshLabProject");
  xml.writeStartElement("MeshGroup");
  for (const ProjectLayer& layer : layers) {
    QString matrix = "\n";
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t column = 0; column < 4; ++column)
        matrix += QString::number(layer.transformation[4 * row + column], 'g', 9) + " ";
      matrix += "\n";
    }
    xml.writeStartElement("MLMesh");
    xml.writeAttribute("label", layer.label);
    xml.writeAttribute("filename", folder.relativeFilePath(layer.file));
    xml.writeTextElement("MLMatrix44", matrix);
    xml.writeEndElement();
  }
  xml.writeEndElement();
  xml.writeEmptyElement("RasterGroup");
  xml.writeEndElement();
  xml.writeEndDocument();
  return bytes;
}

}  // namespace runner
}  // namespace meshcomplete
