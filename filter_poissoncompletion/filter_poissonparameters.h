// What the filters of this plugin share: the parameters of the reconstruction, and layers to reconstruct
// from.
#pragma once

#include <vector>

#include "common/core/poisson_oracle.h"
#include "common/host/filter_declaration.h"
#include "common/host/other_layers.h"

namespace meshcomplete {
namespace host {

/// `max_depth` is the declaration of MaxDepth, `scale` the default of Scale.
std::vector<ParameterDeclaration> oracle_parameters(ParameterDeclaration max_depth, double scale);

/// The values of these parameters.
PoissonOracleOptions oracle_options(const ParameterValues& values);

/// Adds the surface of a layer.
void add_surface(LayerSurface surface, OrientedSurfaces& surfaces);

}  // namespace host
}  // namespace meshcomplete
