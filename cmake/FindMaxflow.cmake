# Finds libmaxflow, Boykov and Kolmogorov's minimum cuts. Only its headers are needed: the library that Debian ships beside
# them holds the algorithm for a few types of capacities, and ours are compiled from the templates.
#
# Defines:  Maxflow::maxflow     headers
include(FindPackageHandleStandardArgs)

find_path(Maxflow_INCLUDE_DIR NAMES maxflow.h PATH_SUFFIXES maxflow-3.0)
mark_as_advanced(Maxflow_INCLUDE_DIR)

find_package_handle_standard_args(
  Maxflow
  REQUIRED_VARS Maxflow_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "maxflow.h was not found. On Debian: apt-get install libmaxflow-dev, or run scripts/setup.sh.")

if(Maxflow_FOUND AND NOT TARGET Maxflow::maxflow)
  add_library(Maxflow::maxflow INTERFACE IMPORTED)
  set_target_properties(Maxflow::maxflow PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${Maxflow_INCLUDE_DIR}")
endif()
