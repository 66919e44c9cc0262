# Shaders in browsers and in the compilers of other projects, by way of Node.js. web/install.sh
# downloads the packages once into the build tree; tests that need them are skipped without.
set(HNBRDF_WEB_PACKAGES ${PROJECT_BINARY_DIR}/web_packages)
add_test(NAME test_web_packages COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/web/install.sh
  ${HNBRDF_WEB_PACKAGES})
set_tests_properties(test_web_packages PROPERTIES SKIP_RETURN_CODE 77
  FIXTURES_SETUP web_packages)

# hnbrdf_web_test(NAME command...): one that may use the packages, and a second of a whole core.
function(hnbrdf_web_test name)
  add_test(NAME ${name} COMMAND ${ARGN})
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 FIXTURES_REQUIRED web_packages
    TIMEOUT 300)
endfunction()

foreach(example webgl three babylon babylon_webgpu webgpu)
  hnbrdf_web_test(test_web_${example} sh ${CMAKE_CURRENT_LIST_DIR}/test_web_example.sh
    ${example} ${PROJECT_SOURCE_DIR} $<TARGET_FILE:hnbrdf_cli> ${HNBRDF_WEB_PACKAGES}
    ${CMAKE_CURRENT_BINARY_DIR}/web_${example})
endforeach()

foreach(api webgl webgpu dawn slang)
  hnbrdf_web_test(test_web_parity_${api} sh ${CMAKE_CURRENT_LIST_DIR}/test_web_parity.sh ${api}
    ${PROJECT_SOURCE_DIR} $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_glsl_scenes>
    ${HNBRDF_WEB_PACKAGES} ${CMAKE_CURRENT_BINARY_DIR}/web_parity_${api})
endforeach()

foreach(tool naga babylon)
  hnbrdf_web_test(test_web_${tool}_texts sh ${CMAKE_CURRENT_LIST_DIR}/test_web_tool.sh ${tool}
    ${PROJECT_SOURCE_DIR} $<TARGET_FILE:hnbrdf_glsl_scenes> ${HNBRDF_WEB_PACKAGES}
    ${CMAKE_CURRENT_BINARY_DIR}/web_${tool}_texts)
endforeach()

foreach(compiler glslang direct3d)
  hnbrdf_web_test(test_web_hlsl_${compiler} sh ${CMAKE_CURRENT_LIST_DIR}/test_web_hlsl.sh
    ${compiler} ${PROJECT_SOURCE_DIR} $<TARGET_FILE:hnbrdf_cli> ${HNBRDF_WEB_PACKAGES}
    ${CMAKE_CURRENT_BINARY_DIR}/web_hlsl_${compiler})
endforeach()
