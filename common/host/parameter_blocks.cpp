#include "common/host/parameter_blocks.h"

#include <utility>

#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {
namespace {

ParameterDeclaration parameter(ParameterType type, const char* name, const char* label, const char* meaning,
                               const QVariant& fallback = QVariant()) {
  ParameterDeclaration result;
  result.type = type;
  result.name = name;
  result.label = label;
  result.meaning = meaning;
  result.fallback = fallback;
  return result;
}

}  // namespace

ParameterDeclaration switch_parameter(const char* name, const char* label, const char* meaning, bool on) {
  return parameter(ParameterType::boolean, name, label, meaning, on);
}

ParameterDeclaration choice_parameter(const char* name, const char* label, const char* meaning,
                                      QStringList choices, int fallback) {
  ParameterDeclaration result = parameter(ParameterType::choice, name, label, meaning, fallback);
  result.minimum = 0;
  result.maximum = static_cast<double>(choices.size() - 1);
  result.choices = std::move(choices);
  return result;
}

ParameterDeclaration integer_parameter(const char* name, const char* label, const char* meaning,
                                       const char* unit, int fallback, int minimum, int maximum) {
  ParameterDeclaration result = parameter(ParameterType::integer, name, label, meaning, fallback);
  result.unit = unit;
  result.minimum = minimum;
  result.maximum = maximum;
  return result;
}

ParameterDeclaration length_parameter(const char* name, const char* label, const char* meaning) {
  ParameterDeclaration result = parameter(ParameterType::length, name, label, meaning, 0.0);
  result.unit = "mesh units";
  result.minimum = 0;
  return result;
}

ParameterDeclaration positive_parameter(const char* name, const char* label, const char* meaning,
                                        const char* unit, double fallback) {
  ParameterDeclaration result = parameter(ParameterType::real, name, label, meaning, fallback);
  result.unit = unit;
  result.minimum = 0;
  result.above_minimum = true;
  return result;
}

ParameterDeclaration at_least_zero_parameter(const char* name, const char* label, const char* meaning,
                                             double fallback) {
  ParameterDeclaration result = parameter(ParameterType::real, name, label, meaning, fallback);
  result.minimum = 0;
  return result;
}

ParameterDeclaration angle_parameter(const char* name, const char* label, const char* meaning,
                                     double fallback) {
  ParameterDeclaration result = positive_parameter(name, label, meaning, "degrees", fallback);
  result.maximum = 90;
  return result;
}

ParameterDeclaration text_parameter(const char* name, const char* label, const char* meaning,
                                    const char* fallback) {
  return parameter(ParameterType::text, name, label, meaning, QString(fallback));
}

ParameterDeclaration file_parameter(const char* name, const char* label, const char* meaning,
                                    ParameterType type) {
  return parameter(type, name, label, meaning, QString());
}

ParameterDeclaration point_parameter(const char* name, const char* label, const char* meaning,
                                     const Vector3& fallback) {
  ParameterDeclaration result = parameter(ParameterType::point, name, label, meaning);
  result.fallback = QVariantList{fallback.x(), fallback.y(), fallback.z()};
  return result;
}

ParameterDeclaration centre_parameter(const char* name, const char* label, const char* meaning) {
  ParameterDeclaration result = point_parameter(name, label, meaning, Vector3::Zero());
  result.document_default = [](const MeshDocument& document) {
    const MeshModel* model = document.mm();
    if (model == nullptr || model->cm.bbox.IsNull()) return QVariant();
    const Point3m centre = model->cm.bbox.Center();
    return QVariant(QVariantList{double(centre[0]), double(centre[1]), double(centre[2])});
  };
  result.default_in_words = "the centre of the bounding box";
  return result;
}

ParameterDeclaration layer_parameter(const char* name, const char* label, const char* meaning) {
  ParameterDeclaration result = parameter(ParameterType::layer, name, label, meaning);
  result.default_in_words = "none";
  return result;
}

}  // namespace host
}  // namespace meshcomplete
