# The hnbrdf command and what only it uses: rendering and the Vulkan harness.
set(HNBRDF_TOOL_SOURCES
  src/cli/main.c src/cli/cli.c src/cli/sources.c src/cli/output.c src/cli/csv.c
  src/cli/progress.c src/cli/texels.c src/cli/svg.c
  src/cli/cmd_fit.c src/cli/fit_log.c src/cli/fit_speed.c src/cli/loss_plot.c
  src/cli/cmd_eval.c src/cli/cmd_compare.c src/cli/compare_images.c src/cli/cmd_export.c
  src/cli/cmd_verify.c src/cli/cmd_render.c src/cli/render_gpu.c src/cli/cmd_scene.c
  src/cli/scene_job.c src/cli/scene_compare.c src/cli/render_mesh.c src/cli/cmd_sheet.c src/cli/cmd_import.c
  src/cli/cmd_info.c src/cli/picture.c src/cli/palette.c src/cli/cmd_edit.c src/cli/cmd_mix.c src/cli/cmd_report_sampling.c src/cli/sampling_measure.c src/cli/sampling_write.c
  src/cli/sampling_strips.c src/cli/lobes.c src/cli/cmd_lobes.c
  src/cli/peak.c src/cli/cmd_report.c src/cli/cmd_bake.c src/cli/bake_search.c src/cli/bake_sizes.c
  src/cli/bake_fit.c src/cli/bake_teacher.c src/cli/bake_tables.c src/cli/bake_plot.c src/cli/bake_half.c
  src/cli/report_grid.c src/cli/report_fit.c src/cli/report_tables.c
  src/cli/report_images.c src/cli/report_ggx.c src/cli/report_options.c
  src/cli/cmd_report_images.c src/cli/report_image_tables.c src/cli/report_rows.c
  src/cli/cmd_gallery.c src/cli/gallery_strips.c src/cli/gallery_choose.c src/cli/gallery_pages.c
  src/cli/report_plot.c src/cli/cmd_bench.c src/cli/bench_probe.c src/cli/bench_cpu.c
  src/cli/bench_gpu.c src/cli/bench_peer.c src/cli/bench_quality.c src/cli/bench_write.c
  src/cli/bench_plot.c src/cli/text_buffer.c)

# The renderer is a library only so that its tests need not compile it again; it is not installed.
add_library(hnbrdf_render STATIC EXCLUDE_FROM_ALL
  src/render/image.c src/render/exr.c src/render/radiance.c src/render/png.c
  src/render/environment.c src/render/sky.c src/render/surface.c src/render/guide.c src/render/tabulated.c src/render/sequence.c
  src/render/shade.c src/render/tiles.c src/render/sphere.c src/render/backdrop.c src/render/label.c src/render/glyphs.c
  src/render/sheet.c src/render/draw.c src/render/difference.c
  src/render/mesh.c src/render/polygon.c src/render/obj.c src/render/shapes.c src/render/teapot.c
  src/render/scene.c src/render/trace.c src/render/hit.c src/render/lights.c src/render/portals.c
  src/render/path.c src/render/film.c src/render/passes.c src/render/words.c src/render/describe.c
  src/render/describe_shape.c src/render/load.c)
target_link_libraries(hnbrdf_render PRIVATE hnbrdf_flags PUBLIC hnbrdf_measured_static Threads::Threads)
target_include_directories(hnbrdf_render SYSTEM PRIVATE ${STB_INCLUDE_DIR})
target_compile_definitions(hnbrdf_render PRIVATE _POSIX_C_SOURCE=200809L)
if(HNBRDF_WITH_OPENEXR)
  target_compile_definitions(hnbrdf_render PRIVATE HNBRDF_WITH_OPENEXR)
  target_link_libraries(hnbrdf_render PRIVATE OpenEXR::OpenEXRCore)
endif()

if(HNBRDF_WITH_EMBREE)
  target_compile_definitions(hnbrdf_render PRIVATE HNBRDF_WITH_EMBREE=${HNBRDF_EMBREE_MAJOR})
  target_link_libraries(hnbrdf_render PRIVATE embree)
endif()

# What the BRDF is by its formulas, for tests and `hnbrdf stability`; no installed library links it.
include(CheckCSourceCompiles)
set(CMAKE_REQUIRED_LIBRARIES quadmath)
check_c_source_compiles("#include <quadmath.h>
  int main(void) { __float128 x = 2; return (int)sqrtq(x); }" HNBRDF_HAS_QUADMATH)
unset(CMAKE_REQUIRED_LIBRARIES)
add_library(hnbrdf_oracle STATIC EXCLUDE_FROM_ALL src/oracle/oracle.c)
target_link_libraries(hnbrdf_oracle PRIVATE hnbrdf_flags m)
if(HNBRDF_HAS_QUADMATH)
  target_compile_definitions(hnbrdf_oracle PRIVATE HNBRDF_ORACLE_QUAD)
  target_link_libraries(hnbrdf_oracle PRIVATE quadmath)
endif()
# A library only so that its tests need not compile it again; it is not installed.
add_library(hnbrdf_stability STATIC EXCLUDE_FROM_ALL
  src/stability/cases.c src/stability/backends.c src/stability/run.c src/stability/rounding.c src/stability/maps.c)
target_link_libraries(hnbrdf_stability PRIVATE hnbrdf_flags PUBLIC hnbrdf_measured_static hnbrdf_oracle)

add_executable(hnbrdf_cli ${HNBRDF_TOOL_SOURCES})
set_target_properties(hnbrdf_cli PROPERTIES OUTPUT_NAME hnbrdf RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_sources(hnbrdf_cli PRIVATE src/cli/cmd_stability.c src/cli/stability_report.c
  src/cli/stability_gpu.c src/cli/stability_plot.c src/cli/info_physics.c)
target_link_libraries(hnbrdf_cli PRIVATE hnbrdf_flags hnbrdf_render hnbrdf_fit_static
  hnbrdf_metrics_static hnbrdf_stability)
target_compile_definitions(hnbrdf_cli PRIVATE _POSIX_C_SOURCE=200809L)
if(HNBRDF_WITH_VULKAN)
  # What the harness compiles, as texts named hnbrdf_ and the file's name with _ for the dot.
  set(HNBRDF_SHADER_TEXTS "")
  foreach(shader verify.comp probe.comp probe_half.comp bench.comp evaluate.comp
      sphere.comp)
    string(REPLACE "." "_" symbol ${shader})
    set(text ${CMAKE_CURRENT_BINARY_DIR}/generated/${symbol}.c)
    add_custom_command(OUTPUT ${text}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${CMAKE_CURRENT_SOURCE_DIR}/shaders/${shader} -DOUTPUT=${text}
              -DNAME=hnbrdf_${symbol} -P ${CMAKE_CURRENT_SOURCE_DIR}/src/embed.cmake
      DEPENDS shaders/${shader} src/embed.cmake VERBATIM)
    list(APPEND HNBRDF_SHADER_TEXTS ${text})
  endforeach()
  # A library only so that its tests need not compile it again; it is not installed.
  add_library(hnbrdf_gpu STATIC EXCLUDE_FROM_ALL
    src/gpu/device.c src/gpu/compile.c src/gpu/compute.c src/gpu/probe.c src/gpu/probe_half.c
    src/gpu/half.c src/gpu/pairs.c src/gpu/bounds.c src/gpu/reference.c src/gpu/scene.c src/gpu/verify.c
    src/gpu/timed.c src/gpu/evaluate.c src/gpu/sphere.c ${HNBRDF_SHADER_TEXTS})
  target_link_libraries(hnbrdf_gpu PRIVATE hnbrdf_flags PUBLIC hnbrdf_render hnbrdf_measured_static
    Vulkan::Vulkan)
  target_compile_definitions(hnbrdf_gpu PRIVATE _POSIX_C_SOURCE=200809L)
  target_sources(hnbrdf_cli PRIVATE src/cli/verify_report.c)
  target_compile_definitions(hnbrdf_cli PRIVATE HNBRDF_WITH_VULKAN)
  target_link_libraries(hnbrdf_cli PRIVATE hnbrdf_gpu)
endif()
