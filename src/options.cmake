# options.cmake: what is built, and what was found to build it with.
# Every part can be left out. Alone, each is ON where what it needs was found; inside another
# project the command, the tests, the examples and the installation are OFF until asked for, and
# what only they need is not looked for.
option(HNBRDF_INSTALL "rules for cmake --install" ${PROJECT_IS_TOP_LEVEL})
option(HNBRDF_WITH_VARIANTS
  "evaluation kernels for the instruction sets of the target, beside the plain one" ON)
option(HNBRDF_SANITIZE "build with AddressSanitizer and UndefinedBehaviorSanitizer" OFF)
option(HNBRDF_BUILD_FUZZERS
  "libFuzzer programs of all readers, everything instrumented; clang only" OFF)
option(HNBRDF_WERROR "warnings are errors" OFF)
option(HNBRDF_BUILD_EXAMPLES "the examples" ${PROJECT_IS_TOP_LEVEL})

# hnbrdf_option(NAME text needs...): ON by default where all needs are true.
macro(hnbrdf_option name text)
  set(_hnbrdf_default ON)
  foreach(need ${ARGN})
    if(NOT ${need})
      set(_hnbrdf_default OFF)
    endif()
  endforeach()
  option(${name} "${text}" ${_hnbrdf_default})
endmacro()

find_package(Threads)
hnbrdf_option(HNBRDF_BUILD_FIT "the measured-data readers and the trainer" Threads_FOUND)

# libhdf5, the serial one, for measured data in HDF5 files. Another project gets it only on request.
if(PROJECT_IS_TOP_LEVEL OR HNBRDF_WITH_HDF5)
  find_path(HNBRDF_HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial)
  find_library(HNBRDF_HDF5_LIBRARY NAMES hdf5_serial hdf5)
  mark_as_advanced(HNBRDF_HDF5_INCLUDE_DIR HNBRDF_HDF5_LIBRARY)
endif()
hnbrdf_option(HNBRDF_WITH_HDF5 "HDF5 files as measured data: hnbrdf_hdf5, which links libhdf5"
  PROJECT_IS_TOP_LEVEL HNBRDF_BUILD_FIT HNBRDF_HDF5_INCLUDE_DIR HNBRDF_HDF5_LIBRARY)
if(HNBRDF_WITH_HDF5 AND NOT (HNBRDF_HDF5_INCLUDE_DIR AND HNBRDF_HDF5_LIBRARY))
  message(FATAL_ERROR "HNBRDF_WITH_HDF5=ON needs libhdf5 (package libhdf5-dev); found headers: "
    "${HNBRDF_HDF5_INCLUDE_DIR}, library: ${HNBRDF_HDF5_LIBRARY}")
endif()

if(PROJECT_IS_TOP_LEVEL OR HNBRDF_BUILD_CLI OR HNBRDF_BUILD_FUZZERS)
  find_package(OpenEXR CONFIG QUIET)
  find_package(Vulkan QUIET)
  # EGL for contexts, types of GL; GL itself comes from the driver when the harness runs.
  find_path(HNBRDF_EGL_INCLUDE_DIR EGL/eglext.h)
  find_path(HNBRDF_GL_INCLUDE_DIR GL/glcorearb.h)
  find_library(HNBRDF_EGL_LIBRARY EGL)
  mark_as_advanced(HNBRDF_EGL_INCLUDE_DIR HNBRDF_GL_INCLUDE_DIR HNBRDF_EGL_LIBRARY)
  find_package(embree CONFIG QUIET) # 3.13 or 4: the headers tell
  if(TARGET embree)
    get_target_property(_embree_include embree INTERFACE_INCLUDE_DIRECTORIES)
    find_path(HNBRDF_EMBREE4_INCLUDE_DIR embree4/rtcore.h HINTS ${_embree_include})
    find_path(HNBRDF_EMBREE3_INCLUDE_DIR embree3/rtcore.h HINTS ${_embree_include})
    mark_as_advanced(HNBRDF_EMBREE4_INCLUDE_DIR HNBRDF_EMBREE3_INCLUDE_DIR)
    if(EMBREE_VERSION_MAJOR EQUAL 4 AND HNBRDF_EMBREE4_INCLUDE_DIR)
      set(HNBRDF_EMBREE_MAJOR 4)
    elseif(HNBRDF_EMBREE3_INCLUDE_DIR)
      set(HNBRDF_EMBREE_MAJOR 3)
    endif()
  endif()
  find_path(STB_INCLUDE_DIR stb_image_write.h PATH_SUFFIXES stb)
  hnbrdf_option(HNBRDF_WITH_OPENEXR "OpenEXR images in the tools" OpenEXR_FOUND)
  hnbrdf_option(HNBRDF_WITH_VULKAN "the Vulkan harness in the tools" Vulkan_FOUND)
  hnbrdf_option(HNBRDF_WITH_EGL "the OpenGL harness in the tools, through EGL"
    HNBRDF_EGL_INCLUDE_DIR HNBRDF_GL_INCLUDE_DIR HNBRDF_EGL_LIBRARY)
  hnbrdf_option(HNBRDF_WITH_EMBREE "meshes and scenes in the tools" HNBRDF_EMBREE_MAJOR)
endif()
# The command is of POSIX.
hnbrdf_option(HNBRDF_BUILD_CLI "the hnbrdf command"
  PROJECT_IS_TOP_LEVEL UNIX HNBRDF_BUILD_FIT STB_INCLUDE_DIR)

# Fits by several processes, in the command alone. Another project gets it only on request.
if(PROJECT_IS_TOP_LEVEL OR HNBRDF_WITH_MPI)
  find_package(MPI 3 QUIET COMPONENTS C)
endif()
hnbrdf_option(HNBRDF_WITH_MPI "mpirun hnbrdf fit: the command links MPI"
  PROJECT_IS_TOP_LEVEL HNBRDF_BUILD_CLI MPI_C_FOUND)
if(HNBRDF_WITH_MPI AND NOT MPI_C_FOUND)
  message(FATAL_ERROR "HNBRDF_WITH_MPI=ON needs MPI of version 3 (package libopenmpi-dev)")
endif()

# BUILD_TESTING=OFF, the switch that projects share, is obeyed whatever HNBRDF_BUILD_TESTS says.
if(PROJECT_IS_TOP_LEVEL OR HNBRDF_BUILD_TESTS)
  find_path(CMOCKA_INCLUDE_DIR cmocka.h)
  find_library(CMOCKA_LIBRARY cmocka)
endif()
hnbrdf_option(HNBRDF_BUILD_TESTS "the tests"
  PROJECT_IS_TOP_LEVEL CMOCKA_LIBRARY CMOCKA_INCLUDE_DIR HNBRDF_BUILD_CLI)
if(HNBRDF_BUILD_TESTS AND NOT HNBRDF_BUILD_CLI)
  message(FATAL_ERROR "HNBRDF_BUILD_TESTS=ON needs HNBRDF_BUILD_CLI=ON: many tests run the command")
endif()
set(HNBRDF_RUN_TESTS ${HNBRDF_BUILD_TESTS})
if(DEFINED BUILD_TESTING AND NOT BUILD_TESTING)
  set(HNBRDF_RUN_TESTS OFF)
endif()

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo, MinSizeRel" FORCE)
endif()
if(HNBRDF_INSTALL)
  include(GNUInstallDirs)
endif()
