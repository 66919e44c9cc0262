# The core: arithmetic, analytic part, network, whole models, sampling.
hnbrdf_test(test_math test_math.c)
hnbrdf_test(test_core_analytic test_core_analytic.c core_support.c)
hnbrdf_test(test_core_network test_core_network.c core_support.c)
hnbrdf_test(test_core_eval test_core_eval.c core_support.c)
hnbrdf_test(test_sampling test_sampling.c core_support.c)
hnbrdf_test(test_sampling_density test_sampling_density.c sampling_statistics.c core_support.c)
target_compile_definitions(test_sampling_density PRIVATE
  HNBRDF_EXAMPLE_MODEL="${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors")
hnbrdf_test(test_lobes test_lobes.c core_support.c)
hnbrdf_test(test_core_variants test_core_variants.c variants_sweep.c)
hnbrdf_test(test_variant_choice test_variant_choice.c)

# The same test for 64-bit Arm, emulated. Sanitized programs check the same code; one more build is enough.
if(NOT HNBRDF_SANITIZE)
  add_test(NAME test_neon COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_neon.sh ${PROJECT_SOURCE_DIR}
    ${CMAKE_CURRENT_BINARY_DIR}/neon $<TARGET_FILE:test_core_variants>)
  set_tests_properties(test_neon PROPERTIES SKIP_RETURN_CODE 77)
endif()
