# What runs on a Vulkan device once more on a second driver, where one is installed.
function(hnbrdf_second_driver_test name)
  add_test(NAME ${name}_second_driver COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/second_driver.sh
    ${ARGN})
  set_tests_properties(${name}_second_driver PROPERTIES SKIP_RETURN_CODE 77)
endfunction()

if(HNBRDF_WITH_VULKAN)
  foreach(name test_gpu_verify test_gpu_half test_glsl_unpack test_glsl_sample test_glsl_strip
      test_glsl_world test_glsl_sampling_density test_gpu_sphere)
    hnbrdf_second_driver_test(${name} $<TARGET_FILE:hnbrdf_${name}>)
  endforeach()
  hnbrdf_second_driver_test(test_gpu_cli sh ${CMAKE_CURRENT_SOURCE_DIR}/test_gpu_cli.sh
    $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_glsl_scenes>)
  # Both drivers in one table.
  hnbrdf_second_driver_test(test_stability_cli sh ${CMAKE_CURRENT_SOURCE_DIR}/test_stability_cli.sh
    $<TARGET_FILE:hnbrdf_cli> ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors
    $<TARGET_FILE:hnbrdf_glsl_scenes> all)
  set_tests_properties(test_stability_cli_second_driver PROPERTIES ENVIRONMENT HNBRDF_BESIDE=1)
endif()
