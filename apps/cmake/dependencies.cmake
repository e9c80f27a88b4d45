# The libraries that loopgrid's LOOPGRID_COMPONENTS are built on, found the same way by this build and
# by the installed package's config file. Some of Debian's packages bring no CMake config of their own
# (OpenCV's is in the package with all of its modules), so they get targets here: loopgrid_deps::...

# loopgrid_find_library(NAME HEADER PATH_SUFFIX...): loopgrid_deps::NAME for lib<name>.
function(loopgrid_find_library name header)
  if(TARGET loopgrid_deps::${name})
    return()
  endif()
  find_path(LOOPGRID_${name}_INCLUDE_DIR ${header} PATH_SUFFIXES ${ARGN} REQUIRED)
  find_library(LOOPGRID_${name}_LIBRARY ${name} REQUIRED)
  mark_as_advanced(LOOPGRID_${name}_INCLUDE_DIR LOOPGRID_${name}_LIBRARY)
  add_library(loopgrid_deps::${name} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(loopgrid_deps::${name} PROPERTIES
    IMPORTED_LOCATION "${LOOPGRID_${name}_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${LOOPGRID_${name}_INCLUDE_DIR}")
endfunction()

# backend
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
loopgrid_find_library(amd amd.h suitesparse)
loopgrid_find_library(metis metis.h)

if("mapping" IN_LIST LOOPGRID_COMPONENTS)
  find_package(PNG REQUIRED)
  loopgrid_find_library(opencv_core opencv2/core.hpp opencv4)
  loopgrid_find_library(opencv_imgproc opencv2/imgproc.hpp opencv4)
endif()

if("frontend" IN_LIST LOOPGRID_COMPONENTS)
  find_package(mrpt-obs REQUIRED)
endif()
