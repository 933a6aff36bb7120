# Finds an installed MeshLab: its library, which Debian packages, and the headers of the same version, which Debian
# does not package (scripts/setup.sh unpacks them from Debian's source package).
#
# Input:    MESHLAB_SOURCE_DIR   a MeshLab source tree; default: .cache/meshlab-<version of the library> in this checkout
# Defines:  MeshLab::common      headers and library
#           MeshLab_VERSION, MeshLab_SOURCE_DIR, MeshLab_PLUGIN_DIR
include(FindPackageHandleStandardArgs)

find_library(MeshLab_LIBRARY NAMES meshlab-common PATH_SUFFIXES meshlab)
set(MeshLab_VERSION "")
if(MeshLab_LIBRARY)
  # MeshLab compiles its version into the library as a string of its own.
  file(STRINGS "${MeshLab_LIBRARY}" meshlab_version_strings REGEX "^20[0-9][0-9]\\.[0-9][0-9][a-z]?$")
  list(LENGTH meshlab_version_strings meshlab_version_count)
  if(meshlab_version_count GREATER 0)
    list(GET meshlab_version_strings 0 MeshLab_VERSION)
  endif()
  get_filename_component(meshlab_library_dir "${MeshLab_LIBRARY}" DIRECTORY)
  set(MeshLab_PLUGIN_DIR "${meshlab_library_dir}/plugins")
endif()

set(MESHLAB_SOURCE_DIR "" CACHE PATH "MeshLab source tree of the installed version (empty: the one that scripts/setup.sh unpacks)")
if(MESHLAB_SOURCE_DIR)
  set(MeshLab_SOURCE_DIR "${MESHLAB_SOURCE_DIR}")
else()
  set(MeshLab_SOURCE_DIR "${CMAKE_SOURCE_DIR}/.cache/meshlab-${MeshLab_VERSION}")
endif()

set(meshlab_problem "")
if(NOT MeshLab_LIBRARY)
  set(meshlab_problem "libmeshlab-common was not found. On Debian: apt-get install meshlab.")
elseif(NOT MeshLab_VERSION)
  set(meshlab_problem "${MeshLab_LIBRARY} does not say which version of MeshLab it belongs to.")
elseif(NOT EXISTS "${MeshLab_SOURCE_DIR}/ML_VERSION" OR NOT EXISTS "${MeshLab_SOURCE_DIR}/src/common/meshmodel.h")
  set(meshlab_problem
      "There is no MeshLab ${MeshLab_VERSION} source tree in '${MeshLab_SOURCE_DIR}'. Run scripts/setup.sh, or pass -DMESHLAB_SOURCE_DIR=.")
else()
  file(READ "${MeshLab_SOURCE_DIR}/ML_VERSION" meshlab_header_version)
  string(STRIP "${meshlab_header_version}" meshlab_header_version)
  if(NOT meshlab_header_version STREQUAL MeshLab_VERSION)
    set(meshlab_problem
        "The MeshLab headers in '${MeshLab_SOURCE_DIR}' are of version ${meshlab_header_version}, but the library ${MeshLab_LIBRARY} is of version ${MeshLab_VERSION}. Pass -DMESHLAB_SOURCE_DIR= with a source tree of version ${MeshLab_VERSION}.")
  endif()
endif()

find_package_handle_standard_args(
  MeshLab
  REQUIRED_VARS MeshLab_LIBRARY MeshLab_SOURCE_DIR
  VERSION_VAR MeshLab_VERSION
  REASON_FAILURE_MESSAGE "${meshlab_problem}")
if(meshlab_problem)
  message(FATAL_ERROR "${meshlab_problem}")
endif()

if(NOT TARGET MeshLab::common)
  # vcglib stands beside src up to 2020, and inside it later.
  if(EXISTS "${MeshLab_SOURCE_DIR}/src/vcglib/vcg")
    set(meshlab_vcglib "${MeshLab_SOURCE_DIR}/src/vcglib")
  else()
    set(meshlab_vcglib "${MeshLab_SOURCE_DIR}/vcglib")
  endif()
  # 2020.09 becomes 202009, 2025.07 becomes 202507: numbers that the preprocessor can compare.
  string(REGEX REPLACE "^([0-9]+)\\.([0-9]+).*$" "\\1\\2" meshlab_version_number "${MeshLab_VERSION}")
  set(meshlab_definitions MESHLAB_SCALAR=float MESHCOMPLETE_MESHLAB=${meshlab_version_number})
  if(meshlab_version_number GREATER 202100)
    list(APPEND meshlab_definitions MESHLAB_VERSION=${MeshLab_VERSION})
  endif()
  find_package(Qt5 REQUIRED COMPONENTS Core Gui Widgets OpenGL Xml)
  find_package(OpenGL REQUIRED)
  find_package(GLEW REQUIRED)
  add_library(MeshLab::common UNKNOWN IMPORTED)
  set_target_properties(
    MeshLab::common
    PROPERTIES IMPORTED_LOCATION "${MeshLab_LIBRARY}"
               INTERFACE_INCLUDE_DIRECTORIES "${MeshLab_SOURCE_DIR}/src;${meshlab_vcglib}"
               INTERFACE_COMPILE_DEFINITIONS "${meshlab_definitions}"
               INTERFACE_LINK_LIBRARIES
               "Qt5::Core;Qt5::Gui;Qt5::Widgets;Qt5::OpenGL;Qt5::Xml;Eigen3::Eigen;GLEW::GLEW;OpenGL::GL")
endif()
