// The MeshLab plugin of "Close Holes: Poisson-driven" and "Surface Reconstruction: Poisson Delaunay".
#pragma once

#include <QObject>

#include "common/host/filter_plugin.h"

class FilterPoissonCompletion : public QObject, public meshcomplete::host::FilterPlugin {
  Q_OBJECT
  MESHCOMPLETE_FILTER_PLUGIN

 public:
  FilterPoissonCompletion();
  QString pluginName() const override { return "FilterPoissonCompletion"; }
};
