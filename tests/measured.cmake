# Measured data: the readers, the built-in materials and the samplers. Every
# test_measured_NAME.c is a test.
file(GLOB measured_tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/test_measured_*.c)
foreach(path ${CMAKE_CURRENT_SOURCE_DIR}/test_pairs.c ${measured_tests})
  cmake_path(GET path STEM name)
  set(support measured_support.c)
  if(name MATCHES "nbrdf")
    list(APPEND support nbrdf_support.c)
  endif()
  hnbrdf_test(${name} ${name}.c ${support})
endforeach()

# The networks: one test writes HDF5 files, one meets the tables that an independent decoder makes.
if(HNBRDF_WITH_HDF5)
  foreach(name test_measured_nbrdf_hdf5 test_measured_nbrdf_shared)
    target_compile_definitions(hnbrdf_${name} PRIVATE HNBRDF_WITH_HDF5)
    target_link_libraries(hnbrdf_${name} PRIVATE hnbrdf_hdf5_static)
    target_include_directories(hnbrdf_${name} SYSTEM PRIVATE ${HNBRDF_HDF5_INCLUDE_DIR})
  endforeach()
endif()
set(decoder ${PROJECT_SOURCE_DIR}/../shared/tools/nbrdf_to_merl.c)
if(EXISTS ${decoder})
  add_executable(hnbrdf_nbrdf_to_merl ${decoder})
  target_compile_options(hnbrdf_nbrdf_to_merl PRIVATE -ffp-contract=off)
  target_link_libraries(hnbrdf_nbrdf_to_merl PRIVATE m)
  add_dependencies(hnbrdf_test_measured_nbrdf_shared hnbrdf_nbrdf_to_merl)
  target_compile_definitions(hnbrdf_test_measured_nbrdf_shared PRIVATE
    HNBRDF_NBRDF_TO_MERL="$<TARGET_FILE:hnbrdf_nbrdf_to_merl>")
endif()
