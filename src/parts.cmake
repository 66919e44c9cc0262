# hnbrdf_part(NAME ROOMS ... [SOURCES ...] [NEEDS parts...] [LINKS libraries...])
# Compiles the sources once and makes two libraries of them: NAME_static and NAME_shared, both with the
# output name NAME. Inside the build, tools and tests link NAME_static: it also shows them the
# functions that are not exported.

# One part may not use what another part hides. (Sanitizers leave their runtime to the executable.)
include(CheckLinkerFlag)
if(NOT HNBRDF_SANITIZE AND NOT HNBRDF_BUILD_FUZZERS)
  check_linker_flag(C LINKER:-z,defs LINKER_REFUSES_UNDEFINED)
endif()

set_property(GLOBAL PROPERTY HNBRDF_PARTS "")
function(hnbrdf_part name)
  cmake_parse_arguments(PART "" "" "ROOMS;SOURCES;NEEDS;LINKS" ${ARGN})
  foreach(room ${PART_ROOMS})
    list(APPEND PART_SOURCES ${HNBRDF_ROOM_${room}})
  endforeach()
  add_library(${name}_objects OBJECT ${PART_SOURCES})
  target_link_libraries(${name}_objects PRIVATE hnbrdf_flags)
  target_compile_definitions(${name}_objects PRIVATE HNBRDF_BUILD)
  foreach(kind static shared)
    string(TOUPPER ${kind} upper)
    add_library(${name}_${kind} ${upper} $<TARGET_OBJECTS:${name}_objects>)
    set_target_properties(${name}_${kind} PROPERTIES OUTPUT_NAME ${name}
      VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}
      HNBRDF_NEEDS "${PART_NEEDS}" HNBRDF_LINKS "${PART_LINKS}")
    target_include_directories(${name}_${kind} INTERFACE
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    foreach(need ${PART_NEEDS})
      target_link_libraries(${name}_${kind} PUBLIC ${need}_${kind})
    endforeach()
    if(kind STREQUAL static)
      target_link_libraries(${name}_${kind} PUBLIC ${PART_LINKS})
      target_compile_definitions(${name}_${kind} INTERFACE HNBRDF_STATIC)
    else()
      target_link_libraries(${name}_${kind} PRIVATE ${PART_LINKS})
      if(LINKER_REFUSES_UNDEFINED)
        target_link_options(${name}_${kind} PRIVATE LINKER:-z,defs)
      endif()
    endif()
    add_library(hnbrdf::${name}_${kind} ALIAS ${name}_${kind})
  endforeach()
  # hnbrdf::fit for hnbrdf_fit and so on, the names that find_package() gives.
  string(REPLACE hnbrdf_ "" short ${name})
  if(BUILD_SHARED_LIBS)
    add_library(hnbrdf::${short} ALIAS ${name}_shared)
  else()
    add_library(hnbrdf::${short} ALIAS ${name}_static)
  endif()
  set_property(GLOBAL APPEND PROPERTY HNBRDF_PARTS ${name})
endfunction()
