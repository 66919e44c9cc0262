# Editing, mixing, baking, the reports, pictures compared, the gallery. (cli.cmake, read before,
# knows how to run the scripts.)
hnbrdf_test(test_edit test_edit.c)
hnbrdf_test(test_edit_properties test_edit_properties.c)
target_compile_definitions(hnbrdf_test_edit_properties PRIVATE
  HNBRDF_EXAMPLE_MODEL="${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors")
hnbrdf_test(test_mix_path test_mix_path.c model_support.c core_support.c)
target_compile_definitions(hnbrdf_test_mix_path PRIVATE
  HNBRDF_EXAMPLE_MODEL="${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors"
  HNBRDF_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
hnbrdf_test(test_edit_materials test_edit_materials.c model_support.c core_support.c)
hnbrdf_cli_test(test_edit_cli)
hnbrdf_cli_test(test_report)
set_tests_properties(test_report PROPERTIES TIMEOUT 300)
hnbrdf_cli_test(test_report_paper)
hnbrdf_cli_test(test_report_sampling)
hnbrdf_cli_test(test_bake_cli)
set_tests_properties(test_bake_cli PROPERTIES TIMEOUT 300)
hnbrdf_cli_test(test_compare_images)
hnbrdf_cli_test(test_report_images)
hnbrdf_cli_test(test_gallery ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
hnbrdf_cli_test(test_report_editing)
hnbrdf_test(test_editing test_editing.c)
target_link_libraries(hnbrdf_test_editing PRIVATE hnbrdf_report)
