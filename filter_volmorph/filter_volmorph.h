// The MeshLab plugin of the "Range Volume" filters and of "Close Holes: Triangle Fan".
#pragma once

#include <QObject>

#include "common/host/filter_plugin.h"

class FilterVolMorph : public QObject, public meshcomplete::host::FilterPlugin {
  Q_OBJECT
  MESHCOMPLETE_FILTER_PLUGIN

 public:
  FilterVolMorph();
  QString pluginName() const override { return "FilterVolMorph"; }
};
