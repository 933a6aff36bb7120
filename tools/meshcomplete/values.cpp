#include "tools/meshcomplete/values.h"

#include <QLocale>
#include <QRegularExpression>
#include <cmath>
#include <limits>

#include "tools/meshcomplete/errors.h"
#include "tools/meshcomplete/suggest.h"

namespace meshcomplete {
namespace runner {

using host::HostParameter;
using host::LayerInfo;
using host::ParameterDeclaration;
using host::ParameterType;
using host::ValueKind;

namespace {

QString number_in_words(double value) { return QString::number(value, 'g', 7); }

ValueKind kind_of(ParameterType type) {
  switch (type) {
    case ParameterType::boolean:
      return ValueKind::boolean;
    case ParameterType::integer:
      return ValueKind::integer;
    case ParameterType::real:
      return ValueKind::real;
    case ParameterType::length:
      return ValueKind::length;
    case ParameterType::choice:
      return ValueKind::choice;
    case ParameterType::text:
      return ValueKind::text;
    case ParameterType::point:
      return ValueKind::numbers;
    case ParameterType::layer:
      return ValueKind::layer_or_none;
    case ParameterType::open_file:
      return ValueKind::open_file;
    case ParameterType::save_file:
      return ValueKind::save_file;
  }
  return ValueKind::unsupported;
}

/// Parses one value; every way to be wrong ends in `wrong`.
class ValueParser {
 public:
  ValueParser(const HostParameter& parameter, const ParameterDeclaration* declaration,
              const std::vector<LayerInfo>* layers, const QString& text)
      : parameter_(parameter),
        declaration_(declaration),
        layers_(layers),
        text_(text.trimmed()),
        exact_(text) {}

  QVariant parse() const {
    switch (parameter_.kind) {
      case ValueKind::boolean:
        return boolean();
      case ValueKind::integer:
        return integer();
      case ValueKind::real:
        return in_range(number(text_));
      case ValueKind::length:
        return length();
      case ValueKind::choice:
        return choice();
      case ValueKind::layer:
        return layer();
      case ValueKind::layer_or_none:
        return text_.compare("none", Qt::CaseInsensitive) == 0 ? no_layer : layer();
      case ValueKind::numbers:
        return numbers();
      case ValueKind::text:
      case ValueKind::open_file:
      case ValueKind::save_file:
        return exact_;
      case ValueKind::unsupported:
        break;
    }
    throw UsageError(QString("Parameter \"%1\" cannot be set here; leave it out to use its default.")
                         .arg(parameter_.name));
  }

 private:
  [[noreturn]] void wrong(const QString& what, const QString& hint = QString()) const {
    QString allowed = type_in_words(parameter_);
    if (declaration_ != nullptr && !range_in_words(*declaration_).isEmpty())
      allowed += ", " + range_in_words(*declaration_);
    throw UsageError(QString("Parameter \"%1\": \"%2\" %3. It takes: %4.%5")
                         .arg(parameter_.name, text_, what, allowed, hint));
  }

  bool boolean() const {
    static const QStringList yes = {"true", "1", "yes", "on"}, no = {"false", "0", "no", "off"};
    const QString lower = text_.toLower();
    if (!yes.contains(lower) && !no.contains(lower)) wrong("is neither true nor false");
    return yes.contains(lower);
  }

  double number(const QString& text) const {
    bool fine = false;
    const double value = QLocale::c().toDouble(text, &fine);
    if (!fine && text.contains(',')) wrong("is not a number", " Write the decimal point as a point.");
    if (!fine) wrong("is not a number");
    // MeshLab hands parameters on as floats.
    if (!std::isfinite(value) || std::abs(value) > double(std::numeric_limits<float>::max()))
      wrong("is too large");
    return value;
  }

  double in_range(double value) const {
    if (declaration_ != nullptr && !declaration_->allows(value)) wrong("is out of range");
    return value;
  }

  int integer() const {
    static const QRegularExpression digits("^[+-]?[0-9]+$");
    if (!digits.match(text_).hasMatch()) wrong("is not a whole number");
    bool fine = false;
    const int value = QLocale::c().toInt(text_, &fine);
    if (!fine) wrong("is too large");
    in_range(value);
    return value;
  }

  double length() const {
    if (!text_.endsWith('%')) return in_range(number(text_));
    const double share = number(text_.left(text_.size() - 1).trimmed()) / 100;
    // Without a document only the form can be checked.
    if (!std::isfinite(parameter_.minimum) || !std::isfinite(parameter_.maximum)) return share;
    return in_range(parameter_.minimum + share * (parameter_.maximum - parameter_.minimum));
  }

  int choice() const {
    bool fine = false;
    const int position = text_.toInt(&fine);
    if (fine && position >= 0 && position < parameter_.choices.size()) return position;
    for (int i = 0; i < parameter_.choices.size(); ++i)
      if (parameter_.choices[i].compare(text_, Qt::CaseInsensitive) == 0) return i;
    // The beginning of a name will do when it is that of one only.
    int found = -1, beginnings = 0;
    for (int i = 0; i < parameter_.choices.size() && !text_.isEmpty(); ++i)
      if (parameter_.choices[i].startsWith(text_, Qt::CaseInsensitive)) {
        found = i;
        ++beginnings;
      }
    if (beginnings == 1) return found;
    wrong("is not one of the choices", fine ? QString() : did_you_mean(text_, parameter_.choices));
  }

  int layer() const {
    bool fine = false;
    const int position = text_.toInt(&fine);
    if (layers_ == nullptr) return no_layer;
    if (fine && position >= 0 && std::size_t(position) < layers_->size()) return position;
    for (std::size_t i = 0; i < layers_->size(); ++i)
      if ((*layers_)[i].label == text_) return int(i);
    wrong(QString("is not a layer; there are %1 layers").arg(layers_->size()), did_you_mean(text_, labels()));
  }

  QStringList labels() const {
    QStringList names;
    for (const LayerInfo& layer : *layers_) names << layer.label;
    return names;
  }

  QVariantList numbers() const {
    static const QRegularExpression separators("[\\s,;]+");
    const QStringList parts = text_.split(separators, Qt::SkipEmptyParts);
    if (parts.size() != parameter_.count)
      wrong(QString("has %1 numbers, not %2").arg(parts.size()).arg(parameter_.count));
    QVariantList values;
    for (const QString& part : parts) values << number(part);
    return values;
  }

  const HostParameter& parameter_;
  const ParameterDeclaration* declaration_;
  const std::vector<LayerInfo>* layers_;
  QString text_;
  QString exact_;
};

}  // namespace

HostParameter as_host_parameter(const ParameterDeclaration& declaration) {
  HostParameter parameter;
  parameter.kind = kind_of(declaration.type);
  parameter.name = declaration.name;
  parameter.label = declaration.label;
  parameter.meaning = declaration.meaning;
  parameter.value = declaration.fallback;
  parameter.choices = declaration.choices;
  if (declaration.type == ParameterType::point) parameter.count = 3;
  return parameter;
}

QString type_in_words(const HostParameter& parameter) {
  switch (parameter.kind) {
    case ValueKind::boolean:
      return "true or false";
    case ValueKind::integer:
      return "whole number";
    case ValueKind::real:
      return "number";
    case ValueKind::length:
      return "length in mesh units, or per cent of the diagonal (2%)";
    case ValueKind::choice: {
      QStringList numbered;
      for (int i = 0; i < parameter.choices.size(); ++i)
        numbered << QString("%1 = %2").arg(i).arg(parameter.choices[i]);
      return "one of " + numbered.join(", ");
    }
    case ValueKind::text:
      return "text";
    case ValueKind::layer:
      return "layer, counted from 0, or its name";
    case ValueKind::layer_or_none:
      return "none, or a layer, counted from 0, or its name";
    case ValueKind::open_file:
      return "file to read";
    case ValueKind::save_file:
      return "file to write";
    case ValueKind::numbers:
      return QString("%1 numbers").arg(parameter.count);
    case ValueKind::unsupported:
      break;
  }
  return "cannot be set here";
}

QString range_in_words(const ParameterDeclaration& declaration) {
  if (declaration.type == ParameterType::choice) return QString();
  // The largest int stands for "no limit".
  const bool low = std::isfinite(declaration.minimum);
  const bool high =
      std::isfinite(declaration.maximum) && declaration.maximum < std::numeric_limits<int>::max();
  if (low && high) {
    const QString from = number_in_words(declaration.minimum), to = number_in_words(declaration.maximum);
    return declaration.above_minimum ? "above " + from + ", up to " + to : from + " to " + to;
  }
  if (low)
    return (declaration.above_minimum ? "greater than " : "at least ") + number_in_words(declaration.minimum);
  if (high) return "at most " + number_in_words(declaration.maximum);
  return QString();
}

QString value_in_words(const HostParameter& parameter, const QVariant& value) {
  switch (parameter.kind) {
    case ValueKind::boolean:
      return value.toBool() ? "true" : "false";
    case ValueKind::integer:
      return QString::number(value.toInt());
    case ValueKind::layer:
      return QString::number(value.toInt());
    case ValueKind::layer_or_none:
      return value.toInt() == no_layer ? "none" : QString::number(value.toInt());
    case ValueKind::real:
    case ValueKind::length:
      return number_in_words(value.toDouble());
    case ValueKind::choice:
      return parameter.choices.value(value.toInt(), QString::number(value.toInt()));
    case ValueKind::numbers: {
      QStringList parts;
      for (const QVariant& number : value.toList()) parts << number_in_words(number.toDouble());
      return parts.join(' ');
    }
    case ValueKind::text:
    case ValueKind::open_file:
    case ValueKind::save_file:
      return value.toString();
    case ValueKind::unsupported:
      break;
  }
  return QString();
}

QVariant parse_value(const HostParameter& parameter, const ParameterDeclaration* declaration,
                     const std::vector<LayerInfo>* layers, const QString& text) {
  return ValueParser(parameter, declaration, layers, text).parse();
}

}  // namespace runner
}  // namespace meshcomplete
