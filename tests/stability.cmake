# Stability: the oracle, and the library against it.
hnbrdf_test(test_oracle test_oracle.c core_support.c)
target_link_libraries(hnbrdf_test_oracle PRIVATE hnbrdf_check)
hnbrdf_test(test_stability test_stability.c core_support.c)
target_link_libraries(hnbrdf_test_stability PRIVATE hnbrdf_check)
hnbrdf_test(test_core_fused test_core_fused.c core_support.c)
target_link_libraries(hnbrdf_test_core_fused PRIVATE hnbrdf_check)
add_test(NAME test_stability_cli COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_stability_cli.sh
  $<TARGET_FILE:hnbrdf_cli> ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors
  $<TARGET_FILE:hnbrdf_glsl_scenes>)

# The same program with and without -ffast-math, which hnbrdf_flags would take back; the library's
# own flags stay.
foreach(kind plain fast)
  add_executable(hnbrdf_fast_math_${kind} fast_math.c)
  target_link_libraries(hnbrdf_fast_math_${kind} PRIVATE hnbrdf_static)
endforeach()
target_compile_options(hnbrdf_fast_math_fast PRIVATE -O3 -ffast-math)
target_link_options(hnbrdf_fast_math_fast PRIVATE -ffast-math)
add_test(NAME test_fast_math COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_fast_math.sh
  $<TARGET_FILE:hnbrdf_fast_math_plain> $<TARGET_FILE:hnbrdf_fast_math_fast>
  ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
hnbrdf_test(test_physics test_physics.c core_support.c)
hnbrdf_test(test_energy test_energy.c core_support.c)
add_test(NAME test_physics_cli COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_physics_cli.sh
  $<TARGET_FILE:hnbrdf_cli>
  ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors ${PROJECT_SOURCE_DIR}/shaders)
