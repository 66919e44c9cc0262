# Our GLSL as other shading languages.
hnbrdf_test(test_language test_language.c)
foreach(language hlsl msl wgsl)
  add_test(NAME test_language_${language} COMMAND sh
    ${CMAKE_CURRENT_SOURCE_DIR}/test_language.sh $<TARGET_FILE:hnbrdf_glsl_scenes> ${language})
  set_tests_properties(test_language_${language} PROPERTIES SKIP_RETURN_CODE 77)
endforeach()
add_test(NAME test_language_run COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_language_run.sh
  $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_glsl_scenes>
  ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
set_tests_properties(test_language_run PROPERTIES SKIP_RETURN_CODE 77)
if(HNBRDF_WITH_VULKAN)
  hnbrdf_program(spirv_case spirv_case.c)
  target_link_libraries(hnbrdf_spirv_case PRIVATE hnbrdf_gpu ${CMAKE_DL_LIBS})
  add_test(NAME test_language_gpu COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_language_gpu.sh
    $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_glsl_scenes> $<TARGET_FILE:hnbrdf_spirv_case>
    ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
  set_tests_properties(test_language_gpu PROPERTIES SKIP_RETURN_CODE 77)
endif()
