# install.cmake: what `cmake --install` puts where, and how others find it: find_package(hnbrdf) and
# pkg-config. Folders given relative to the prefix leave all of it movable; absolute ones are kept.
include(CMakePackageConfigHelpers)

get_property(HNBRDF_PARTS GLOBAL PROPERTY HNBRDF_PARTS)
set(_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hnbrdf)

set(_headers_hnbrdf ${HNBRDF_PUBLIC_HEADERS})
set(_headers_hnbrdf_measured measured)
set(_headers_hnbrdf_hdf5 hdf5)
set(_headers_hnbrdf_metrics metrics)
set(_headers_hnbrdf_fit fit)
set(_headers_hnbrdf_bake bake)
foreach(part ${HNBRDF_PARTS})
  install(TARGETS ${part}_static ${part}_shared EXPORT hnbrdfTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime
    NAMELINK_COMPONENT development
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  foreach(header ${_headers_${part}})
    install(FILES include/hnbrdf/${header}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hnbrdf
      COMPONENT development)
  endforeach()
endforeach()
install(FILES shaders/hybrid_brdf.glsl DESTINATION ${CMAKE_INSTALL_DATADIR}/hnbrdf
  COMPONENT development)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
if(TARGET hnbrdf_cli)
  install(TARGETS hnbrdf_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  include(src/help.cmake)
endif()

# find_package(hnbrdf)
install(EXPORT hnbrdfTargets NAMESPACE hnbrdf:: DESTINATION ${_package_dir}
  COMPONENT development)
set(HNBRDF_BIN_DIR ${CMAKE_INSTALL_BINDIR})
set(HNBRDF_SHADER_DIR ${CMAKE_INSTALL_DATADIR}/hnbrdf)
set(_generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
configure_package_config_file(src/hnbrdfConfig.cmake.in ${_generated}/hnbrdfConfig.cmake
  INSTALL_DESTINATION ${_package_dir} PATH_VARS HNBRDF_SHADER_DIR HNBRDF_BIN_DIR)
write_basic_package_version_file(${_generated}/hnbrdfConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${_generated}/hnbrdfConfig.cmake ${_generated}/hnbrdfConfigVersion.cmake
  DESTINATION ${_package_dir} COMPONENT development)
install(FILES src/add_shader.cmake DESTINATION ${_package_dir} RENAME hnbrdfAddShader.cmake
  COMPONENT development)

# pkg-config: one file a part, which find the prefix from their own place where that is in the
# prefix.
set(_about_hnbrdf "evaluate, sample, load and export hybrid neural-microfacet BRDFs")
set(_about_hnbrdf_measured "measured and procedural BRDFs behind one interface")
set(_about_hnbrdf_hdf5 "measured BRDFs in HDF5 files, through libhdf5")
set(_about_hnbrdf_metrics "errors of BRDF models against measurements")
set(_about_hnbrdf_fit "fit hybrid neural-microfacet BRDFs to measurements")
set(_about_hnbrdf_bake "the smallest network that is good enough for the materials of a scene")
# In absolute paths blanks are escaped here; in its own place pkg-config does that itself.
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  string(REPLACE " " "\\ " PC_PREFIX "${CMAKE_INSTALL_PREFIX}")
else()
  file(RELATIVE_PATH PC_PREFIX "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
  string(REGEX REPLACE "/$" "" PC_PREFIX "\${pcfiledir}/${PC_PREFIX}")
endif()
foreach(_name LIBDIR INCLUDEDIR SHADERDIR)
  set(PC_${_name} "${CMAKE_INSTALL_${_name}}")
  if(_name STREQUAL "SHADERDIR")
    set(PC_SHADERDIR "${HNBRDF_SHADER_DIR}")
  endif()
  string(REPLACE " " "\\ " PC_${_name} "${PC_${_name}}")
  if(NOT IS_ABSOLUTE "${PC_${_name}}")
    set(PC_${_name} "\${prefix}/${PC_${_name}}")
  endif()
endforeach()
foreach(PC_NAME ${HNBRDF_PARTS})
  set(PC_ABOUT ${_about_${PC_NAME}})
  get_target_property(PC_NEEDS ${PC_NAME}_shared HNBRDF_NEEDS)
  get_target_property(_links ${PC_NAME}_shared HNBRDF_LINKS)
  string(REPLACE ";" " " PC_NEEDS "${PC_NEEDS}")
  string(REPLACE "Threads::Threads" "${CMAKE_THREAD_LIBS_INIT}" PC_LIBS "${_links}")
  list(TRANSFORM PC_LIBS REPLACE "^([^-/].*)$" "-l\\1")
  string(REPLACE ";" " " PC_LIBS "${PC_LIBS}")
  configure_file(src/hnbrdf.pc.in ${_generated}/${PC_NAME}.pc @ONLY)
  install(FILES ${_generated}/${PC_NAME}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
    COMPONENT development)
endforeach()
