// The MeshLab plugin of "Close Holes: Atomic Volumes".
#pragma once

#include <QObject>

#include "common/host/filter_plugin.h"

class FilterAtomicVolumes : public QObject, public meshcomplete::host::FilterPlugin {
  Q_OBJECT
  MESHCOMPLETE_FILTER_PLUGIN

 public:
  FilterAtomicVolumes();
  QString pluginName() const override { return "FilterAtomicVolumes"; }
};
