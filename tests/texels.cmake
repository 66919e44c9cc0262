# Materials in textures, sampling and stripping in GLSL.
hnbrdf_test(test_pack test_pack.c core_support.c)
if(HNBRDF_WITH_VULKAN)
  foreach(name unpack sample strip)
    hnbrdf_test(test_glsl_${name} test_glsl_${name}.c gpu_run.c gpu_support.c)
    target_link_libraries(test_glsl_${name} PRIVATE hnbrdf_gpu ${CMAKE_DL_LIBS})
  endforeach()
endif()
