// The MeshLab plugin of "Close Holes: Curve Unfolding".
#pragma once

#include <QObject>

#include "common/host/filter_plugin.h"

class FilterCurveUnfold : public QObject, public meshcomplete::host::FilterPlugin {
  Q_OBJECT
  MESHCOMPLETE_FILTER_PLUGIN

 public:
  FilterCurveUnfold();
  QString pluginName() const override { return "FilterCurveUnfold"; }
};
