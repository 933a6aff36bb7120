#include "filter_volmorph/filter_volmorph.h"

#include "filter_volmorph/filter_trianglefan.h"

using namespace meshcomplete::host;

FilterVolMorph::FilterVolMorph() { declare({triangle_fan_filter()}, this); }
