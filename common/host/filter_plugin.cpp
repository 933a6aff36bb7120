#include "common/host/filter_plugin.h"

#include <QAction>
#include <cmath>
#include <new>
#include <utility>

#include "common/core/error.h"
#include "common/host/filter_parameters.h"
#include "common/host/long_dialog.h"

namespace meshcomplete {
namespace host {
namespace {

const char* const filter_property = "meshcomplete.filter";

/// MeshLab's progress callback as a receiver: whole per cents, and a return value of false cancels.
Progress::Receiver receiver_for(vcg::CallBackPos* callback) {
  if (callback == nullptr) return {};
  return [callback](double fraction, const std::string& stage) {
    return callback(static_cast<int>(std::floor(100 * fraction)), stage.c_str());
  };
}

FilterClass menu_class(MenuPlace place) {
  switch (place) {
    case MenuPlace::remeshing:
      return PluginInterface::Remeshing;
    case MenuPlace::range_map:
      return PluginInterface::RangeMap;
    case MenuPlace::quality:
      return PluginInterface::Measure;
  }
  return PluginInterface::Remeshing;
}

}  // namespace

void FilterPlugin::declare(std::vector<FilterDeclaration> declarations, QObject* plugin) {
  declarations_ = std::move(declarations);
  for (std::size_t i = 0; i < declarations_.size(); ++i) {
    const FilterId id = static_cast<FilterId>(i);
    auto* action = new QAction(declarations_[i].name, plugin);
    action->setProperty(filter_property, id);
    typeList << id;
    actionList << action;
  }
}

const FilterDeclaration& FilterPlugin::declaration(QAction* action) const {
  return declarations_.at(static_cast<std::size_t>(ID(action)));
}

// By a property of the action and not by its text, which desktops decorate with keyboard accelerators.
FilterId FilterPlugin::ID(QAction* action) const { return action->property(filter_property).toInt(); }

QString FilterPlugin::filterName(FilterId filter) const {
  return declarations_.at(static_cast<std::size_t>(filter)).name;
}

QString FilterPlugin::filterInfo(FilterId filter) const {
  return declarations_.at(static_cast<std::size_t>(filter)).description;
}

FilterClass FilterPlugin::getClass(QAction* action) { return menu_class(declaration(action).place); }

FilterArity FilterPlugin::filterArity(QAction* action) const {
  switch (declaration(action).arity) {
    case Arity::one_mesh:
      return PluginInterface::SINGLE_MESH;
    case Arity::visible_meshes:
      return PluginInterface::VARIABLE;
    case Arity::no_mesh:
      return PluginInterface::NONE;
  }
  return PluginInterface::SINGLE_MESH;
}

// Filters work on a snapshot: nothing needs to be switched on in MeshLab's mesh beforehand.
int FilterPlugin::getRequirements(QAction*) { return MeshModel::MM_NONE; }

// None: the filters themselves say what is missing and what to do about it, on the command line too.
int FilterPlugin::getPreConditions(QAction*) const { return MeshModel::MM_NONE; }

int FilterPlugin::postCondition(QAction* action) const {
  return declaration(action).changes_mesh ? MeshModel::MM_GEOMETRY_AND_TOPOLOGY_CHANGE : MeshModel::MM_NONE;
}

void FilterPlugin::initParameterSet(QAction* action, MeshDocument& document, RichParameterList& parameters) {
  add_parameters(declaration(action), document, parameters);
  fit_dialog_to_screen(declaration(action).name);
}

void FilterPlugin::run(const FilterDeclaration& filter, MeshDocument& document,
                       const RichParameterList& parameters, vcg::CallBackPos* callback) {
  if (filter.arity == Arity::one_mesh && document.mm() == nullptr)
    throw CompletionError("reading the mesh", "There is no mesh in this project: open one first.");
  const MeshLabParameterValues values(filter, document, parameters);
  const Progress::Receiver receiver = receiver_ ? receiver_ : receiver_for(callback);
  const auto log = [this](const QString& line) { Log(line.toStdString()); };
  FilterRun filter_run{document, values, receiver ? Progress(receiver) : Progress(), log, report_};
  filter.apply(filter_run);
}

bool FilterPlugin::applyFilter(QAction* action, MeshDocument& document, const RichParameterList& parameters,
                               vcg::CallBackPos* callback) {
  const FilterDeclaration& filter = declaration(action);
  report_ = CompletionReport();
  errorMessage.clear();
  try {
    run(filter, document, parameters, callback);
    return true;
  } catch (const CompletionError& error) {
    return fail(filter, QString::fromStdString(error.what()));
  } catch (const std::bad_alloc&) {
    return fail(filter, "There is not enough memory for this. The mesh was not changed.");
  } catch (const std::exception& error) {
    return fail(filter, QString("Unexpected error: %1. The mesh was not changed.").arg(error.what()));
  } catch (...) {
    return fail(filter, "Unexpected error. The mesh was not changed.");
  }
}

bool FilterPlugin::fail(const FilterDeclaration& filter, const QString& message) {
  errorMessage = message;
  Log(QString("%1 failed: %2").arg(filter.name, message).toStdString());
  return false;
}

}  // namespace host
}  // namespace meshcomplete
