# The command line and the error figures.
hnbrdf_test(test_metrics test_metrics.c)
hnbrdf_test(test_flip test_flip.c)

# hnbrdf_cli_test(NAME [arguments...]): NAME.sh run with the command, and the program that writes
# what it reads.
hnbrdf_program(test_cli_files test_cli_files.c)
target_link_libraries(hnbrdf_test_cli_files PRIVATE hnbrdf_measured_static)
function(hnbrdf_cli_test name)
  add_test(NAME ${name} COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/${name}.sh
    $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_test_cli_files> ${ARGN})
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77)
endfunction()
hnbrdf_cli_test(test_cli)
hnbrdf_cli_test(test_cli_hostile)
hnbrdf_cli_test(test_cli_commands ${PROJECT_SOURCE_DIR})
hnbrdf_cli_test(test_habits ${PROJECT_SOURCE_DIR})
hnbrdf_cli_test(test_cli_data ${PROJECT_SOURCE_DIR})
hnbrdf_cli_test(test_measured_cli)
hnbrdf_cli_test(test_cli_shared ${PROJECT_SOURCE_DIR}/../shared)
hnbrdf_cli_test(test_scene_cli ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
if(HNBRDF_INSTALL AND NOT CMAKE_CROSSCOMPILING) # src/help.cmake
  add_test(NAME test_help_pages COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_help_pages.sh
    $<TARGET_FILE:hnbrdf_cli> ${PROJECT_BINARY_DIR}/generated/help)
endif()
