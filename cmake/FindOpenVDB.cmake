# Finds OpenVDB: sparse volumes. The module that OpenVDB ships looks for all that the library may be built with, Debian's
# only needs the library itself.
#
# Defines:  OpenVDB::openvdb     library and headers
include(FindPackageHandleStandardArgs)

find_package(Imath QUIET)
find_path(OpenVDB_INCLUDE_DIR NAMES openvdb/openvdb.h)
find_library(OpenVDB_LIBRARY NAMES openvdb)
mark_as_advanced(OpenVDB_INCLUDE_DIR OpenVDB_LIBRARY)

find_package_handle_standard_args(
  OpenVDB
  REQUIRED_VARS OpenVDB_LIBRARY OpenVDB_INCLUDE_DIR Imath_FOUND
  REASON_FAILURE_MESSAGE "OpenVDB was not found. On Debian: apt-get install libopenvdb-dev, or run scripts/setup.sh.")

if(OpenVDB_FOUND AND NOT TARGET OpenVDB::openvdb)
  add_library(OpenVDB::openvdb SHARED IMPORTED)
  set_target_properties(
    OpenVDB::openvdb PROPERTIES IMPORTED_LOCATION "${OpenVDB_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES
                                                                        "${OpenVDB_INCLUDE_DIR}"
                                INTERFACE_COMPILE_DEFINITIONS OPENVDB_DLL)
  target_link_libraries(OpenVDB::openvdb INTERFACE Imath::Imath TBB::tbb)
  # Its headers shift negative coordinates to the left, which every compiler does as C++20 says, and C++17 leaves open.
  target_compile_options(OpenVDB::openvdb INTERFACE "$<$<CONFIG:Sanitize>:-fno-sanitize=shift-base>")
endif()
