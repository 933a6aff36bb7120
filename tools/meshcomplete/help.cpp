#include "tools/meshcomplete/help.h"

#include <QTextDocumentFragment>
#include <cmath>

#include "tools/meshcomplete/values.h"

namespace meshcomplete {
namespace runner {

using host::FilterDeclaration;
using host::HostFilter;
using host::HostParameter;
using host::ParameterDeclaration;

namespace {

constexpr int line_width = 100;

/// Breaks text into lines of at most `line_width` characters that start with `indent` spaces.
QString wrapped(const QString& text, int indent) {
  QStringList lines;
  for (const QString& paragraph : text.split('\n')) {
    QString line;
    for (const QString& word : paragraph.simplified().split(' ', Qt::SkipEmptyParts)) {
      if (!line.isEmpty() && indent + line.size() + 1 + word.size() > line_width) {
        lines << QString(indent, ' ') + line;
        line.clear();
      }
      line += (line.isEmpty() ? "" : " ") + word;
    }
    if (!line.isEmpty()) lines << QString(indent, ' ') + line;
  }
  return lines.join('\n');
}

QString plain(const QString& html) {
  // Without markup the text is left alone: fromHtml would join its lines.
  return html.contains('<') ? QTextDocumentFragment::fromHtml(html).toPlainText() : html;
}

QString declared_parameter(const ParameterDeclaration& declaration) {
  const HostParameter parameter = as_host_parameter(declaration);
  QString fallback = declaration.default_in_words;
  if (fallback.isEmpty()) fallback = value_in_words(parameter, declaration.fallback);
  if (fallback.isEmpty()) fallback = "empty";
  QString facts = type_in_words(parameter);
  const QString range = range_in_words(declaration);
  if (!range.isEmpty()) facts += "; " + range;
  if (!declaration.unit.isEmpty()) facts += "; unit: " + declaration.unit;
  facts += "; default: " + fallback;
  return "  " + declaration.name + "\n" + wrapped(facts, 6) + "\n" +
         wrapped(declaration.label + ": " + plain(declaration.meaning), 6);
}

QString foreign_parameter(const HostParameter& parameter) {
  QString facts = type_in_words(parameter);
  if (std::isfinite(parameter.minimum) && parameter.kind == host::ValueKind::real)
    facts += QString("; %1 to %2").arg(parameter.minimum).arg(parameter.maximum);
  const QString fallback = value_in_words(parameter, parameter.value);
  facts += "; default: " + (fallback.isEmpty() ? QString("empty") : fallback);
  if (parameter.kind == host::ValueKind::length) facts += " (depends on the mesh)";
  return "  " + parameter.name + "\n" + wrapped(facts, 6) + "\n" +
         wrapped(parameter.label + ": " + plain(parameter.meaning), 6);
}

}  // namespace

QString help_text() {
  return R"(meshcomplete: runs MeshLab filters on mesh files, without a window and without a display.

  meshcomplete -i IN... -f FILTER [-p NAME=VALUE ...] -o OUT
  meshcomplete -i IN... -s SCRIPT.mlx -o OUT
  meshcomplete --list | --describe FILTER

Reading
  -i FILE...          meshes to read, each becomes a layer; the last one is the current layer
  -p PROJECT.mlp      a MeshLab project to read (without "=" in its name, see -p below)
Filters, run in the order in which they are given
  -f FILTER           a filter by its name in MeshLab's menu
  -p NAME=VALUE       a parameter of the -f before it; those left out have their defaults
  -s SCRIPT.mlx       a filter script saved by MeshLab; parameters left out have their defaults
Writing
  -o FILE             the mesh file to write; the extension chooses the format
    -l LAYER          which layer: a number from 0, c (current, the default) or x (last)
    -m CODE...        which attributes: vc vf vq vn vt vr fc ff fq fn wc wn wt mp, and sa for a text file;
                      without -m: those that the layer's file had, and those that filters have added
  -w PROJECT.mlp [-x] write all layers and a project; meshes get "_out" in their names, unless -x is given
  -l FILE             append the log to a file (when not behind -o)
  --report FILE.json  what became of every hole, times and memory
About filters
  --list              the names of all filters
  --describe FILTER   its parameters: type, default, range and meaning
  -d FILE             write the descriptions of all filters to a file
Other
  --threads N         use at most N threads; results do not depend on it
  --plugins FOLDER    load the plugins in this folder too
  --quiet, -q         print warnings and errors only
  --version, --help

Values: true or false; numbers with a decimal point; lengths in mesh units or in per cent of the bounding box's
diagonal (2%); choices by position from 0 or by name; layers by position from 0 or by name; points as three numbers
("NAME=1 0 -2.5").

Nothing in a mesh changes by being read and written: vertices keep their order and their exact coordinates. One
exception: STL stores every triangle on its own, and vertices at equal positions are merged, as MeshLab does.
Ctrl-C stops, and leaves no half-written files.

Exit code
    0  everything that was asked for was done and saved
    1  a filter failed, or a file is damaged; nothing was written
    2  wrong usage: an unknown option, filter or parameter, or a file that is not there; nothing was done
    3  some holes were left open; the output was written, and the reasons printed
  130  cancelled; nothing was written)";
}

QString list_text(const host::RunnerHost& host) {
  QString text = "Filters of this suite:";
  bool ours = true;
  for (const HostFilter* filter : host.filters()) {
    if (ours && filter->declaration == nullptr) {
      text += "\nFilters of MeshLab " + host::RunnerHost::release() + ":";
      ours = false;
    }
    text += "\n  " + filter->name;
  }
  return text;
}

QString describe_text(host::RunnerHost& host, const HostFilter& filter) {
  QStringList lines = {filter.name, wrapped(plain(filter.description), 2)};
  if (filter.needs_opengl) lines << "  It needs OpenGL, and therefore MeshLab's window.";
  QStringList parameters;
  if (filter.declaration != nullptr) {
    for (const ParameterDeclaration& declaration : filter.declaration->parameters)
      parameters << declared_parameter(declaration);
  } else {
    for (const HostParameter& parameter : host.parameters(filter)) parameters << foreign_parameter(parameter);
  }
  lines << (parameters.isEmpty() ? "Parameters: none" : "Parameters:");
  return (lines + parameters).join('\n');
}

}  // namespace runner
}  // namespace meshcomplete
