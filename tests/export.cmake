# Materials in textures, sampling and stripping in GLSL.
hnbrdf_test(test_pack test_pack.c core_support.c)
add_test(NAME test_export_cli COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_export_cli.sh
  $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_glsl_scenes>
  ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
add_test(NAME test_glsl_prefix_texts COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_glsl_prefix.sh
  $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_glsl_scenes> ${PROJECT_SOURCE_DIR}/shaders)
set_tests_properties(test_glsl_prefix_texts PROPERTIES SKIP_RETURN_CODE 77)
if(HNBRDF_WITH_VULKAN)
  foreach(name brdf unpack sample strip prefix world)
    hnbrdf_test(test_glsl_${name} test_glsl_${name}.c core_support.c gpu_run.c gpu_support.c)
    target_link_libraries(hnbrdf_test_glsl_${name} PRIVATE hnbrdf_gpu ${CMAKE_DL_LIBS})
  endforeach()
  hnbrdf_test(test_glsl_sampling_density test_glsl_sampling_density.c sampling_statistics.c
    gpu_run.c)
  target_link_libraries(hnbrdf_test_glsl_sampling_density PRIVATE hnbrdf_gpu ${CMAKE_DL_LIBS})
  target_compile_definitions(hnbrdf_test_glsl_sampling_density PRIVATE
    HNBRDF_EXAMPLE_MODEL="${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors")
endif()
