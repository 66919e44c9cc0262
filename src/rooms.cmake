# rooms.cmake: which files each room of src/ holds. src/README.md says what the rooms are for.
# hnbrdf_room(NAME files...) sets HNBRDF_ROOM_NAME to their paths.
function(hnbrdf_room name)
  list(TRANSFORM ARGN PREPEND src/${name}/)
  set(HNBRDF_ROOM_${name} ${ARGN} PARENT_SCOPE)
endfunction()

hnbrdf_room(base
  clock.c csv.c files.c files_posix.c files_windows.c foreign.c guess.c interrupt.c json.c printer.c
  probe.c text.c text_buffer.c threads.c write.c)
set(HNBRDF_PUBLIC_HEADERS hnbrdf glsl edit) # of libhnbrdf
# Each file of base that an installed library needs is in exactly one of the static ones: here what
# libhnbrdf, libhnbrdf_fit and libhnbrdf_bake hold. Shared libraries take what they need from
# hnbrdf_base and hide it.
set(HNBRDF_BASE_HNBRDF src/base/files.c src/base/files_posix.c src/base/files_windows.c
  src/base/foreign.c src/base/guess.c src/base/json.c src/base/printer.c src/base/text.c)
set(HNBRDF_BASE_FIT src/base/clock.c src/base/threads.c)
set(HNBRDF_BASE_BAKE src/base/probe.c)
hnbrdf_room(core
  edited.c eval.c kernel_plain.c material.c model.c network.c pack.c prepare.c sample.c
  names.c strerror.c variant.c)
hnbrdf_room(model check_name.c choose_kernel.c create.c)
hnbrdf_room(file
  decode.c load.c numbers.c safetensors.c save.c)
hnbrdf_room(import
  brdf_heading.c brdf_network.c brdf_parameters.c brdf_text.c import_brdf.c published_name.c)
hnbrdf_room(glsl
  export_brdf.c export_evaluate.c export_filter.c export_glsl.c export_input.c export_language.c
  export_library.c export_loops.c export_material.c export_network.c export_scene.c
  export_unpack.c export_weights.c half.c macro_names.c names.c published.c vector.c)
hnbrdf_room(language
  builtin.c c_like.c condition.c glsl_plain.c hlsl.c macro.c msl.c parse.c parse_expression.c
  parse_statement.c
  parse_tokens.c preprocess.c print.c print_expression.c print_statement.c token.c translate.c
  translation.c type.c wgsl.c wgsl_expression.c wgsl_statement.c)
hnbrdf_room(lobes
  fit_lobes.c)
hnbrdf_room(measured
  builtin.c builtin_anisotropic.c builtin_film.c builtin_materials.c cie.c custom.c families.c
  formats.c measured.c merl.c merl_known.c nbrdf.c nbrdf_npy.c pairs.c procedural.c
  procedural_draw.c procedural_measure.c procedural_open.c read_file.c rgl.c rgl_eval.c rgl_tables.c
  sha256.c tensor_file.c utia.c)
hnbrdf_room(hdf5
  image_driver.c nbrdf_hdf5.c)
hnbrdf_room(metrics
  albedo.c compare.c energy.c flip.c flip_colour.c flip_hdr.c image.c physics.c)
hnbrdf_room(fit
  descent.c frozen.c look.c pixels.c views.c
  kernel_avx2.c kernel_avx512.c adam.c agree.c alone.c axis.c bright.c checkpoint.c fit.c ggx.c
  gradient.c hold.c horizon.c judge.c kernel.c kernel_double.c options.c pool.c ranks.c result.c
  schedule.c share.c soap.c stage.c supply.c switch.c traffic.c train.c worth.c)
hnbrdf_room(check
  backends.c bounds.c bounds_draw.c bounds_edit.c cases.c compare.c comparison.c exchange_in.c
  exchange_out.c half.c maps.c oracle.c pairs.c parity.c probe.c reference.c rounding.c rules.c
  run.c verify.c)
hnbrdf_room(image
  colour_space.c cube.c difference.c draw.c exr_choose.c exr_colour.c exr_layers.c exr_memory.c
  exr_none.c exr_planes.c exr_planes_cxx.cc exr_read.c exr_write.c glyphs.c image.c image_file.c
  label.c png.c radiance.c radiance_header.c radiance_pixels.c repair.c sheet.c)
hnbrdf_room(render
  backdrop.c environment.c guide.c sequence.c shade.c sky.c sphere.c surface.c
  tabulated.c tiles.c)
hnbrdf_room(scene
  describe.c describe_file.c describe_lists.c describe_shape.c film.c film_file.c hit.c job.c
  lights.c load.c load_shapes.c mesh.c mesh_view.c obj.c obj_faces.c obj_file.c obj_lines.c
  obj_notes.c passes.c patch.c path.c polygon.c polygon_ears.c portals.c scene.c
  shapes.c teapot.c trace.c turn.c units.c words.c)
hnbrdf_room(plot
  svg.c)
hnbrdf_room(gpu
  commands.c compile.c compute.c device.c evaluate.c fragment.c
  picture.c probe.c probe_half.c sphere.c
  stability.c timed.c
  verify.c)
hnbrdf_room(gl
  context.c draw.c timed.c verify.c)
hnbrdf_room(edit
  fields.c materials.c mix_fit.c mix_goal.c mix_pairs.c mix_path.c)
hnbrdf_room(bake
  bake.c ggx.c half.c lobes.c options.c ranks.c report.c rows.c search.c sizes.c teacher.c tell.c
  wave.c)
hnbrdf_room(report
  bake_front.c bake_plot.c bake_tables.c compare.c compare_images.c conserve.c editing_edits.c
  editing_figures.c
  editing_fit.c editing_measure.c editing_mix.c editing_plot.c editing_sheet.c
  editing_tables.c fit_log.c flip.c gallery_choose.c
  gallery_pages.c gallery_strips.c grid.c grid_columns.c grid_figures.c grid_fit.c grid_ggx.c
  grid_image_tables.c grid_images.c grid_judged.c grid_kept.c grid_outside.c grid_paper.c
  grid_plot.c grid_ranks.c
  grid_rows.c grid_tables.c info.c
  info_physics.c lobes_table.c loss_plot.c output.c paper.c picture.c same_picture.c
  sampling_measure.c sampling_strips.c sampling_write.c scene_compare.c sheet.c
  spheres.c stability_plot.c stability_report.c still.c texels.c verify_report.c)
hnbrdf_room(bench
  baselines.c growth.c growth_cpu.c growth_files.c growth_fit.c growth_gpu.c
  growth_series.c measure.c models.c peak.c peer.c plot.c quality.c rows.c rows_baselines.c
  rows_cpu.c rows_gpu.c scaling.c speed.c tables.c two_lobes.c watch.c)
hnbrdf_room(cli
  bake_device.c cli.c cmd_bake.c cmd_bench.c cmd_compare.c cmd_edit.c cmd_eval.c cmd_export.c
  cmd_fit.c cmd_gallery.c cmd_import.c cmd_info.c cmd_lobes.c cmd_mix.c cmd_render.c
  cmd_report.c cmd_report_editing.c cmd_report_images.c cmd_report_sampling.c cmd_scene.c
  cmd_sheet.c cmd_stability.c cmd_verify.c files.c main.c message.c option.c output.c
  picture.c progress.c published.c
  ranks.c ranks_mpi.c ranks_none.c reading.c report_options.c sources.c
  standard.c verify_devices.c watch.c words.c)
