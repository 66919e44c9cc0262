# Stability: the oracle, and the library against it.
hnbrdf_test(test_oracle test_oracle.c core_support.c)
target_link_libraries(test_oracle PRIVATE hnbrdf_oracle)
hnbrdf_test(test_stability test_stability.c core_support.c)
target_link_libraries(test_stability PRIVATE hnbrdf_stability)
add_test(NAME test_stability_cli COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_stability_cli.sh
  $<TARGET_FILE:hnbrdf_cli> ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors $<TARGET_FILE:glsl_scenes>)
