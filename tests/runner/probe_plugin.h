// Filters for testing the runner: they do what their parameters say, good or bad.
#pragma once

#include <QObject>

#include "common/host/filter_plugin.h"

class ProbePlugin : public QObject, public meshcomplete::host::FilterPlugin {
  Q_OBJECT
  MESHCOMPLETE_FILTER_PLUGIN

 public:
  ProbePlugin();
  QString pluginName() const override { return "ProbePlugin"; }
};
