# hnbrdf_part(NAME ROOMS ... [SOURCES ...] [DEFINITIONS ...] [NEEDS parts...] [LINKS libraries...])
# Makes two libraries of the rooms, NAME_static and NAME_shared, both with the output name NAME, and
# compiles the sources once for both (on Windows twice: what is exported is marked in the code).
# Inside the build, tools and tests link NAME_static: it also shows them the functions that are not
# exported.

# One part may not use what another part hides. (Sanitizers leave their runtime to the executable,
# and a parent's flags may hold some.)
if(PROJECT_IS_TOP_LEVEL AND NOT HNBRDF_SANITIZE AND NOT HNBRDF_BUILD_FUZZERS
    AND NOT CMAKE_C_FLAGS MATCHES "-fsanitize")
  include(CheckLinkerFlag)
  check_linker_flag(C LINKER:-z,defs HNBRDF_LINKER_REFUSES_UNDEFINED)
  if(HNBRDF_LINKER_REFUSES_UNDEFINED)
    list(APPEND HNBRDF_LINK_FLAGS LINKER:-z,defs)
  endif()
endif()

# The plain names, hnbrdf::hnbrdf and so on, are static libraries or shared ones by the rule of
# find_package(hnbrdf): HNBRDF_USE_STATIC_LIBS, or BUILD_SHARED_LIBS where that is not set.
set(HNBRDF_PLAIN_KIND static)
if(DEFINED HNBRDF_USE_STATIC_LIBS)
  if(NOT HNBRDF_USE_STATIC_LIBS)
    set(HNBRDF_PLAIN_KIND shared)
  endif()
elseif(BUILD_SHARED_LIBS)
  set(HNBRDF_PLAIN_KIND shared)
endif()

# hnbrdf_objects(TARGET DEFINITION): the sources of the part that is being made, compiled.
function(hnbrdf_objects target definition)
  add_library(${target} OBJECT ${PART_SOURCES})
  # Before whatever the folders above ask for: files of theirs may be called like ours.
  target_include_directories(${target} BEFORE PRIVATE
    ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE hnbrdf_flags)
  target_compile_definitions(${target} PRIVATE ${definition} ${PART_DEFINITIONS})
endfunction()

# The room base whole, for what is not installed and, file by file as needed, for shared libraries.
set(PART_SOURCES ${HNBRDF_ROOM_base})
if(NOT HNBRDF_BUILD_FIT)
  list(REMOVE_ITEM PART_SOURCES src/base/threads.c) # not every system has POSIX threads
endif()
hnbrdf_objects(hnbrdf_base_objects HNBRDF_STATIC)
add_library(hnbrdf_base STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:hnbrdf_base_objects>)
set_target_properties(hnbrdf_base_objects PROPERTIES EXCLUDE_FROM_ALL ON)

# Programs go on working with a later library of the same number: from 1.0 on with any of its major
# version, before that of its minor one (tests/test_abi.sh).
set(HNBRDF_SOVERSION ${PROJECT_VERSION_MAJOR})
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(HNBRDF_SOVERSION 0.${PROJECT_VERSION_MINOR})
endif()

set_property(GLOBAL PROPERTY HNBRDF_PARTS "")
function(hnbrdf_part name)
  cmake_parse_arguments(PART "" "" "ROOMS;SOURCES;DEFINITIONS;NEEDS;LINKS" ${ARGN})
  foreach(room ${PART_ROOMS})
    list(APPEND PART_SOURCES ${HNBRDF_ROOM_${room}})
  endforeach()
  set(static_objects ${name}_objects)
  set(shared_objects ${name}_objects)
  if(WIN32)
    set(shared_objects ${name}_dll_objects)
    hnbrdf_objects(${static_objects} HNBRDF_STATIC)
    hnbrdf_objects(${shared_objects} HNBRDF_BUILD)
    add_dependencies(${shared_objects} ${static_objects}) # what is generated is generated once
  else()
    hnbrdf_objects(${static_objects} HNBRDF_BUILD)
  endif()
  # hnbrdf::fit for hnbrdf_fit and so on, the names that find_package() gives.
  string(REPLACE hnbrdf_ "" short ${name})
  foreach(kind static shared)
    string(TOUPPER ${kind} upper)
    add_library(${name}_${kind} ${upper} $<TARGET_OBJECTS:${${kind}_objects}>)
    set_target_properties(${name}_${kind} PROPERTIES OUTPUT_NAME ${name}
      VERSION ${PROJECT_VERSION} SOVERSION ${HNBRDF_SOVERSION}
      HNBRDF_NEEDS "${PART_NEEDS}" HNBRDF_LINKS "${PART_LINKS}")
    target_include_directories(${name}_${kind} INTERFACE
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    foreach(need ${PART_NEEDS})
      target_link_libraries(${name}_${kind} PUBLIC ${need}_${kind})
    endforeach()
    if(kind STREQUAL static)
      target_link_libraries(${name}_static PUBLIC ${PART_LINKS})
      target_compile_definitions(${name}_static INTERFACE HNBRDF_STATIC)
      if(MSVC) # NAME.lib is the import library
        set_target_properties(${name}_static PROPERTIES OUTPUT_NAME ${name}_static)
      endif()
    else()
      target_link_libraries(${name}_shared PRIVATE ${PART_LINKS} hnbrdf_base)
      target_link_options(${name}_shared PRIVATE ${HNBRDF_LINK_FLAGS})
      # Installed parts find each other beside them, wherever that is.
      if(APPLE)
        set_target_properties(${name}_shared PROPERTIES INSTALL_RPATH "@loader_path")
      else()
        set_target_properties(${name}_shared PROPERTIES INSTALL_RPATH "$ORIGIN")
      endif()
    endif()
    add_library(hnbrdf::${name}_${kind} ALIAS ${name}_${kind})
  endforeach()
  add_library(hnbrdf::${short} ALIAS ${name}_${HNBRDF_PLAIN_KIND})
  set_property(GLOBAL APPEND PROPERTY HNBRDF_PARTS ${name})
endfunction()
