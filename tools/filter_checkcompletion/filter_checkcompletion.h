// The MeshLab plugin of "Check Completion".
#pragma once

#include <QObject>

#include "common/host/filter_plugin.h"

class FilterCheckCompletion : public QObject, public meshcomplete::host::FilterPlugin {
  Q_OBJECT
  MESHCOMPLETE_FILTER_PLUGIN

 public:
  FilterCheckCompletion();
  QString pluginName() const override { return "FilterCheckCompletion"; }
};
