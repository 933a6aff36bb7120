// The parameters of a loaded filter, and running it.
#include <common/filter_parameter/rich_parameter_list.h>
#include <vcg/complex/algorithms/clean.h>
#include <vcg/complex/algorithms/create/platonic.h>
#include <vcg/complex/algorithms/update/selection.h>

#include <QMetaObject>

#include "common/host/runner_host.h"
#include "common/host/runner_state.h"

namespace meshcomplete {
namespace host {

namespace {

QVariantList numbers_of(const Value& value) {
  QVariantList numbers;
  if (value.isColor()) {
    const QColor colour = value.getColor();
    numbers << colour.red() << colour.green() << colour.blue() << colour.alpha();
  } else if (value.isPoint3f()) {
    const vcg::Point3f point = value.getPoint3f();
    for (int axis = 0; axis < 3; ++axis) numbers << double(point[axis]);
  } else if (value.isMatrix44f()) {
    const vcg::Matrix44f matrix = value.getMatrix44f();
    for (int entry = 0; entry < 16; ++entry) numbers << double(matrix.V()[entry]);
  }
  return numbers;
}

int position_of(const MeshDocument& document, const MeshModel* mesh) {
  for (int layer = 0; layer < document.meshList.size(); ++layer)
    if (document.meshList[layer] == mesh) return layer;
  return -1;
}

void fill_ranged(HostParameter& out, ValueKind kind, double value, double minimum, double maximum) {
  out.kind = kind;
  out.value = value;
  out.minimum = minimum;
  out.maximum = maximum;
}

HostParameter describe(const RichParameter& parameter, const MeshDocument& document) {
  HostParameter out;
  out.name = parameter.name();
  out.label = parameter.fieldDescription();
  out.meaning = parameter.toolTip();
  const Value& value = parameter.value();
  const auto simple = [&out](ValueKind kind, const QVariant& held) {
    out.kind = kind;
    out.value = held;
  };
  // The derived kinds come first: an AbsPerc is also a Float, an Enum also an Int.
  if (const auto* length = dynamic_cast<const RichAbsPerc*>(&parameter)) {
    fill_ranged(out, ValueKind::length, value.getAbsPerc(), length->min, length->max);
  } else if (const auto* slider = dynamic_cast<const RichDynamicFloat*>(&parameter)) {
    fill_ranged(out, ValueKind::real, value.getDynamicFloat(), slider->min, slider->max);
  } else if (const auto* choice = dynamic_cast<const RichEnum*>(&parameter)) {
    simple(ValueKind::choice, value.getEnum());
    out.choices = choice->enumvalues;
  } else if (dynamic_cast<const RichOpenFile*>(&parameter) != nullptr) {
    simple(ValueKind::open_file, value.getFileName());
  } else if (dynamic_cast<const RichSaveFile*>(&parameter) != nullptr) {
    simple(ValueKind::save_file, value.getFileName());
  } else if (value.isMesh()) {
    simple(ValueKind::layer, position_of(document, value.getMesh()));
  } else if (value.isBool()) {
    simple(ValueKind::boolean, value.getBool());
  } else if (value.isInt()) {
    simple(ValueKind::integer, value.getInt());
  } else if (value.isFloat()) {
    simple(ValueKind::real, double(value.getFloat()));
  } else if (value.isString()) {
    simple(ValueKind::text, value.getString());
  } else if (value.isColor() || value.isPoint3f() || value.isMatrix44f()) {
    simple(ValueKind::numbers, numbers_of(value));
    out.count = out.value.toList().size();
  }
  return out;
}

void set_numbers(RichParameter& parameter, const QVariantList& numbers) {
  const auto number = [&numbers](int i) { return static_cast<float>(numbers.value(i).toDouble()); };
  if (parameter.value().isColor()) {
    const auto channel = [&numbers](int i) { return std::min(255, std::max(0, numbers.value(i).toInt())); };
    parameter.setValue(ColorValue(QColor(channel(0), channel(1), channel(2), channel(3))));
  } else if (parameter.value().isPoint3f()) {
    parameter.setValue(Point3fValue(vcg::Point3f(number(0), number(1), number(2))));
  } else if (parameter.value().isMatrix44f()) {
    vcg::Matrix44f matrix;
    for (int entry = 0; entry < 16; ++entry) matrix.V()[entry] = number(entry);
    parameter.setValue(Matrix44fValue(matrix));
  }
}

void set_value(RichParameter& parameter, ValueKind kind, const QVariant& value, MeshDocument& document) {
  switch (kind) {
    case ValueKind::boolean:
      parameter.setValue(BoolValue(value.toBool()));
      break;
    case ValueKind::integer:
      parameter.setValue(IntValue(value.toInt()));
      break;
    case ValueKind::choice:
      parameter.setValue(EnumValue(value.toInt()));
      break;
    case ValueKind::text:
      parameter.setValue(StringValue(value.toString()));
      break;
    case ValueKind::length:
      parameter.setValue(AbsPercValue(value.toFloat()));
      break;
    case ValueKind::layer:
      parameter.setValue(MeshValue(document.meshList.value(value.toInt())));
      break;
    case ValueKind::numbers:
      set_numbers(parameter, value.toList());
      break;
    case ValueKind::open_file:
    case ValueKind::save_file:
      parameter.setValue(FileValue(value.toString()));
      break;
    case ValueKind::real:
      if (parameter.value().isDynamicFloat())
        parameter.setValue(DynamicFloatValue(value.toFloat()));
      else
        parameter.setValue(FloatValue(value.toFloat()));
      break;
    case ValueKind::layer_or_none:
    case ValueKind::unsupported:
      break;
  }
}

/// The layers that a filter may look at must carry what it requires, and know how much of them is selected.
void prepare_layers(MeshDocument& document, int requirements) {
  if (document.mm() != nullptr) document.mm()->updateDataMask(requirements);
  for (MeshModel* mesh : document.meshList) {
    mesh->cm.svn = static_cast<int>(vcg::tri::UpdateSelection<CMeshO>::VertexCount(mesh->cm));
    mesh->cm.sfn = static_cast<int>(vcg::tri::UpdateSelection<CMeshO>::FaceCount(mesh->cm));
  }
}

bool has_repeated_corners(const CMeshO& mesh) {
  for (const CFaceO& face : mesh.face)
    if (!face.IsD() && (face.cV(0) == face.cV(1) || face.cV(1) == face.cV(2) || face.cV(2) == face.cV(0)))
      return true;
  return false;
}

}  // namespace

std::vector<HostParameter> RunnerHost::parameters(const HostFilter& filter) {
  const State::Action& action = state_->actions.at(filter.name);
  MeshDocument stand_in;
  MeshDocument* document = &state_->document;
  if (document->mm() == nullptr) {
    MeshModel* mesh = stand_in.addNewMesh("", "tetrahedron");
    vcg::tri::Tetrahedron<CMeshO>(mesh->cm);
    mesh->UpdateBoxAndNormals();
    // Some of MeshLab's filters refuse to tell their parameters for a mesh without, say, quality.
    mesh->updateDataMask(MeshModel::MM_ALL);
    if (filter.declaration == nullptr || filter.declaration->arity != Arity::no_mesh) document = &stand_in;
  }
  RichParameterList list;
  action.plugin->initParameterSet(action.action, *document, list);
  std::vector<HostParameter> described;
  for (const RichParameter& parameter : list) described.push_back(describe(parameter, *document));
  return described;
}

QString RunnerHost::obstacle(const HostFilter& filter) {
  const State::Action& action = state_->actions.at(filter.name);
  if (filter.needs_opengl)
    return "It draws with OpenGL, which is not there without a display. Run it in MeshLab's window.";
  const bool needs_mesh = action.plugin->filterArity(action.action) == MeshFilterInterface::SINGLE_MESH;
  MeshModel* mesh = state_->document.mm();
  if (mesh == nullptr)
    return needs_mesh ? QString("It needs a mesh, and none is loaded (-i FILE).") : QString();
  if (filter.declaration != nullptr) return QString();
  QStringList missing;
  if (needs_mesh && !action.plugin->isFilterApplicable(action.action, *mesh, missing))
    return "The current layer lacks " + missing.join(", ") + ".";
  // MeshLab's face adjacency stops the whole program at a face that has a vertex twice.
  const int requirements = action.plugin->getRequirements(action.action);
  if ((requirements & MeshModel::MM_FACEFACETOPO) != 0 && has_repeated_corners(mesh->cm))
    return "The current layer has faces with a repeated corner, which MeshLab's adjacency cannot hold. "
           "Run \"Remove Zero Area Faces\" first.";
  return QString();
}

RunOutcome RunnerHost::run(const HostFilter& filter, const std::map<QString, QVariant>& values,
                           const Progress::Receiver& receiver,
                           const std::function<void(const QString&)>& log) {
  const State::Action& action = state_->actions.at(filter.name);
  MeshDocument& document = state_->document;
  RunOutcome outcome;
  GLLogStream stream;
  const auto forward = [&stream, &log, sent = 0]() mutable {
    for (const QList<std::pair<int, QString>>& lines = stream.logStringList(); sent < lines.size(); ++sent)
      log(lines[sent].second);
  };
  const QMetaObject::Connection connection = QObject::connect(&stream, &GLLogStream::logUpdated, forward);
  action.plugin->setLog(&stream);
  CallbackScope callback(receiver);
  const DialogCloser dialogs;
  if (filter.declared != nullptr) filter.declared->set_progress_receiver(receiver);
  document.setBusy(true);
  try {
    RichParameterList list;
    prepare_layers(document, action.plugin->getRequirements(action.action));
    action.plugin->initParameterSet(action.action, document, list);
    for (RichParameter& parameter : list) {
      const auto given = values.find(parameter.name());
      if (given != values.end())
        set_value(parameter, describe(parameter, document).kind, given->second, document);
    }
    outcome.done = action.plugin->applyFilter(action.action, document, list, &CallbackScope::callback);
    if (!outcome.done) outcome.message = action.plugin->errorMsg();
  } catch (const std::exception& error) {
    outcome.done = false;
    outcome.message = QString::fromUtf8(error.what());
  }
  if (!outcome.done && outcome.message.isEmpty()) outcome.message = dialogs.message();
  document.setBusy(false);
  QObject::disconnect(connection);
  action.plugin->setLog(nullptr);
  if (filter.declared != nullptr) {
    filter.declared->set_progress_receiver(Progress::Receiver());
    outcome.report = filter.declared->last_report();
  }
  return outcome;
}

}  // namespace host
}  // namespace meshcomplete
