# The parity body (shaders/parity.glsl): what runs it, and how that is judged.
hnbrdf_test(test_parity_exchange test_parity_exchange.c gpu_support.c)
target_link_libraries(hnbrdf_test_parity_exchange PRIVATE hnbrdf_check)
hnbrdf_test(test_parity_draw test_parity_draw.c gpu_support.c)
target_link_libraries(hnbrdf_test_parity_draw PRIVATE hnbrdf_check)

if(HNBRDF_WITH_EGL)
  hnbrdf_test(test_gl_verify test_gl_verify.c gpu_support.c)
  target_link_libraries(hnbrdf_test_gl_verify PRIVATE hnbrdf_gl ${CMAKE_DL_LIBS})
  hnbrdf_test(test_gl_filter test_gl_filter.c gpu_support.c)
  target_link_libraries(hnbrdf_test_gl_filter PRIVATE hnbrdf_gl)
  # The driver is unloaded before leaks are looked for, with what it holds.
  set_tests_properties(test_gl_verify test_gl_filter PROPERTIES
    ENVIRONMENT ASAN_OPTIONS=detect_leaks=0)
endif()
add_test(NAME test_gl_cli COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_gl_cli.sh
  $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_glsl_scenes>)
set_tests_properties(test_gl_cli PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME test_parity_summary COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_parity_summary.sh)
