// A plugin whose filters do what a test needs.
#pragma once

#include <QObject>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "common/host/filter_plugin.h"

namespace meshcomplete {
namespace test {

class FakePlugin : public QObject, public host::FilterPlugin {
  Q_OBJECT
  Q_INTERFACES(MeshFilterInterface meshcomplete::host::DeclaredFilters)

 public:
  explicit FakePlugin(std::vector<host::FilterDeclaration> filters) { declare(std::move(filters), this); }
  QString pluginName() const override { return "FakePlugin"; }

  /// Runs the filter at `position` with MeshLab's defaults for this document, changed as the test likes.
  bool run(MeshDocument& document, int position = 0,
           const std::function<void(RichParameterList&)>& change = {}, vcg::CallBackPos* callback = nullptr) {
    QAction* action = actions().at(position);
    RichParameterList parameters;
    initParameterSet(action, document, parameters);
    if (change) change(parameters);
    log_ = std::make_unique<GLLogStream>();
    setLog(log_.get());
    return applyFilter(action, document, parameters, callback);
  }
  QString message() { return errorMsg(); }
  QString log() const {
    QString all;
    for (const auto& line : log_->logStringList()) all += line.second + "\n";
    return all;
  }

 private:
  std::unique_ptr<GLLogStream> log_;
};

}  // namespace test
}  // namespace meshcomplete
