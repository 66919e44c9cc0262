# What is installed and what the libraries need and show.
add_test(NAME test_headers COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_headers.sh
  ${PROJECT_SOURCE_DIR})
set_tests_properties(test_headers PROPERTIES SKIP_RETURN_CODE 77)

add_test(NAME test_doxygen COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_doxygen.sh
  ${PROJECT_SOURCE_DIR})
set_tests_properties(test_doxygen PROPERTIES SKIP_RETURN_CODE 77)

add_test(NAME test_first_use COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/first_use.sh --smoke)
set_tests_properties(test_first_use PROPERTIES SKIP_RETURN_CODE 77)

add_test(NAME test_shipped_model COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_shipped_model.sh
  ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)

if(HNBRDF_BUILD_EXAMPLES)
  add_test(NAME test_examples COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_examples.sh
    ${PROJECT_SOURCE_DIR}
    $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE_DIR:hnbrdf_example_eval>
    ${CMAKE_CURRENT_BINARY_DIR}/examples)
endif()

# Sanitizers change what a library needs and what its consumers must link.
if(NOT HNBRDF_SANITIZE)
  add_test(NAME test_python COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_python.sh
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CMAKE_C_COMPILER})
  set_tests_properties(test_python PROPERTIES SKIP_RETURN_CODE 77)
  set(parts hnbrdf hnbrdf_measured hnbrdf_metrics hnbrdf_fit hnbrdf_bake)
  if(HNBRDF_WITH_HDF5)
    list(APPEND parts hnbrdf_hdf5)
  endif()
  add_test(NAME test_exports COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_exports.sh
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${parts})
  add_test(NAME test_abi COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_abi.sh
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR}/abi)
  add_test(NAME test_recipes COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_recipes.sh
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR}/recipes
    ${PROJECT_VERSION})
  add_test(NAME test_install COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_install.sh
    ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/install)
  set_tests_properties(test_install PROPERTIES SKIP_RETURN_CODE 77)
  if(TARGET hnbrdf_cli AND TARGET amalgamation)
    add_test(NAME test_packages COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_packages.sh
      ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/packages
      ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
    set_tests_properties(test_packages PROPERTIES SKIP_RETURN_CODE 77)
  endif()
  add_test(NAME test_minimal COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_minimal.sh
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${CMAKE_C_COMPILER}
    ${CMAKE_CURRENT_BINARY_DIR}/minimal)
  add_test(NAME test_windows COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_windows.sh
    ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/windows
    $<TARGET_FILE:hnbrdf_test_core_variants>)
  set_tests_properties(test_windows PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME test_guest COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_guest.sh
    ${PROJECT_SOURCE_DIR}
    ${CMAKE_CURRENT_BINARY_DIR}/guest $<TARGET_FILE:hnbrdf_fast_math_plain>
    ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
  set_tests_properties(test_guest PROPERTIES SKIP_RETURN_CODE 77)
endif()
