# hnbrdf_part(NAME SOURCES ... [NEEDS parts...] [LINKS libraries...])
# Compiles the sources once and makes two libraries of them: NAME_static and NAME_shared, both with the
# output name NAME. Inside the build, tools and tests link NAME_static: it also shows them the
# functions that are not exported.
set_property(GLOBAL PROPERTY HNBRDF_PARTS "")
function(hnbrdf_part name)
  cmake_parse_arguments(PART "" "" "SOURCES;NEEDS;LINKS" ${ARGN})
  add_library(${name}_objects OBJECT ${PART_SOURCES})
  target_link_libraries(${name}_objects PRIVATE hnbrdf_flags)
  target_compile_definitions(${name}_objects PRIVATE HNBRDF_BUILD)
  foreach(kind static shared)
    string(TOUPPER ${kind} upper)
    add_library(${name}_${kind} ${upper} $<TARGET_OBJECTS:${name}_objects>)
    set_target_properties(${name}_${kind} PROPERTIES OUTPUT_NAME ${name}
      VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}
      EXPORT_NAME ${name}_${kind})
    target_include_directories(${name}_${kind} INTERFACE
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    foreach(need ${PART_NEEDS})
      target_link_libraries(${name}_${kind} PUBLIC ${need}_${kind})
    endforeach()
    if(kind STREQUAL static)
      target_link_libraries(${name}_${kind} PUBLIC ${PART_LINKS})
    else()
      target_link_libraries(${name}_${kind} PRIVATE ${PART_LINKS})
    endif()
    add_library(hnbrdf::${name}_${kind} ALIAS ${name}_${kind})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY HNBRDF_PARTS ${name})
endfunction()
