# What is installed and what the libraries need and show.
add_test(NAME test_headers COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_headers.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(test_headers PROPERTIES SKIP_RETURN_CODE 77)

# Sanitizers change what a library needs and what its consumers must link.
if(NOT HNBRDF_SANITIZE)
  add_test(NAME test_exports COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_exports.sh ${PROJECT_SOURCE_DIR}
    $<TARGET_LINKER_FILE:hnbrdf_shared> $<TARGET_FILE:hnbrdf_static>
    $<TARGET_LINKER_FILE:hnbrdf_measured_shared> $<TARGET_LINKER_FILE:hnbrdf_metrics_shared>
    $<TARGET_LINKER_FILE:hnbrdf_fit_shared>)
  add_test(NAME test_install COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_install.sh
    ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/install)
  set_tests_properties(test_install PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME test_minimal COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_minimal.sh
    ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/minimal -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER})
endif()
