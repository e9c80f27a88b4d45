# The libraries that loopgrid is built on, found the same way by this build and by the installed
# package's config file. Debian's OpenCV modules and SuiteSparse bring no CMake config of their
# own (OpenCV's is in the package with all of its modules), so they get targets here:
# loopgrid_deps::cholmod and loopgrid_deps::opencv.

find_package(Eigen3 3.3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(mrpt-obs REQUIRED)

if(NOT TARGET loopgrid_deps::cholmod)
  find_path(LOOPGRID_CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
  find_library(LOOPGRID_CHOLMOD_LIBRARY cholmod REQUIRED)
  mark_as_advanced(LOOPGRID_CHOLMOD_INCLUDE_DIR LOOPGRID_CHOLMOD_LIBRARY)
  add_library(loopgrid_deps::cholmod UNKNOWN IMPORTED)
  set_target_properties(loopgrid_deps::cholmod PROPERTIES
    IMPORTED_LOCATION "${LOOPGRID_CHOLMOD_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${LOOPGRID_CHOLMOD_INCLUDE_DIR}")
endif()

if(NOT TARGET loopgrid_deps::opencv)
  find_path(LOOPGRID_OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
  add_library(loopgrid_deps::opencv INTERFACE IMPORTED)
  set_target_properties(loopgrid_deps::opencv PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${LOOPGRID_OPENCV_INCLUDE_DIR}")
  foreach(module imgcodecs imgproc core)
    find_library(LOOPGRID_OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
    mark_as_advanced(LOOPGRID_OPENCV_${module}_LIBRARY)
    set_property(TARGET loopgrid_deps::opencv APPEND PROPERTY
      INTERFACE_LINK_LIBRARIES "${LOOPGRID_OPENCV_${module}_LIBRARY}")
  endforeach()
  mark_as_advanced(LOOPGRID_OPENCV_INCLUDE_DIR)
endif()
