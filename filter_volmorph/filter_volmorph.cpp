#include "filter_volmorph/filter_volmorph.h"

#include <utility>

#include "filter_volmorph/filter_trianglefan.h"
#include "filter_volmorph/filter_volumechanges.h"
#include "filter_volmorph/filter_volumeresults.h"
#include "filter_volmorph/filter_volumesources.h"

FilterVolMorph::FilterVolMorph() {
  using namespace meshcomplete::host;
  std::vector<FilterDeclaration> filters = {triangle_fan_filter()};
  for (std::vector<FilterDeclaration>& some : std::vector<std::vector<FilterDeclaration>>{
           volume_source_filters(), volume_change_filters(), volume_result_filters()})
    for (FilterDeclaration& filter : some) filters.push_back(std::move(filter));
  declare(std::move(filters), this);
}
