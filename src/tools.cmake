# The hnbrdf command and what only it uses: rendering and the Vulkan harness.
set(HNBRDF_TOOL_SOURCES
  src/cli/main.c src/cli/cli.c src/cli/sources.c src/cli/output.c src/cli/csv.c
  src/cli/progress.c
  src/cli/cmd_fit.c src/cli/cmd_eval.c src/cli/cmd_compare.c src/cli/cmd_export.c
  src/cli/cmd_verify.c src/cli/cmd_render.c src/cli/cmd_sheet.c src/cli/cmd_import.c
  src/cli/cmd_info.c)

# The renderer is a library only so that its tests need not compile it again; it is not installed.
add_library(hnbrdf_render STATIC EXCLUDE_FROM_ALL
  src/render/image.c src/render/exr.c src/render/radiance.c src/render/png.c
  src/render/environment.c src/render/sky.c src/render/surface.c src/render/shade.c
  src/render/sphere.c src/render/backdrop.c src/render/label.c src/render/glyphs.c)
target_link_libraries(hnbrdf_render PRIVATE hnbrdf_flags PUBLIC hnbrdf_measured_static Threads::Threads)
target_include_directories(hnbrdf_render SYSTEM PRIVATE ${STB_INCLUDE_DIR})
target_compile_definitions(hnbrdf_render PRIVATE _POSIX_C_SOURCE=200809L)
if(HNBRDF_WITH_OPENEXR)
  target_compile_definitions(hnbrdf_render PRIVATE HNBRDF_WITH_OPENEXR)
  target_link_libraries(hnbrdf_render PRIVATE OpenEXR::OpenEXRCore)
endif()

add_executable(hnbrdf_cli ${HNBRDF_TOOL_SOURCES})
set_target_properties(hnbrdf_cli PROPERTIES OUTPUT_NAME hnbrdf RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_link_libraries(hnbrdf_cli PRIVATE hnbrdf_flags hnbrdf_render hnbrdf_fit_static
  hnbrdf_metrics_static)
target_compile_definitions(hnbrdf_cli PRIVATE _POSIX_C_SOURCE=200809L)
if(HNBRDF_WITH_VULKAN)
  target_sources(hnbrdf_cli PRIVATE src/gpu/device.c src/gpu/compile.c src/gpu/compute.c src/gpu/verify.c)
  target_compile_definitions(hnbrdf_cli PRIVATE HNBRDF_WITH_VULKAN)
  target_link_libraries(hnbrdf_cli PRIVATE Vulkan::Vulkan)
endif()
