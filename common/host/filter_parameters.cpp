#include "common/host/filter_parameters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/core/error.h"

namespace meshcomplete {
namespace host {
namespace {

/// What is wrong with a document is said when the filter runs, and not while MeshLab opens its dialog.
QVariant default_for(const ParameterDeclaration& parameter, const MeshDocument& document) {
  if (!parameter.document_default) return QVariant();
  try {
    return parameter.document_default(document);
  } catch (const CompletionError&) {
    return QVariant();
  }
}

QVariant default_value(const ParameterDeclaration& parameter, const MeshDocument& document) {
  const QVariant value = default_for(parameter, document);
  if (value.isValid()) return value;
  if (parameter.type == ParameterType::layer) return 0;
  return parameter.fallback;
}

QString tooltip(const ParameterDeclaration& parameter) {
  if (parameter.unit.isEmpty()) return parameter.meaning;
  return parameter.meaning + " Unit: " + parameter.unit + ".";
}

/// What a length in the dialog is a percentage of.
float dialog_diagonal(const MeshDocument& document) {
  const MeshModel* mesh = document.mm();
  if (mesh == nullptr || mesh->cm.bbox.IsNull() || !(mesh->cm.bbox.Diag() > 0)) return 1.0f;
  return mesh->cm.bbox.Diag();
}

QStringList layer_choices(const MeshDocument& document) {
  QStringList choices("None");
  for (const MeshModel* layer : document.meshList) choices << layer->label();
  return choices;
}

QVariantList as_numbers(const vcg::Point3f& point) {
  return {double(point[0]), double(point[1]), double(point[2])};
}

vcg::Point3f as_point(const QVariant& numbers) {
  const QVariantList list = numbers.toList();
  return vcg::Point3f(list.value(0).toFloat(), list.value(1).toFloat(), list.value(2).toFloat());
}

/// The value in MeshLab's list, or an invalid QVariant when it is of another kind than declared.
QVariant listed_value(const ParameterDeclaration& parameter, const RichParameter& listed) {
  const Value& value = listed.value();
  switch (parameter.type) {
    case ParameterType::boolean:
      return value.isBool() ? QVariant(value.getBool()) : QVariant();
    case ParameterType::integer:
      return value.isInt() ? QVariant(value.getInt()) : QVariant();
    case ParameterType::real:
      return value.isFloat() ? QVariant(double(value.getFloat())) : QVariant();
    case ParameterType::length:
      return value.isAbsPerc() ? QVariant(double(value.getAbsPerc())) : QVariant();
    case ParameterType::choice:
      return value.isEnum() ? QVariant(value.getEnum()) : QVariant();
    case ParameterType::text:
      return value.isString() ? QVariant(value.getString()) : QVariant();
    case ParameterType::point:
      return value.isPoint3f() ? QVariant(as_numbers(value.getPoint3f())) : QVariant();
    case ParameterType::layer:
      return value.isEnum() ? QVariant(value.getEnum()) : QVariant();
    case ParameterType::open_file:
    case ParameterType::save_file:
      return value.isFileName() ? QVariant(value.getFileName()) : QVariant();
  }
  return QVariant();
}

QString in_words(double value) { return QString::number(value, 'g', 7); }

/// A message when a value is not allowed, else empty.
QString complaint(const ParameterDeclaration& parameter, const QVariant& value,
                  const MeshDocument& document) {
  const bool number = parameter.type == ParameterType::integer || parameter.type == ParameterType::real ||
                      parameter.type == ParameterType::length;
  if (parameter.type == ParameterType::choice) {
    const int position = value.toInt();
    if (position >= 0 && position < parameter.choices.size()) return QString();
    return QString("Parameter \"%1\": %2 is not one of its %3 choices, which are counted from 0.")
        .arg(parameter.name)
        .arg(position)
        .arg(parameter.choices.size());
  }
  if (parameter.type == ParameterType::layer) {
    const int position = value.toInt();
    if (position >= 0 && position <= document.meshList.size()) return QString();
    return QString("Parameter \"%1\": there is no layer %2; layers are counted from 1, and 0 is none.")
        .arg(parameter.name)
        .arg(position);
  }
  if (parameter.type == ParameterType::point) {
    for (const QVariant& number : value.toList())
      if (!std::isfinite(number.toDouble()))
        return QString("Parameter \"%1\" must be three finite numbers.").arg(parameter.name);
  }
  if (!number) return QString();
  const double given = value.toDouble();
  if (!std::isfinite(given)) return QString("Parameter \"%1\" must be a finite number.").arg(parameter.name);
  if (parameter.allows(given)) return QString();
  const QString unit = parameter.unit.isEmpty() ? QString() : " " + parameter.unit;
  if (std::isfinite(parameter.minimum) && std::isfinite(parameter.maximum))
    return QString("Parameter \"%1\" must lie between %2 and %3%4; it is %5.")
        .arg(parameter.name, in_words(parameter.minimum), in_words(parameter.maximum), unit, in_words(given));
  const bool too_small = given <= parameter.minimum;
  return QString("Parameter \"%1\" must be %2 %3%4; it is %5.")
      .arg(parameter.name,
           !too_small                ? "at most"
           : parameter.above_minimum ? "greater than"
                                     : "at least",
           in_words(too_small ? parameter.minimum : parameter.maximum), unit, in_words(given));
}

}  // namespace

void add_parameters(const FilterDeclaration& filter, MeshDocument& document, RichParameterList& list) {
  for (const ParameterDeclaration& parameter : filter.parameters) {
    const QVariant value = default_value(parameter, document);
    const QString& name = parameter.name;
    const QString& label = parameter.label;
    const QString help = tooltip(parameter);
    switch (parameter.type) {
      case ParameterType::boolean:
        list.addParam(RichBool(name, value.toBool(), label, help));
        break;
      case ParameterType::integer:
        list.addParam(RichInt(name, value.toInt(), label, help));
        break;
      case ParameterType::real:
        list.addParam(RichFloat(name, value.toFloat(), label, help));
        break;
      case ParameterType::length:
        list.addParam(RichAbsPerc(name, value.toFloat(), 0.0f, dialog_diagonal(document), label, help));
        break;
      case ParameterType::choice:
        list.addParam(RichEnum(name, value.toInt(), parameter.choices, label, help));
        break;
      case ParameterType::text:
        list.addParam(RichString(name, value.toString(), label, help));
        break;
      case ParameterType::point:
        list.addParam(RichPoint3f(name, as_point(value), label, help));
        break;
      case ParameterType::layer:
        // Not as MeshLab's own kind of parameter, whose list of layers has no entry for none.
        list.addParam(RichEnum(name, value.toInt(), layer_choices(document), label, help));
        break;
      case ParameterType::open_file:
        list.addParam(RichOpenFile(name, value.toString(), parameter.choices, label, help));
        break;
      case ParameterType::save_file:
        list.addParam(RichSaveFile(name, value.toString(), parameter.choices.value(0), label, help));
        break;
    }
  }
}

MeshLabParameterValues::MeshLabParameterValues(const FilterDeclaration& filter, const MeshDocument& document,
                                               const RichParameterList& list)
    : filter_(filter), document_(document) {
  for (const ParameterDeclaration& parameter : filter.parameters) {
    QVariant value = default_value(parameter, document);
    if (list.hasParameter(parameter.name)) {
      value = listed_value(parameter, list.getParameterByName(parameter.name));
      if (!value.isValid())
        throw CompletionError(
            "reading the parameters",
            QString("Parameter \"%1\" has a value of the wrong kind.").arg(parameter.name).toStdString());
    }
    const QString problem = complaint(parameter, value, document);
    if (!problem.isEmpty()) throw CompletionError("reading the parameters", problem.toStdString());
    values_.push_back(value);
  }
}

const QVariant& MeshLabParameterValues::value(const char* name,
                                              std::initializer_list<ParameterType> types) const {
  for (std::size_t i = 0; i < filter_.parameters.size(); ++i) {
    const ParameterDeclaration& parameter = filter_.parameters[i];
    if (parameter.name == QLatin1String(name) &&
        std::find(types.begin(), types.end(), parameter.type) != types.end())
      return values_[i];
  }
  throw std::logic_error(std::string("no parameter of that type is declared with the name ") + name);
}

bool MeshLabParameterValues::boolean(const char* name) const {
  return value(name, {ParameterType::boolean}).toBool();
}

int MeshLabParameterValues::integer(const char* name) const {
  return value(name, {ParameterType::integer}).toInt();
}

double MeshLabParameterValues::real(const char* name) const {
  return value(name, {ParameterType::real, ParameterType::length}).toDouble();
}

int MeshLabParameterValues::choice(const char* name) const {
  return value(name, {ParameterType::choice}).toInt();
}

QString MeshLabParameterValues::text(const char* name) const {
  return value(name, {ParameterType::text, ParameterType::open_file, ParameterType::save_file}).toString();
}

Vector3 MeshLabParameterValues::point(const char* name) const {
  const QVariantList numbers = value(name, {ParameterType::point}).toList();
  return Vector3(numbers.value(0).toDouble(), numbers.value(1).toDouble(), numbers.value(2).toDouble());
}

const MeshModel* MeshLabParameterValues::layer(const char* name) const {
  const int position = value(name, {ParameterType::layer}).toInt();
  return position == 0 ? nullptr : document_.meshList.at(position - 1);
}

}  // namespace host
}  // namespace meshcomplete
