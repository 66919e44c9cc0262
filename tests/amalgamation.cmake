# libhnbrdf as one file. Sanitizers would have to be in it too.
if(TARGET amalgamation AND NOT HNBRDF_SANITIZE)
  add_custom_target(hnbrdf_amalgamation_for_tests ALL)
  add_dependencies(hnbrdf_amalgamation_for_tests amalgamation)
  add_test(NAME test_amalgamation COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_amalgamation.sh
    ${PROJECT_BINARY_DIR}/amalgamation ${CMAKE_CURRENT_BINARY_DIR}/amalgamation
    ${CMAKE_CURRENT_BINARY_DIR}/fuzz/seeds
    ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors
    $<TARGET_FILE:hnbrdf_static> "$<JOIN:$<TARGET_OBJECTS:hnbrdf_portable>, >"
    "$<JOIN:$<TARGET_OBJECTS:hnbrdf_test_core_variants>, >")
  set_tests_properties(test_amalgamation PROPERTIES SKIP_RETURN_CODE 77
    FIXTURES_REQUIRED fuzz_seeds)
endif()
