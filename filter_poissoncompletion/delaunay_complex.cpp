#include "filter_poissoncompletion/delaunay_complex.h"

namespace meshcomplete {

std::vector<Triangle> separating_facets(const DelaunayComplex& complex) {
  std::vector<Triangle> facets;
  for (std::size_t cell = 0; cell < complex.cells.size(); ++cell) {
    if (!complex.inside[cell]) continue;
    for (int k = 0; k < 4; ++k) {
      const Index other = complex.neighbours[cell][k];
      if (other != DelaunayComplex::none && complex.inside[other]) continue;
      const Triangle t = facet_towards_corner(complex.cells[cell], k);
      facets.push_back({t[0], t[2], t[1]});
    }
  }
  return facets;
}

}  // namespace meshcomplete
