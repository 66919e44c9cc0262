# GLSL export and the Vulkan harness.
hnbrdf_test(test_glsl_export test_glsl_export.c gpu_support.c)
hnbrdf_test(test_export_brdf test_export_brdf.c core_support.c gpu_support.c)
hnbrdf_test(test_macro_names test_macro_names.c core_support.c)

hnbrdf_program(glsl_scenes glsl_scenes.c gpu_support.c)
target_link_libraries(hnbrdf_glsl_scenes PRIVATE hnbrdf_measured_static ${CMOCKA_LIBRARY})
target_include_directories(hnbrdf_glsl_scenes SYSTEM PRIVATE ${CMOCKA_INCLUDE_DIR})
foreach(target "" _directx _metal)
  string(REPLACE "_" "" argument "${target}")
  add_test(NAME test_glsl_languages${target} COMMAND sh
    ${CMAKE_CURRENT_SOURCE_DIR}/test_glsl_languages.sh
    $<TARGET_FILE:hnbrdf_glsl_scenes> ${PROJECT_SOURCE_DIR}/shaders
    ${PROJECT_SOURCE_DIR}/src ${argument})
  set_tests_properties(test_glsl_languages${target} PROPERTIES SKIP_RETURN_CODE 77)
endforeach()

add_test(NAME test_gpu_cli COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_gpu_cli.sh
  $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_glsl_scenes>)
set_tests_properties(test_gpu_cli PROPERTIES SKIP_RETURN_CODE 77)

if(HNBRDF_WITH_VULKAN)
  hnbrdf_test(test_gpu_bounds test_gpu_bounds.c gpu_support.c)
  target_link_libraries(hnbrdf_test_gpu_bounds PRIVATE hnbrdf_gpu)
  hnbrdf_test(test_gpu_half test_gpu_half.c gpu_support.c)
  target_link_libraries(hnbrdf_test_gpu_half PRIVATE hnbrdf_gpu)
  hnbrdf_test(test_gpu_verify test_gpu_verify.c gpu_support.c)
  target_link_libraries(hnbrdf_test_gpu_verify PRIVATE hnbrdf_gpu ${CMAKE_DL_LIBS})
  hnbrdf_test(test_gpu_sphere test_gpu_sphere.c gpu_run.c gpu_support.c)
  target_link_libraries(hnbrdf_test_gpu_sphere PRIVATE hnbrdf_gpu ${CMAKE_DL_LIBS})
endif()
