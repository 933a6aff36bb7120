// The adapter between declared filters (filter_declaration.h) and MeshLab's plugin interface. A plugin is a
// class that derives from QObject and from FilterPlugin and hands its declarations over in its constructor:
//
//   class FilterExample : public QObject, public meshcomplete::host::FilterPlugin {
//     Q_OBJECT
//     MESHCOMPLETE_FILTER_PLUGIN
//    public:
//     FilterExample() { declare({example_declaration()}, this); }
//     QString pluginName() const override { return "FilterExample"; }
//   };
#pragma once

#include <QString>
#include <vector>

#include "common/host/filter_declaration.h"
#include "common/host/meshlab_version.h"

namespace meshcomplete {
namespace host {

/// Nothing escapes from here into MeshLab: a filter that throws becomes a failed filter with a message in the
/// dialog and in the log. MeshLab's progress callback is only called from the thread that MeshLab runs the
/// filter in.
class FilterPlugin : public PluginInterface, public DeclaredFilters {
 public:
  const std::vector<FilterDeclaration>& declarations() const override { return declarations_; }
  const CompletionReport& last_report() const override { return report_; }
  void set_progress_receiver(Progress::Receiver receiver) override { receiver_ = std::move(receiver); }

  QString filterName(FilterId filter) const override;
  QString filterInfo(FilterId filter) const override;
  FilterId ID(QAction* action) const override;
  FilterClass getClass(QAction* action) override;
  FilterArity filterArity(QAction* action) const override;
  int getRequirements(QAction* action) override;
  int getPreConditions(QAction* action) const override;
  int postCondition(QAction* action) const override;
  using PluginInterface::initParameterSet;
  void initParameterSet(QAction* action, MeshDocument& document, RichParameterList& parameters) override;
  bool applyFilter(QAction* action, MeshDocument& document, const RichParameterList& parameters,
                   vcg::CallBackPos* callback) override;

 protected:
  /// Takes the filters over and makes an action for each, owned by `plugin` (the object that derives from
  /// this class).
  void declare(std::vector<FilterDeclaration> declarations, QObject* plugin);

 private:
  const FilterDeclaration& declaration(QAction* action) const;
  void run(const FilterDeclaration& filter, MeshDocument& document, const RichParameterList& parameters,
           vcg::CallBackPos* callback);
  bool fail(const FilterDeclaration& filter, const QString& message);

  std::vector<FilterDeclaration> declarations_;
  CompletionReport report_;
  Progress::Receiver receiver_;
};

}  // namespace host
}  // namespace meshcomplete
