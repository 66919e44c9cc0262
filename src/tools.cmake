# The hnbrdf command and what only it uses: rendering and the Vulkan harness.
set(HNBRDF_TOOL_SOURCES
  src/cli/main.c src/cli/cli.c src/cli/sources.c src/cli/output.c src/cli/csv.c
  src/cli/progress.c
  src/cli/cmd_fit.c src/cli/cmd_eval.c src/cli/cmd_compare.c src/cli/cmd_export.c
  src/cli/cmd_verify.c src/cli/cmd_render.c src/cli/cmd_sheet.c src/cli/cmd_import.c
  src/cli/cmd_info.c
  src/render/environment.c src/render/sphere.c src/render/shade.c src/render/image.c
  src/render/exr.c src/render/png.c src/render/label.c)
add_executable(hnbrdf_cli ${HNBRDF_TOOL_SOURCES})
set_target_properties(hnbrdf_cli PROPERTIES OUTPUT_NAME hnbrdf RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_link_libraries(hnbrdf_cli PRIVATE hnbrdf_flags hnbrdf_fit_static hnbrdf_metrics_static)
target_include_directories(hnbrdf_cli SYSTEM PRIVATE ${STB_INCLUDE_DIR})
target_compile_definitions(hnbrdf_cli PRIVATE _POSIX_C_SOURCE=200809L)
if(HNBRDF_WITH_OPENEXR)
  target_compile_definitions(hnbrdf_cli PRIVATE HNBRDF_WITH_OPENEXR)
  target_link_libraries(hnbrdf_cli PRIVATE OpenEXR::OpenEXRCore)
endif()
if(HNBRDF_WITH_VULKAN)
  target_sources(hnbrdf_cli PRIVATE src/gpu/device.c src/gpu/compile.c src/gpu/compute.c src/gpu/verify.c)
  target_compile_definitions(hnbrdf_cli PRIVATE HNBRDF_WITH_VULKAN)
  target_link_libraries(hnbrdf_cli PRIVATE Vulkan::Vulkan)
endif()
